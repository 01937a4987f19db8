// The modified Edgebreaker: oriented manifold pieces <-> a word over C, L, R, S, E.
//
// References: J. Rossignac, "Edgebreaker: connectivity compression for triangle meshes", 1999 (the five
// operations); S. Gumhold, "Optimizing Markov Models with Applications to Triangular Connectivity
// Coding", 2005 (loops, gates, S pushes the left loop); M. Isenburg and J. Snoeyink, "Spirale Reversi:
// reverse decoding of the Edgebreaker encoding", 2000.  Different here: holes and handles need no
// symbols of their own.  An S that touches a loop already known leaves a left gate that is processed
// from the other side; such a *special* S is listed with the half-edge that its left edge meets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../surface/corner_table.hpp"
#include "../surface/faces.hpp"

namespace ebz {

enum Symbol : uint8_t { C, L, R, S, E };
inline constexpr int n_symbols = 5;

// Of polygons, a loop may have two edges and the same edge may come again: as a diagonal.
enum class PieceKind : uint8_t { triangles, polygons };

// Triangle i of the output order has its gate as half-edge 3i, the right edge as 3i + 1 and the left as
// 3i + 2.
struct SpecialS {
    int64_t position;  // in the word
    int64_t meets;     // 2 * position of the symbol whose triangle the left edge meets + (0 right, 1 left)
};

// Components follow one another in three groups: with a boundary, closed, single triangles.
struct Word {
    std::vector<uint8_t> symbols;    // a closed component's first triangle has no symbol
    std::vector<SpecialS> specials;  // by position
    Index n_closed = 0;
    Index n_single = 0;
    std::vector<Index> gates;  // per triangle in output order, the half-edge of the input at its gate
};

// opposite and fans: of pieces, which must be simple (pieces.hpp).  Linear time.
Word encode_word(const TriangleFaces& faces, Index n_vertices, std::span<const Index> opposite, const Fans& fans);

}  // namespace ebz
