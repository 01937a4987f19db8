// One residual as a symbol and raw digits.
//
// Symbols stand for 0 and, on either side of it, the half-octaves of the magnitude under a shift.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "../adaptive_symbol.hpp"
#include "residual_digits.hpp"
#include "symbol_mixer.hpp"
#include "symbol_row.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <size_t n_contexts>
class LightModel {
public:
    static constexpr size_t n_values = 1024, n_sets = 15;
    using Contexts = std::array<size_t, n_contexts>;  // < n_values

    template <class Coder>
    int64_t code(Coder& coder, size_t lane, const Contexts& contexts, size_t set, int shift, int64_t e) {
        const uint64_t half = (uint64_t{1} << shift) >> 1, mask = (uint64_t{1} << shift) - 1;
        const uint64_t shifted = static_cast<uint64_t>(e) + half;
        const int64_t cell = static_cast<int64_t>(shifted) >> shift;  // the nearest multiple
        const uint64_t a = magnitude(cell);
        const uint32_t size = half_octave(a);
        std::array<SymbolRow*, n_contexts> rows;
        for (size_t i = 0; i < n_contexts; ++i) rows[i] = &rows_[i][contexts[i]];
        const uint32_t token = size >= escape_size ? escape_token : cell < 0 ? zero_token - size : zero_token + size;
        const uint32_t symbol = mixers_[set].code(coder, lane, rows, token);
        if (symbol == escape_token) return code_far(coder, lane, shift, e, cell);
        const bool negative = symbol < zero_token;
        const uint32_t decoded_size = negative ? zero_token - symbol : symbol - zero_token;
        const int n_digits = n_low_digits(decoded_size, 0);
        const uint64_t digits = (a & ((uint64_t{1} << n_digits) - 1)) << shift | (shifted & mask);
        const uint64_t low = code_digits(coder, lane, digits, n_digits + shift);
        const uint64_t above = leading_digits(decoded_size) << n_digits | low >> shift;
        return joined_up(above, negative, low & mask, shift);
    }

private:
    static constexpr uint32_t zero_token = 7, escape_size = 8;
    static constexpr uint64_t escape_magnitude = 16;

    // cell, of magnitude `above`, and the digits below it.
    static int64_t joined_up(uint64_t above, bool negative, uint64_t low, int shift) {
        const uint64_t cell = negative ? 0 - above : above, half = (uint64_t{1} << shift) >> 1;
        return static_cast<int64_t>((cell << shift | low) - half);
    }

    template <class Coder>
    int64_t code_far(Coder& coder, size_t lane, int shift, int64_t e, int64_t cell) {
        const uint64_t beyond = magnitude(cell) - escape_magnitude;
        const uint32_t token = coder.symbol(lane, far_[static_cast<size_t>(shift)], residual_token(beyond, 0));
        if (token == escape_token) return code_large(coder, lane, e);
        const bool negative = coder.raw(lane, cell < 0 ? 1 : 0, 1) != 0;
        const int n_digits = n_low_digits(token, 0);
        const uint64_t half = (uint64_t{1} << shift) >> 1, mask = (uint64_t{1} << shift) - 1;
        const uint64_t digits = (beyond & ((uint64_t{1} << n_digits) - 1)) << shift | ((static_cast<uint64_t>(e) + half) & mask);
        const uint64_t low = code_digits(coder, lane, digits, n_digits + shift);
        const uint64_t above = (leading_digits(token) << n_digits | low >> shift) + escape_magnitude;
        return joined_up(above, negative, low & mask, shift);
    }

    std::array<std::array<SymbolRow, n_values>, n_contexts> rows_;
    std::array<SymbolMixer<n_contexts>, n_sets> mixers_;
    std::array<AdaptiveSymbol<16>, 48> far_;
};

// Vertices without known neighbours: differences to the one before.
class LightSeeds {
public:
    template <class Coder>
    void code(Coder& coder, int64_t* position) {
        for (size_t d = 0; d < 3; ++d) {
            const int64_t change = code_large(coder, d, wrapping_difference(position[d], last_[d]));
            last_[d] = position[d] = wrapping_sum(last_[d], change);
        }
    }

private:
    std::array<int64_t, 3> last_{};
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
