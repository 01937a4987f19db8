// One residual as a symbol and plain digits.
//
// Symbols stand for 0 and, on either side of it, half-octaves of the residual under a shift.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "../entropy/adaptive_symbol.hpp"
#include "residual_digits.hpp"
#include "symbol_mixer.hpp"
#include "symbol_row.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class LightModel {
public:
    static constexpr size_t n_contexts = SymbolMixer::n_rows, n_values = 756, n_sets = 15;
    using Contexts = std::array<size_t, n_contexts>;  // < n_values

    template <class Coder>
    int64_t code(Coder& coder, size_t lane, const Contexts& contexts, size_t set, int shift, int64_t e) {
        std::array<SymbolRow*, n_contexts> rows;
        for (size_t i = 0; i < n_contexts; ++i) rows[i] = &rows_[i][contexts[i]];
        const uint32_t token = mixers_[set].code(coder.symbols, lane, rows, Coder::encoding ? token_of(cell_of(e, shift)) : 0);
        if (token == escape_token) return code_far(coder, lane, shift, e);
        const uint64_t first = (static_cast<uint64_t>(int64_t{first_cell[token]}) << shift) - half(shift);
        return static_cast<int64_t>(first + coder.plain.bits(Coder::encoding ? static_cast<uint64_t>(e) - first : 0, cell_digits[token] + shift));
    }

private:
    static constexpr uint32_t zero_token = 7, escape_size = 8;
    static constexpr uint64_t escape_magnitude = 16;
    static constexpr size_t n_shifts = 48;
    // The first cell of each symbol and the digits that tell those of a symbol apart.
    static constexpr std::array<int8_t, 16> first_cell = {-15, -11, -7, -5, -3, -2, -1, 0, 1, 2, 3, 4, 6, 8, 12, 0};
    static constexpr std::array<uint8_t, 16> cell_digits = {2, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 2, 2, 0};

    static uint64_t half(int shift) { return (uint64_t{1} << shift) >> 1; }

    // The nearest multiple of 2^shift.
    static int64_t cell_of(int64_t e, int shift) { return static_cast<int64_t>(static_cast<uint64_t>(e) + half(shift)) >> shift; }

    static uint32_t token_of(int64_t cell) {
        const uint32_t size = half_octave(magnitude(cell));
        return size >= escape_size ? escape_token : cell < 0 ? zero_token - size : zero_token + size;
    }

    template <class Coder>
    int64_t code_far(Coder& coder, size_t lane, int shift, int64_t e) {
        const int64_t cell = cell_of(e, shift);
        const uint64_t beyond = magnitude(cell) - escape_magnitude;
        const uint32_t token = coder.symbols.symbol(lane, far_[static_cast<size_t>(shift)], residual_token(beyond, 0));
        if (token == escape_token) return code_large(coder.symbols, lane, e);
        const bool negative = coder.plain.bits(cell < 0 ? 1 : 0, 1) != 0;
        const int n = n_low_digits(token, 0);
        const uint64_t mask = (uint64_t{1} << shift) - 1;
        const uint64_t digits = (beyond & ((uint64_t{1} << n) - 1)) << shift | ((static_cast<uint64_t>(e) + half(shift)) & mask);
        const uint64_t low = coder.plain.bits(digits, n + shift);
        const uint64_t above = (leading_digits(token) << n | low >> shift) + escape_magnitude;
        return static_cast<int64_t>(((negative ? 0 - above : above) << shift) + (low & mask) - half(shift));
    }

    std::array<std::array<SymbolRow, n_values>, n_contexts> rows_;
    std::array<SymbolMixer, n_sets> mixers_;
    std::array<AdaptiveSymbol<16>, n_shifts> far_;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
