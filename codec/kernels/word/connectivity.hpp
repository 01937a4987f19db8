// A list of triangles <-> its word, with the triangles and vertices in the order of the word.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edgebreaker.hpp"
#include "word_models.hpp"

namespace ebz {

struct EncodedConnectivity {
    Word word;
    Connectivity connectivity;
    std::vector<Index> source_vertex;  // per piece vertex, the vertex of the input
};

// faces: 3m indices in [0, n_vertices).
EncodedConnectivity encode_connectivity(std::span<const Index> faces, Index n_vertices);

// The word in reverse order under a model of word_models.hpp; throws Corrupt where it forbids a symbol.
template <class Model>
std::vector<uint8_t> encode_symbols(std::span<const uint8_t> symbols, std::span<const SpecialS> specials,
                                    Model model);

struct WordHeader {
    Index n_symbols, n_closed, n_single;
};

struct DecodedConnectivity {
    std::vector<uint8_t> symbols;
    Connectivity connectivity;
};

template <class Model>
DecodedConnectivity decode_connectivity(std::span<const uint8_t> bytes, const WordHeader& header,
                                        std::span<const SpecialS> specials, Model model);

// How much work an adaptive model does per symbol.
enum class Effort : uint8_t { direct = 1, fast, strong };

// The word in reverse order under an adaptive model, with what its special S meet.  The first symbol and
// those of single triangles cost nothing; every other symbol costs more than 2^-12 bits.
std::vector<uint8_t> encode_adaptive(std::span<const uint8_t> symbols, const WordHeader& header,
                                     std::span<const SpecialS> specials, Effort effort);

struct AdaptivelyDecoded {
    DecodedConnectivity word;
    std::vector<SpecialS> specials;
};

AdaptivelyDecoded decode_adaptive(std::span<const uint8_t> bytes, const WordHeader& header, Index n_specials,
                                  Effort effort);

}  // namespace ebz
