// Residuals as a token, the half-octave of their magnitude, and raw digits below it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "../entropy/ans.hpp"
#include "../instruction_set.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Half-octaves: 0, 1, 2, 3, 4 to 5, 6 to 7, 8 to 11, ...
inline uint32_t half_octave(uint64_t a) {
    const int top = 63 - std::countl_zero(a | 1);
    // Without a branch: small ones are as good as random.
    return 2 * static_cast<uint32_t>(top) + (static_cast<uint32_t>(2 * a >> top) & 1) + (a == 1);
}

// The token of all magnitudes that are too large for one of their own.
inline constexpr uint32_t escape_token = 15;
inline constexpr int max_shift = 50;  // digits and all stay below 2^64

inline uint32_t residual_token(uint64_t a, int shift) { return std::min(half_octave(a >> shift), escape_token); }

inline constexpr std::array<uint8_t, 16> digits_below = {0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6};
inline constexpr std::array<uint8_t, 16> leading = {0, 1, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3};

constexpr int n_low_digits(uint32_t token, int shift) { return digits_below[token] + shift; }
constexpr uint64_t leading_digits(uint32_t token) { return leading[token]; }

inline int64_t with_sign(uint64_t a, uint64_t negative) { return static_cast<int64_t>((a ^ (0 - negative)) + negative); }

template <class Coder>
uint64_t code_digits(Coder& coder, size_t lane, uint64_t digits, int n_digits) {
    if (n_digits <= ans::max_raw) return coder.raw(lane, static_cast<uint32_t>(digits), n_digits);
    uint64_t value = 0;
    while (n_digits > 0) {
        const int n = std::min(n_digits, ans::max_raw);
        n_digits -= n;
        value = value << n | coder.raw(lane, static_cast<uint32_t>(digits >> n_digits) & ((1u << n) - 1), n);
    }
    return value;
}

// The magnitude, of which the token under shift is known.
template <class Coder>
uint64_t code_low_digits(Coder& coder, size_t lane, uint32_t token, int shift, uint64_t a) {
    const int n = n_low_digits(token, shift);
    return leading_digits(token) << n | code_digits(coder, lane, a & ((uint64_t{1} << n) - 1), n);
}

// The same with one more digit, the lowest.
template <class Coder>
uint64_t code_low_digits(Coder& coder, size_t lane, uint32_t token, int shift, uint64_t a, bool lowest) {
    const int n = n_low_digits(token, shift);
    const uint64_t digits = (a & ((uint64_t{1} << n) - 1)) << 1 | lowest;
    return leading_digits(token) << (n + 1) | code_digits(coder, lane, digits, n + 1);
}

// Any residual: the number of digits below the leading one in 6 bits, then these, of its zigzag + 1 (below 2^63).
template <class Coder>
int64_t code_large(Coder& coder, size_t lane, int64_t e) {
    const uint64_t above = (static_cast<uint64_t>(e) << 1 ^ static_cast<uint64_t>(e >> 63)) + 1;
    const auto n_digits = static_cast<int>(coder.raw(lane, static_cast<uint32_t>(63 - std::countl_zero(above | 1)), 6));
    const uint64_t digits = above & ((uint64_t{1} << n_digits) - 1);
    const uint64_t decoded = (uint64_t{1} << n_digits | code_digits(coder, lane, digits, n_digits)) - 1;
    return static_cast<int64_t>(decoded >> 1 ^ (0 - (decoded & 1)));
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
