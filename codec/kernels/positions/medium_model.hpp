// One residual as a symbol, its half-octave under the mean of four adaptive distributions; then its sign
// in one counted context, and raw digits.
//
// A residual that would repeat a neighbour's value has a decision of its own where such residuals are
// frequent.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "../adaptive_symbol.hpp"
#include "../ans.hpp"
#include "light_context.hpp"
#include "residual_digits.hpp"

namespace ebz::positions {

class MediumModel {
public:
    using Context = LightContext;

    MediumModel() {
        hits_.fill(8192);
        for (auto& row : signs_) row.fill(16384);
    }

    template <class Coder>
    int64_t code(Coder& coder, const Context& x, int64_t e) {
        uint16_t& hits = hits_[x.value_context];
        const bool may_hit = x.value != 0 && hits >= min_hits;
        if (may_hit && coder.bit(0, e == x.value, hits)) {
            learn(hits, true);
            return x.value;
        }
        const int64_t residual = code_residual(coder, x, e);
        if (x.value != 0) learn(hits, residual == x.value);
        return residual;
    }

private:
    static constexpr size_t n_contexts = Context::n_contexts;
    static constexpr uint16_t min_hits = 2048;  // of 2^15

    static void learn(uint16_t& p, bool bit) { p = static_cast<uint16_t>(p + (((bit ? 32768 - 31 : 31) - p) >> 5)); }

    template <class Coder>
    int64_t code_residual(Coder& coder, const Context& x, int64_t e) {
        std::array<AdaptiveSymbol<16>*, n_contexts> rows;
        for (size_t i = 0; i < n_contexts; ++i) rows[i] = &rows_[i][x.context[i]];
        const auto mean = AdaptiveSymbol<16>::mean(*rows[0], *rows[1], *rows[2], *rows[3]);
        const uint64_t a = magnitude(e);
        const uint32_t token = coder.fixed(0, mean, residual_token(a, x.shift));
        for (auto* row : rows) row->learn(token);
        if (token == 0 && x.shift == 0) return 0;
        if (token == escape_token) return code_large(coder, 0, e);
        uint16_t& sign = signs_[std::min<size_t>(token, 3)][x.context[1]];
        const bool negative = coder.bit(0, e < 0, sign);
        learn(sign, negative);
        const uint64_t decoded = code_low_digits(coder, 0, token, x.shift, a);
        return with_sign(decoded, negative);
    }

    std::array<std::array<AdaptiveSymbol<16>, Context::n_values>, n_contexts> rows_;
    std::array<std::array<uint16_t, Context::n_values>, 4> signs_;
    std::array<uint16_t, Context::n_value_contexts> hits_;
};

// Vertices without known neighbours: differences to the one before.
class MediumSeeds {
public:
    template <class Coder>
    void code(Coder& coder, std::span<int64_t> position) {
        for (size_t d = 0; d < 3; ++d) {
            const int64_t change = code_large(coder, 0, wrapping_difference(position[d], last_[d]));
            last_[d] = position[d] = wrapping_sum(last_[d], change);
        }
    }

private:
    std::array<int64_t, 3> last_{};
};

}  // namespace ebz::positions
