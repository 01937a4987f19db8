#include "connectivity.hpp"

#include "../surface/pieces.hpp"
#include "reverse.hpp"
#include "specials.hpp"

namespace ebz {

namespace {

// The corners of pieces in the order of their gates, and vertices by first use.
void reorder(const Pieces& pieces, std::span<const Index> faces, EncodedConnectivity& encoded) {
    const std::vector<Index>& gates = encoded.word.gates;
    auto& [opposite, fans] = encoded.connectivity;
    std::vector<Index> output_of(gates.size()), number(pieces.fans.n_vertices, none);
    for (size_t t = 0; t < gates.size(); ++t) output_of[gates[t] / 3] = static_cast<Index>(t);
    fans.vertex.resize(pieces.opposite.size());
    opposite.resize(pieces.opposite.size());
    encoded.source_vertex.reserve(number.size());
    for (Index t = 0; t < static_cast<Index>(gates.size()); ++t) {
        Index h = gates[t];
        for (Index c = 3 * t; c < 3 * t + 3; ++c, h = next(h)) {
            Index& vertex = number[pieces.fans.vertex[h]];
            if (vertex == none) {
                vertex = fans.n_vertices++;
                encoded.source_vertex.push_back(faces[h]);
            }
            fans.vertex[c] = vertex;
            opposite[c] = none;
            if (const Index across = pieces.opposite[h]; across != none) {
                const Index there = output_of[across / 3], turned = across - gates[there];
                opposite[c] = 3 * there + turned + (turned < 0 ? 3 : 0);
            }
        }
    }
}

}  // namespace

EncodedConnectivity encode_connectivity(std::span<const Index> faces, Index n_vertices) {
    EncodedConnectivity encoded;
    const TriangleFaces triangles(faces);
    const Pieces pieces = cut_into_pieces(triangles, n_vertices);
    encoded.word = encode_word(triangles, n_vertices, pieces.opposite, pieces.fans);
    reorder(pieces, faces, encoded);
    return encoded;
}

template <class Model>
std::vector<uint8_t> encode_symbols(std::span<const uint8_t> symbols, std::span<const SpecialS> specials,
                                    Model model) {
    RangeEncoder coder;
    LoopStack loops;
    SpecialsReversed reversed(specials);
    for (int64_t position = static_cast<int64_t>(symbols.size()) - 1; position >= 0; --position) {
        const Symbol symbol = static_cast<Symbol>(symbols[position]);
        const bool special = reversed.take(position) != none;
        if (!special) model.shares().encode(coder, symbol);
        loops.apply(symbol, special);
        model.advance(symbol, special);
    }
    return coder.finish();
}

template <class Model>
DecodedConnectivity decode_connectivity(std::span<const uint8_t> bytes, const WordHeader& header,
                                        std::span<const SpecialS> specials, Model model) {
    DecodedConnectivity decoded;
    decoded.symbols.resize(header.n_symbols);
    RangeDecoder coder(bytes);
    LoopStack loops;
    SpecialsReversed reversed(specials);
    Reverse reverse(header.n_symbols, header.n_closed, header.n_single);
    for (Index position = header.n_symbols - 1; position >= 0; --position) {
        const int64_t meets = reversed.take(position);
        const Symbol symbol = meets == none ? model.shares().decode(coder) : S;
        loops.apply(symbol, meets != none);
        reverse.apply(symbol, meets);
        model.advance(symbol, meets != none);
        decoded.symbols[position] = symbol;
    }
    if (!reversed.all_taken()) throw Corrupt("a special S lies outside the word");
    decoded.connectivity = reverse.finish();
    return decoded;
}

template std::vector<uint8_t> encode_symbols(std::span<const uint8_t>, std::span<const SpecialS>, AutomatonModel);
template std::vector<uint8_t> encode_symbols(std::span<const uint8_t>, std::span<const SpecialS>, StackModel);
template DecodedConnectivity decode_connectivity(std::span<const uint8_t>, const WordHeader&,
                                                 std::span<const SpecialS>, AutomatonModel);
template DecodedConnectivity decode_connectivity(std::span<const uint8_t>, const WordHeader&,
                                                 std::span<const SpecialS>, StackModel);

}  // namespace ebz
