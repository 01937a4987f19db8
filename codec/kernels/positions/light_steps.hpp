// Differences of vertices that no parallelogram predicts: the number of their digits, by that of the one before, and these.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "../entropy/adaptive_symbol.hpp"
#include "residual_digits.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class LightSteps {
public:
    LightSteps() {
        for (auto& rows : low_) rows.fill(AdaptiveSymbol<8>(4));
    }

    // |e| < 2^63.
    template <class Coder>
    int64_t code(Coder& coder, size_t d, int64_t e) {
        const uint64_t a = magnitude(e);
        const auto length = std::min(static_cast<uint32_t>(std::bit_width(a)), 63u);
        const uint32_t high = coder.symbols.symbol(d, high_[d][before_[d]], length >> 2);
        const auto n = static_cast<int>(high << 2 | (coder.symbols.symbol(d, low_[d][high], length & 3) & 3));
        before_[d] = high;
        if (n == 0) return 0;
        const uint64_t top = uint64_t{1} << (n - 1), decoded = top | code_digits(coder.symbols, d, a & (top - 1), n - 1);
        return with_sign(decoded, coder.plain.bits(e < 0 ? 1 : 0, 1));
    }

private:
    std::array<std::array<AdaptiveSymbol<16>, 16>, 3> high_;  // quarters of the number of digits, by the one before
    std::array<std::array<AdaptiveSymbol<8>, 16>, 3> low_;
    std::array<uint32_t, 3> before_{};
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
