// The residual of a vertex as one symbol per axis, all three side by side, and plain digits.
//
// Symbols stand for 0 and, on either side of it, half-octaves of the residual under a shift; for the value of a
// neighbour; and for what was expected exactly.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "../entropy/adaptive_symbol.hpp"
#include "int_lanes.hpp"
#include "residual_digits.hpp"
#include "symbol_row.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class MediumModel {
public:
    // What is known about the residuals, per axis.
    struct Circumstances {
        Lanes scale;      // their likely size
        Lanes spread;     // of what predicts them
        Lanes drift;      // those of neighbours
        Lanes fraction;   // the smooth prediction
        UintLanes near;   // one that would repeat a neighbour's value
        int32_t two;      // 1 if two faces predict, else 0
    };

    template <class Coder>
    UintLanes code(Coder& coder, const Circumstances& known, UintLanes e) {
        const Shifts shifts(known.scale);
        const Lanes cell = reinterpret_cast<Lanes>((127 - shifts.by) << 23);  // 2^-shift
        const Lanes pulled = known.drift * 3.0f / (known.scale + 0.125f);
        const IntLanes near = truncated(clamp(as_floats(known.near) * cell, -7.0f, 7.0f) + 7.5f);
        const IntLanes wide = half_octaves(known.spread) - 2 * shifts.by;
        const std::array<IntLanes, 3> contexts = {first_by_level + (shifts.level << 4) + at_most_15(wide),
                                                  first_by_value + (near << 4) + fifteenths(known.fraction * cell),
                                                  first_by_drift + known.two * (n_levels << 4) + (shifts.level << 4) + fifteenths(pulled)};
        Rows<3> rows;
        for (size_t d = 0; d < 3; ++d)
            for (size_t i = 0; i < 3; ++i)
                rows[d][i] = &rows_[d][static_cast<size_t>(contexts[by_merit_[i]][d])];
        return code(coder, rows, shifts, known.near, e);
    }

    // Where only the size of the residual before is known; kind: 0 or 1.
    template <class Coder>
    UintLanes code_step(Coder& coder, size_t kind, Lanes size, UintLanes e) {
        const Shifts shifts(size);
        Rows<1> rows;
        for (size_t d = 0; d < 3; ++d) rows[d] = {&step_rows_[kind][d][static_cast<size_t>(shifts.level[d])]};
        return code(coder, rows, shifts, UintLanes{}, e);
    }

