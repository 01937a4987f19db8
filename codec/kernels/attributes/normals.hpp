// Normals of faces, or at corners as means of those of the faces around.
//
// Reference: N. Max, "Weights for computing vertex normals from facet normals", 1999.
// Only + - * / and square roots of doubles in a fixed order, so that every machine has the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ebz::attributes {

struct CornersInSpace {
    std::span<const double> points;    // 3 for each vertex
    std::span<const int32_t> vertex;   // of each corner of the faces
    std::span<const int32_t> offsets;  // where the corners of each face begin; none of triangles
    std::span<const int32_t> item;     // of each corner; none where items are the faces
    int32_t n;                         // items
};

struct NormalWeights {
    bool by_area, by_angle;
    bool as_sums;    // with the length that sums with such weights have, of items of corners
    bool by_corner;  // of the edges at each corner, not of its face
};

// 3 for each item; zeros where there is no direction.
std::vector<double> normals(const CornersInSpace& corners, NormalWeights weights);

}  // namespace ebz::attributes
