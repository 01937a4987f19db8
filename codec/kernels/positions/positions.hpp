// Entropy coders for vertex positions along a surface that both sides know.
//
// References: C. Touma and C. Gotsman, "Triangle mesh compression", 1998 (parallelogram prediction);
// D. Cohen-Or, R. Cohen and R. Irony, "Multi-way geometry encoding", 2002 (averages of parallelograms);
// M. Mahoney, "Adaptive weighing of context models for lossless data compression", 2005 (logistic
// mixing).  Here every binary decision of a residual mixes distributions around several predictions,
// counted contexts, and exact values seen nearby.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface.hpp"

namespace ebz::positions {

enum class Method : uint8_t {
    fast,    // in the order of the faces, one symbol per coordinate, three coders side by side; values of 32 bits
    light,   // one symbol per coordinate under a mix of contexts, from fits
    strong,  // every model there is
    float32_bits,  // values are floats by their order (spaces.hpp), predictions are made in floats
    float64_bits,
    medium,  // as fast, in an order of its own, under means of contexts
};

// values: 3 per vertex; magnitudes up to 2^40 but for the float methods.  Methods fast and medium give nothing
// where a value has more than 32 bits.
std::vector<uint8_t> encode(const Surface& surface, std::span<const int64_t> values, Method method);

// Fills values with what was encoded by the same method, neither fast nor medium (fast.hpp, medium.hpp).  Any bytes decode to
// some positions.
void decode(std::span<const uint8_t> bytes, const Surface& surface, Method method, std::span<int64_t> values);

}  // namespace ebz::positions
