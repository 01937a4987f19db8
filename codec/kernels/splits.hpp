// Points that several vertices share: which corners at a point belong to which vertex.
//
// Vertices with equal positions are welded into points, so that seams and triangle soups are coded as the
// surfaces they are.  Across each edge, at each of its ends, a bit tells whether the corners on its two
// sides belong to different vertices; along a seam both ends differ, which the contexts learn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "corner_table.hpp"

namespace ebz {

// opposite and point: per corner.  vertex: the vertex of each corner, numbered by first use.
std::vector<uint8_t> encode_splits(std::span<const Index> opposite, std::span<const Index> point,
                                   Index n_points, std::span<const Index> vertex);

struct DecodedSplits {
    std::vector<Index> vertex;  // of each corner, numbered by first use
    std::vector<Index> point;   // of each vertex
};

DecodedSplits decode_splits(std::span<const uint8_t> bytes, std::span<const Index> opposite,
                            std::span<const Index> point, Index n_points);

}  // namespace ebz
