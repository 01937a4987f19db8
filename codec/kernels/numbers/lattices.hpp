// Which decimal lattice the coordinates of a mesh lie on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rows.hpp"

namespace ebz {

// The largest multiple of a step that a lattice uses; sums of a few stay exact in 64 bits.
inline constexpr double max_multiple = 1099511627776.0;  // 2^40

// The fewest digits d <= max_digits such that all values but max_misses are k / 10^d with |k| <= 2^40,
// correctly rounded to their type, bit for bit; -1 if there is none.
template <class Float>
int decimal_digits(std::span<const Float> values, int max_digits, size_t max_misses);

// The least and the greatest value of each axis; all infinite where some value is not finite.
template <class Float>
std::array<double, 6> bounds(std::span<const Float> coordinates);

// A lattice of the points origin + step q.
struct Steps {
    std::array<double, 3> origin;
    double step;
};

// The nearest multiples, halves to even; 0 for what is none of magnitude up to max_multiple.
template <class Float>
void to_multiples(std::span<const Float> coordinates, const Steps& steps, std::span<int64_t> multiples);

// Rows of three; coordinates: as many.
template <class Integer, class Float>
void from_multiples(const Rows<Integer>& multiples, const Steps& steps, std::span<Float> coordinates);

}  // namespace ebz
