// Polygons cut into triangles along which positions are predicted.
//
// A coder of triangles predicts across edges, a + b - apex.  So a quad's diagonal should miss the corner that is
// coded last, which then completes the parallelogram of the other three; and across an edge of two quads it should
// touch one end in the one and the other end in the other, which makes parallelograms of a regular grid.  Where
// triangles prevail it makes degrees even instead.
// Reference: M. Isenburg and P. Alliez, "Compressing polygon mesh geometry with parallelogram prediction", 2002.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../surface/faces.hpp"

namespace ebz::polygons {

enum class Cut : uint8_t {
    completing,  // diagonals miss the corner that comes last, else are as neighbours want them
    regular,     // all are as neighbours want them
    twice,       // a second sheet of triangles has all the other diagonals
};

struct Triangles {
    std::vector<Index> opposite;  // per half-edge
    std::vector<Index> corner;    // of a polygon, per corner
};

// across: of each half-edge of the polygons, none on a boundary.  vertex: of each corner, below n_vertices.
// Faces of fewer than three corners have no triangle.
Triangles cut(const PolygonFaces& faces, std::span<const Index> across, Index n_vertices, Cut way);

}  // namespace ebz::polygons
