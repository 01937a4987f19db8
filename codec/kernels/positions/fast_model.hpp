// Three residuals at a time, each by a symbol in a row of its own and plain bits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "../entropy/adaptive_symbol.hpp"
#include "lanes.hpp"
#include "residual_digits.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// A number below 2^8 for each axis, the first lowest.
using Sizes = uint32_t;

inline uint32_t size_of(Sizes sizes, size_t d) { return sizes >> (8 * d) & 0xff; }

// Of each axis, halves upwards.
inline Sizes mean(Sizes a, Sizes b) { return (a | b) - ((a ^ b) >> 1 & 0x7f7f7f); }

// What a token tells of a residual: the magnitude is at least `least`, the sign and more are in n_bits digits.
struct Meaning {
    uint32_t least;
    uint8_t n_bits;
    uint8_t size;  // about the half-octave: the next vertex does not wait for the digits
    bool is_escape;

    constexpr Meaning() : least(0), n_bits(0), size(0), is_escape(false) {}
    constexpr Meaning(uint32_t token, int shift) {
        const int n = n_low_digits(token, shift);
        const auto h = static_cast<uint32_t>(shift);
        least = static_cast<uint32_t>(leading_digits(token) << n);
        n_bits = static_cast<uint8_t>(n + (token + h != 0));
        size = static_cast<uint8_t>(token == 0 ? h : token + 2 * h);
        is_escape = token == escape_token;
    }

    // The sign is the lowest digit.
    uint64_t digits(int32_t e) const { return (static_cast<uint64_t>(magnitude(e)) << 1 | (e < 0)) & ((uint64_t{1} << n_bits) - 1); }
    int32_t residual(uint64_t digits) const { return static_cast<int32_t>(with_sign(least + (digits >> 1), digits & 1)); }
};

inline constexpr uint32_t n_expected = 32;  // the digits of all axes are 54 at most

// Streams that are not ours may let sizes grow further than those of 32 bits.
inline constexpr int most_shift = 27;
constexpr int shift_of(uint32_t expected) { return expected < 8 ? 0 : std::min(static_cast<int>(expected - 8) / 2, most_shift); }

inline constexpr auto meanings = [] {
    std::array<std::array<Meaning, 16>, n_expected> table;
    for (uint32_t x = 0; x < n_expected; ++x)
        for (uint32_t token = 0; token < 16; ++token) table[x][token] = Meaning(token, shift_of(x));
    return table;
}();

// A coordinate's residual is told by its size; those far from what was expected by one told before, or in full.
class FastModel {
public:
    static constexpr size_t n_kinds = 4;
    using Row = AdaptiveSymbol<16>;
    using Residuals = IntLanes;  // the last lane is of no account

    // expected: the half-octaves that the magnitudes are expected in.  Returns those that they are found in.
    template <class Coder>
    Sizes code(Coder& coder, size_t kind, Sizes expected, Residuals& e) {
        if ((expected & 0xe0e0e0) != 0) return code_wide(coder, kind, expected, e);
        std::array<const Meaning*, 3> found;
        uint32_t escapes = 0;
        for (size_t d = 0; d < 3; ++d) {
            const uint32_t x = size_of(expected, d);
            const uint32_t token = code_token(coder, d, rows_[kind][d][x], e[d], shift_of(x));
            found[d] = &meanings[x][token];
            escapes |= token + 1;
        }
        if (escapes > escape_token) [[unlikely]] {
            // Copies, so that these need not be in memory otherwise.
            const std::array<const Meaning*, 3> meant = found;
            Residuals surprises = e;
            const Sizes sizes = code_surprises(coder, meant, surprises);
            e = surprises;
            return sizes;
        }
        Sizes sizes = 0;
        UintLanes least{}, digits{};
        coder.plain.together([&](auto bits) {
            for (size_t d = 0; d < 3; ++d) {
                const Meaning& m = *found[d];
                digits[d] = static_cast<uint32_t>(bits(Coder::encoding ? m.digits(e[d]) : 0, m.n_bits));
                least[d] = m.least;
                sizes |= Sizes{m.size} << (8 * d);
            }
        });
        // As Meaning::residual.
        const UintLanes sign = digits & 1;
        if constexpr (!Coder::encoding) e = reinterpret_cast<IntLanes>(((least + (digits >> 1)) ^ (0 - sign)) + sign);
        return sizes;
    }

private:
    static constexpr size_t n_recent = 15;

    template <class Coder>
    static uint32_t code_token(Coder& coder, size_t d, Row& row, int32_t e, int shift) {
        return coder.symbols.symbol(d, row, Coder::encoding ? residual_token(magnitude(e), shift) : 0);
    }

    // Whatever is expected.
    template <class Coder>
    [[gnu::noinline]] Sizes code_wide(Coder& coder, size_t kind, Sizes expected, Residuals& e) {
        std::array<Meaning, 3> wide;
        for (size_t d = 0; d < 3; ++d) {
            const uint32_t x = size_of(expected, d);
            wide[d] = Meaning(code_token(coder, d, rows_[kind][d][std::min(x, n_expected - 1)], e[d], shift_of(x)), shift_of(x));
        }
        return code_surprises(coder, {&wide[0], &wide[1], &wide[2]}, e);
    }

    template <class Coder>
    [[gnu::noinline]] Sizes code_surprises(Coder& coder, const std::array<const Meaning*, 3>& found, Residuals& e) {
        Sizes sizes = 0;
        for (size_t d = 0; d < 3; ++d) {
            const Meaning& m = *found[d];
            if (m.is_escape) {
                e[d] = code_surprise(coder, d, e[d]);
                sizes |= half_octave(magnitude(e[d])) << (8 * d);
            } else {
                e[d] = m.residual(coder.plain.bits(m.digits(e[d]), m.n_bits));
                sizes |= Sizes{m.size} << (8 * d);
            }
        }
        return sizes;
    }

    // 0: a new one; else its place among the recent ones, from 1.
    template <class Coder>
    int32_t code_surprise(Coder& coder, size_t d, int32_t e) {
        std::array<int32_t, n_recent>& recent = recent_[d];
        uint32_t place = 0;
        if constexpr (Coder::encoding) {
            const auto at = std::find(recent.begin(), recent.end(), e);
            place = at == recent.end() ? 0 : static_cast<uint32_t>(at - recent.begin()) + 1;
        }
        place = coder.symbols.symbol(d, places_[d], place);
        if (place > 0) return recent[place - 1];
        const uint32_t zigzag = static_cast<uint32_t>(e) << 1 ^ static_cast<uint32_t>(e >> 31);
        const auto n_digits = static_cast<int>(coder.plain.bits(static_cast<uint64_t>(std::bit_width(zigzag)), 6));
        const auto digits = static_cast<uint32_t>(coder.plain.bits(zigzag, std::min(n_digits, 32)));
        e = static_cast<int32_t>(digits >> 1 ^ (0 - (digits & 1)));
        recent[oldest_[d]] = e;
        oldest_[d] = static_cast<uint8_t>((oldest_[d] + 1u) % n_recent);
        return e;
    }

    std::array<std::array<std::array<Row, n_expected + 1>, 3>, n_kinds> rows_;
    std::array<Row, 3> places_;
    std::array<std::array<int32_t, n_recent>, 3> recent_{};
    std::array<uint8_t, 3> oldest_{};
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
