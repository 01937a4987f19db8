// Which decimal lattice the coordinates of a mesh lie on.
#pragma once

#include <cstdint>
#include <span>

namespace ebz {

// The largest multiple of a step that a lattice uses; sums of a few stay exact in 64 bits.
inline constexpr double max_multiple = 1099511627776.0;  // 2^40

// The fewest digits d <= max_digits such that all values but max_misses are k / 10^d with |k| <= 2^40,
// correctly rounded to their type, bit for bit; -1 if there is none.
template <class Float>
int decimal_digits(std::span<const Float> values, int max_digits, size_t max_misses);

}  // namespace ebz
