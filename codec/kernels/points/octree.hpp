// Points without faces: a set of lattice positions as an octree, level by level.
//
// References: D. Meagher, "Geometric modeling using octree encoding", 1982; R. Schnabel and R. Klein,
// "Octree-based point-cloud compression", 2006.  Different here: whether a cell has one child is told
// first, since below some level nearly all have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ebz::points {

struct Encoded {
    std::vector<uint8_t> bytes;
    std::vector<int32_t> order;  // the point that each decoded one was
};

// values: 3n coordinates.  Points come out by the bits of their coordinates, highest first; equal ones
// keep their order.
Encoded encode(std::span<const int64_t> values);

// 3n values; throws Corrupt where the bytes hold another number of points.
std::vector<int64_t> decode(std::span<const uint8_t> bytes, size_t n);

}  // namespace ebz::points
