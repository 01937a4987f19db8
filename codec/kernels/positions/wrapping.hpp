// Sums of 64-bit coordinates modulo 2^64: corrupt streams may hold anything.
#pragma once

#include <cstdint>

namespace ebz::positions {

inline int64_t wrapping_sum(int64_t a, int64_t b) {
    return static_cast<int64_t>(static_cast<uint64_t>(a) + static_cast<uint64_t>(b));
}
inline int64_t wrapping_difference(int64_t a, int64_t b) {
    return static_cast<int64_t>(static_cast<uint64_t>(a) - static_cast<uint64_t>(b));
}
inline uint64_t magnitude(int64_t x) { return x < 0 ? 0 - static_cast<uint64_t>(x) : static_cast<uint64_t>(x); }

// The nearest integer, within what a prediction may be; NaN gives the lower limit.
inline int64_t rounded(double x) {
    constexpr double limit = 2.0e18;
    const double y = (x > -limit ? (x < limit ? x : limit) : -limit) + 0.5;
    const auto whole = static_cast<int64_t>(y);
    return whole - (static_cast<double>(whole) > y ? 1 : 0);  // floor; SSE2 has none
}

}  // namespace ebz::positions
