// Vertex positions: parallelogram prediction, averaged over all that are available, and adaptive coding
// of the residuals.
//
// Reference: C. Touma and C. Gotsman, "Triangle mesh compression", 1998; D. Cohen-Or, R. Cohen and
// R. Irony, "Multi-way geometry encoding", 2002 (averages of parallelograms).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "traversal.hpp"

namespace ebz {

// What the 64-bit values of the coordinates stand for; predictions are made in that space.
enum class Space : uint8_t {
    lattice,  // integers
    float32,  // the bits of a float, ordered: see spaces.hpp
    float64,
};

// values: 3 per vertex.
std::vector<uint8_t> encode_positions(const Surface& surface, std::span<const int64_t> values, Space space);
void decode_positions(std::span<const uint8_t> bytes, const Surface& surface, Space space,
                      std::span<int64_t> values);

}  // namespace ebz
