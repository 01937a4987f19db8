// Cuts any list of faces into oriented manifold pieces that Edgebreaker can code.
//
// The vertices of a face are distinct.  Pieces of triangles are simple: no two edges with the same two
// ends, every boundary of at least three edges (which follows: a boundary of two edges has equal ends).
//
// Every decision depends on the mesh alone and not on the order of its faces or vertices, except that
// among identical faces the first stands for all: so a decoded mesh is cut as its original was.
#pragma once

#include <span>
#include <vector>

#include "faces.hpp"

namespace ebz {

struct Pieces {
    std::vector<Index> opposite;  // per half-edge
    Fans fans;                    // the vertices of the pieces; several may stand for one mesh vertex
};

// The vertices of faces are in [0, n_vertices).
template <class Faces>
Pieces cut_into_pieces(const Faces& faces, Index n_vertices);

}  // namespace ebz
