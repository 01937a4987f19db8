// Probabilities in the logistic domain, as integer tables.
//
// stretch(p) = ln(p / (1 - p)) in units of 1/256, squash is its inverse.  The tables come from + * / on
// doubles at compile time, which IEEE rounds alike everywhere; their digests are asserted.
// Reference: M. Mahoney, "Adaptive weighing of context models for lossless data compression", 2005.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace ebz {

inline constexpr int stretch_unit = 256;
inline constexpr int stretch_limit = 9 * stretch_unit - 1;  // squash is within 8 / 2^16 of 0 or 1 there
inline constexpr int stretch_bits = 12;                      // of a probability, as index of the table

namespace logistic {

constexpr double step = 1.0039138893383475734;  // e^(1 / 256)

constexpr auto make_squash() {
    std::array<uint16_t, 2 * stretch_limit + 1> table{};
    double power = 1;  // e^(x / 256)
    for (int x = 0; x <= stretch_limit; ++x, power *= step) {
        const double p = 65536 / (1 + 1 / power);
        table[stretch_limit + x] = static_cast<uint16_t>(p < 65535 ? p + 0.5 : 65535);
        table[stretch_limit - x] = static_cast<uint16_t>(65536 - table[stretch_limit + x]);
    }
    return table;
}

inline constexpr auto squash_table = make_squash();

// The largest x whose squash is at most the middle of each interval of probabilities.
constexpr auto make_stretch() {
    std::array<int16_t, 1 << stretch_bits> table{};
    int x = -stretch_limit;
    for (int i = 0; i < 1 << stretch_bits; ++i) {
        const int middle = (2 * i + 1) << (15 - stretch_bits);
        while (x < stretch_limit && squash_table[stretch_limit + x + 1] <= middle) ++x;
        table[i] = static_cast<int16_t>(x);
    }
    return table;
}

inline constexpr auto stretch_table = make_stretch();

constexpr uint64_t digest(const auto& table) {
    uint64_t sum = 0;
    for (const auto value : table) sum = sum * 31 + static_cast<uint16_t>(value);
    return sum;
}

static_assert(digest(squash_table) == 0xc269d253f3883a80);
static_assert(digest(stretch_table) == 0x07a3094cf3ac11c9);

}  // namespace logistic

// In 2^-16; 8 to 65528.
inline int squash(int x) {
    return logistic::squash_table[stretch_limit + std::clamp(x, -stretch_limit, stretch_limit)];
}

// p in 2^-12, 0 to 4095.
inline int stretch(int p) { return logistic::stretch_table[p]; }

}  // namespace ebz
