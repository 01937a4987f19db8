// Which vertices of the pieces are one vertex of the mesh, a *site*.
//
// Sites are numbered by first use among the piece vertices; one that is not new is a *copy*.  Where pieces
// touch along edges, the site of a copy is found next to that of its neighbour on the boundary.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "corner_table.hpp"

namespace ebz {

// opposite and vertex: of half-edges in output order, vertices of the pieces numbered by first corner.
struct GluedPieces {
    std::span<const Index> opposite, vertex;
    Index n_vertices, n_copies;
};

// site: of each piece vertex.
std::vector<uint8_t> encode_gluing(const GluedPieces& pieces, std::span<const Index> site);

// Throws Corrupt where the stream contradicts the counts.
std::vector<Index> decode_gluing(std::span<const uint8_t> bytes, const GluedPieces& pieces);

// The site of each corner.
std::vector<Index> glue(std::span<const Index> vertex, std::span<const Index> site);

}  // namespace ebz
