// The order of a source mesh: which of its vertices, faces and corners each item of the output is.
//
// Everything that both sides know by then predicts it: the surface, the positions, and of vertices and
// faces those that are coded first.  Uniform coding bounds the cost of an order without any pattern.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../surface/faces.hpp"
#include "../positions/surface.hpp"

namespace ebz::order {

using Bytes = std::vector<uint8_t>;
using positions::Surface;

struct Geometry {
    Surface surface;
    std::span<const int64_t> positions;  // 3 per vertex, as integers of any scale
};

// The order in which the used vertices are coded; empty for that of the output.
struct Visits {
    std::span<const Index> vertices;
};

// source: per vertex of the output, its index in the source.  Isolated vertices, which come last, take
// what is left in ascending order and cost nothing.
Bytes encode_vertex_order(const Geometry& known, Visits visits, bool uniform, std::span<const Index> source);
std::vector<Index> decode_vertex_order(std::span<const uint8_t> bytes, const Geometry& known, Visits visits,
                                       bool uniform);

// What faces are predicted from: as Geometry, but corners are those of the faces, triangles or polygons.
template <class Faces>
struct FaceGeometry {
    const Faces& faces;
    std::span<const Index> opposite;
    std::span<const int64_t> positions;
};

// source: per face; those without corners, which come last, take what is left in ascending order.
// vertex_source: what is known of the vertices, empty for nothing.
template <class Faces>
Bytes encode_face_order(const FaceGeometry<Faces>& known, std::span<const Index> vertex_source, bool uniform,
                        std::span<const Index> source);
template <class Faces>
std::vector<Index> decode_face_order(std::span<const uint8_t> bytes, const FaceGeometry<Faces>& known,
                                     std::span<const Index> vertex_source, bool uniform);

// rotations: per face of the output, which of its corners is first in the source.
template <class Faces>
Bytes encode_rotations(const FaceGeometry<Faces>& known, std::span<const Index> face_source,
                       std::span<const Index> vertex_source, bool uniform, std::span<const Index> rotations);
template <class Faces>
std::vector<Index> decode_rotations(std::span<const uint8_t> bytes, const FaceGeometry<Faces>& known,
                                    std::span<const Index> face_source, std::span<const Index> vertex_source,
                                    bool uniform);

}  // namespace ebz::order
