// Float64 that were float32, as they are or written in decimals.
#pragma once

#include <cstddef>
#include <span>

namespace ebz {

// More than these say all that a float64 is.
inline constexpr int max_single_digits = 15;

// 0 if all values but max_misses are float32; else the fewest significant digits, at most 15, to which the
// nearest float32 are rounded to give them; -1 if there are none.
int single_digits(std::span<const double> values, size_t max_misses);

// Each of the singles rounded to so many significant digits, and that to the nearest float64; 0 digits: as it is.
void write_singles(std::span<const float> singles, int digits, std::span<double> values);

}  // namespace ebz
