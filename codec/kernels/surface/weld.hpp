// Vertices at equal positions as one point, where the surface has a seam there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "faces.hpp"

namespace ebz {

// For each vertex, the first vertex that stands for it; empty where each stands for itself.
//
// positions: 3 per vertex, compared bit for bit.  Only vertices at an edge that does not pair up are
// welded, so that positions which quantising makes equal inside a surface tear nothing, and none of a
// face that would lose a corner by it.  The outcome does not depend on the order of vertices and faces.
template <class Faces, class Bits>
std::vector<Index> weld(const Faces& faces, std::span<const Bits> positions);

}  // namespace ebz
