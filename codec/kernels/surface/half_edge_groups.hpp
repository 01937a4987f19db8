// Half-edges grouped by their undirected edge: the regular ones matched, the others listed.
#pragma once

#include <span>
#include <vector>

#include "faces.hpp"

namespace ebz {

// An edge that is not simply shared by two faces of agreeing orientation, nor a boundary.
struct SingularEdges {
    std::vector<Index> half_edges;  // group after group
    std::vector<Index> offsets;     // n_groups + 1

    Index count() const { return static_cast<Index>(offsets.size()) - 1; }
    std::span<const Index> group(Index g) const {
        return std::span(half_edges).subspan(offsets[g], offsets[g + 1] - offsets[g]);
    }
};

// Matches the half-edges of every edge that has exactly two, running opposite ways; the edges with
// more, or with two that run the same way, are returned.  `isolated` faces take no part.
template <class Faces>
SingularEdges match_regular_edges(const Faces& faces, Index n_vertices, std::span<const uint8_t> isolated,
                                  std::span<Index> opposite);

}  // namespace ebz
