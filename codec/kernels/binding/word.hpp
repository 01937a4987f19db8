// Words as arrays: of triangles (word.cpp) and of polygons (polygons.cpp).
#pragma once

#include "../word/connectivity.hpp"
#include "arrays.hpp"

namespace ebz::binding {

inline std::vector<ebz::SpecialS> specials_from(const Input<int64_t>& pairs) {
    std::vector<ebz::SpecialS> specials;
    for (size_t i = 0; i + 1 < pairs.size(); i += 2) specials.push_back({pairs.data()[i], pairs.data()[i + 1]});
    return specials;
}

inline std::vector<int64_t> to_pairs(const std::vector<ebz::SpecialS>& specials) {
    std::vector<int64_t> pairs;
    for (const ebz::SpecialS& s : specials) pairs.insert(pairs.end(), {s.position, s.meets});
    return pairs;
}

inline ebz::WordHeader word_header(int64_t n_symbols, int64_t n_closed, int64_t n_single) {
    require_addressable(3 * static_cast<size_t>(n_symbols + n_closed));
    return {static_cast<ebz::Index>(n_symbols), static_cast<ebz::Index>(n_closed),
            static_cast<ebz::Index>(n_single)};
}

using WordArrays = std::tuple<Array<uint8_t>, Array<int32_t>, Array<int32_t>, int32_t>;

inline WordArrays word_arrays(ebz::DecodedConnectivity&& decoded) {
    return {to_numpy(std::move(decoded.symbols)), to_numpy(std::move(decoded.connectivity.opposite)),
            to_numpy(std::move(decoded.connectivity.fans.vertex)), decoded.connectivity.fans.n_vertices};
}

}  // namespace ebz::binding
