#include "connectivity.hpp"

#include "pieces.hpp"
#include "reverse.hpp"
#include "specials.hpp"

namespace ebz {

namespace {

std::vector<Index> reordered(std::span<const Index> opposite, std::span<const Index> gates) {
    std::vector<Index> output_of(opposite.size());
    for (Index t = 0; t < static_cast<Index>(gates.size()); ++t) {
        Index h = gates[t];
        for (Index side = 0; side < 3; ++side, h = next(h)) output_of[h] = 3 * t + side;
    }
    std::vector<Index> output(opposite.size());
    for (Index h = 0; h < static_cast<Index>(opposite.size()); ++h) {
        output[output_of[h]] = opposite[h] == none ? none : output_of[opposite[h]];
    }
    return output;
}

}  // namespace

EncodedConnectivity encode_connectivity(std::span<const Index> faces, Index n_vertices) {
    EncodedConnectivity encoded;
    {
        const TriangleFaces triangles(faces);
        const Pieces pieces = cut_into_pieces(triangles, n_vertices);
        encoded.word = encode_word(triangles, n_vertices, pieces.opposite, pieces.fans);
        encoded.connectivity.opposite = reordered(pieces.opposite, encoded.word.gates);
    }
    const std::vector<Index>& gates = encoded.word.gates;
    Fans& fans = encoded.connectivity.fans = number_fans(encoded.connectivity.opposite);
    encoded.source_vertex.resize(fans.n_vertices);
    for (Index t = 0; t < static_cast<Index>(gates.size()); ++t) {
        Index h = gates[t];
        for (Index side = 0; side < 3; ++side, h = next(h)) {
            encoded.source_vertex[fans.vertex[3 * t + side]] = faces[h];
        }
    }
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