private:
    static constexpr uint32_t near_token = 0, zero_token = 7, base_token = 14;
    static constexpr int top_level = 10, n_levels = top_level + 2;
    static constexpr int first_by_level = 0, first_by_value = 16 * n_levels, first_by_drift = first_by_value + 16 * 15;
    static constexpr size_t n_contexts = first_by_drift + 2 * 16 * n_levels;
    static constexpr uint64_t escape_cell = 12;
    // The first cell of each symbol and the digits that tell those of a symbol apart.
    static constexpr std::array<int8_t, 16> first_cell = {0, -11, -7, -5, -3, -2, -1, 0, 1, 2, 3, 4, 6, 8, 0, 0};
    static constexpr std::array<uint8_t, 16> cell_digits = {0, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 2, 0, 0};

    template <size_t n>
    using Rows = std::array<std::array<SymbolRow*, n>, 3>;

    // A cell is 2^by residuals; in cells a scale has a level below n_levels.
    struct Shifts {
        IntLanes by, level;

        explicit Shifts(Lanes scale) {
            const IntLanes octaves = half_octaves(scale), above = octaves - top_level;
            by = (above & (above > 0)) >> 1;
            level = octaves - 2 * by;
        }
    };

    static IntLanes at_most_15(IntLanes x) {
        const IntLanes positive = x & (x > 0), fits = positive < 15;
        return (positive & fits) | (15 & ~fits);
    }
    static IntLanes fifteenths(Lanes x) { return truncated(clamp(x, -7.5f, 7.0f) + 7.5f); }

    template <size_t n, class Coder>
    UintLanes code(Coder& coder, const Rows<n>& rows, const Shifts& shifts, UintLanes near, UintLanes e) {
        std::array<SymbolMix, 3> mixes;
        std::array<uint32_t, 3> tokens;
        for (size_t d = 0; d < 3; ++d) {
            mixes[d] = mean(rows[d]);
            if constexpr (Coder::encoding) tokens[d] = token(e[d], near[d], shifts.by[d]);
        }
        coder.symbols.fixed(mixes, tokens);
        if constexpr (n == 3)
            if (++n_coded_ % 4 == 0) judge(rows, tokens);
        for (size_t d = 0; d < 3; ++d)
            for (SymbolRow* row : rows[d]) learn(*row, mixes[d], tokens[d]);
        const uint32_t x = code_rest(coder, 0, tokens[0], shifts, near, e), y = code_rest(coder, 1, tokens[1], shifts, near, e);
        return UintLanes{x, y, code_rest(coder, 2, tokens[2], shifts, near, e), 0};
    }

    // The context that tells symbols best comes last and so counts most.
    void judge(const Rows<3>& rows, const std::array<uint32_t, 3>& tokens) {
        for (size_t d = 0; d < 3; ++d) {
            IntLanes frequencies{};
            for (size_t i = 0; i < 3; ++i) frequencies[by_merit_[i]] = static_cast<int32_t>(rows[d][i]->frequency(tokens[d]));
            merits_ += (bit_patterns(__builtin_convertvector(frequencies, Lanes)) - merits_) * 0.003f;
        }
        const size_t best = merits_[0] > merits_[1] ? (merits_[0] > merits_[2] ? 0 : 2) : (merits_[1] > merits_[2] ? 1 : 2);
        by_merit_ = {best == 0 ? 2u : 0u, best == 1 ? 2u : 1u, best};
    }

    // What the symbol leaves.
    template <class Coder>
    uint32_t code_rest(Coder& coder, size_t d, uint32_t token, const Shifts& shifts, UintLanes near, UintLanes e) {
        if (token - 1 < base_token - 1) return code_cell(coder, token, shifts.by[d], e[d]);
        if (token == near_token) return near[d];
        return token == base_token ? 0 : code_far(coder, d, shifts.level[d], shifts.by[d], e[d]);
    }

    // The residual's cell is the nearest multiple of 2^shift.
    static int64_t cell_of(uint32_t e, int shift) {
        return (int64_t{static_cast<int32_t>(e)} + ((int64_t{1} << shift) >> 1)) >> shift;
    }

    static uint32_t token(uint32_t e, uint32_t near, int shift) {
        if (e == 0 && shift > 0) return base_token;
        const int64_t cell = cell_of(e, shift);
        if (e == near && (shift > 0 || cell < -3 || cell > 3)) return near_token;
        const uint32_t size = half_octave(magnitude(cell));
        return size > 6 ? escape_token : cell < 0 ? zero_token - size : zero_token + size;
    }

    template <class Coder>
    static uint32_t code_cell(Coder& coder, uint32_t token, int shift, uint32_t e) {
        const uint32_t first = (static_cast<uint32_t>(int32_t{first_cell[token]}) << shift) - ((1u << shift) >> 1);
        return first + static_cast<uint32_t>(coder.plain.bits(Coder::encoding ? e - first : 0, cell_digits[token] + shift));
    }

    template <class Coder>
    uint32_t code_far(Coder& coder, size_t d, int32_t level, int shift, uint32_t e) {
        const int64_t cell = cell_of(e, shift);
        const uint64_t beyond = magnitude(cell) - escape_cell;
        const uint32_t token = coder.symbols.symbol(d, far_[d][static_cast<size_t>(level)], residual_token(beyond, 0));
        if (token == escape_token) {
            const auto n = static_cast<int>(coder.plain.bits(static_cast<uint64_t>(std::bit_width(e)), 6));
            return static_cast<uint32_t>(coder.plain.bits(e, std::min(n, 32)));
        }
        const bool negative = coder.plain.bits(cell < 0 ? 1 : 0, 1) != 0;
        const int n = n_low_digits(token, 0);
        const uint64_t half = (uint64_t{1} << shift) >> 1, mask = (uint64_t{1} << shift) - 1;
        const uint64_t digits = (beyond & ((uint64_t{1} << n) - 1)) << shift | ((e + half) & mask);
        const uint64_t low = coder.plain.bits(digits, n + shift);
        const uint64_t above = (leading_digits(token) << n | low >> shift) + escape_cell;
        return static_cast<uint32_t>(((negative ? 0 - above : above) << shift) + (low & mask) - half);
    }

    std::array<std::array<SymbolRow, n_contexts>, 3> rows_;
    std::array<size_t, 3> by_merit_ = {0, 1, 2};
    Lanes merits_{};
    uint32_t n_coded_ = 0;
    std::array<std::array<std::array<SymbolRow, n_levels>, 3>, 2> step_rows_;
    std::array<std::array<AdaptiveSymbol<16>, n_levels>, 3> far_;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
