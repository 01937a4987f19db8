// The medium method, in the versions for several instruction sets that medium_coder.hpp is compiled to.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../instructions.hpp"
#include "site.hpp"
#include "surface.hpp"

namespace ebz::positions {

using MediumSite = Site<uint32_t>;

inline namespace baseline {
std::vector<uint8_t> encode_medium(const Surface& mesh, std::span<const int64_t> values);
void decode_medium(std::span<const uint8_t> bytes, const Surface& mesh, std::span<MediumSite> sites);
}
inline namespace avx2 {
std::vector<uint8_t> encode_medium(const Surface& mesh, std::span<const int64_t> values);
void decode_medium(std::span<const uint8_t> bytes, const Surface& mesh, std::span<MediumSite> sites);
}

// Nothing where a value has more than 32 bits.
inline std::vector<uint8_t> encode_positions_medium(const Surface& mesh, std::span<const int64_t> values) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::encode_medium(mesh, values);
#endif
    return baseline::encode_medium(mesh, values);
}

// sites: as many as the surface has vertices, whatever they hold.
inline void decode_positions_medium(std::span<const uint8_t> bytes, const Surface& mesh, std::span<MediumSite> sites) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::decode_medium(bytes, mesh, sites);
#endif
    baseline::decode_medium(bytes, mesh, sites);
}

}  // namespace ebz::positions
