// A symbol under the weighted mean of several adaptive rows; the weights go to those that told it best.
//
// Each step is one of expectation maximisation for a mixture: a weight moves towards the share that its
// row had in the probability of the symbol.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lanes.hpp"
#include "symbol_row.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <size_t n_rows>
class SymbolMixer {
    static_assert(n_rows <= 4);

public:
    SymbolMixer() {
        for (size_t i = 0; i < n_rows; ++i) weights_[i] = 1.0f / n_rows;
    }

    template <class Coder>
    uint32_t code(Coder& coder, size_t lane, const std::array<SymbolRow*, n_rows>& rows, uint32_t symbol) {
        std::array<uint16_t, n_rows> weights;
        for (size_t i = 0; i < n_rows; ++i) weights[i] = static_cast<uint16_t>(static_cast<int32_t>(weights_[i] * 65535.0f));
        const SymbolMix mix = mixed(rows, weights);
        symbol = coder.fixed(lane, mix, symbol);
        learn_weights(rows, symbol);
        for (SymbolRow* row : rows) learn(*row, mix, symbol);
        return symbol;
    }

private:
    static constexpr float rate = 0.02f, least_weight = 0.005f;

    void learn_weights(const std::array<SymbolRow*, n_rows>& rows, uint32_t symbol) {
        IntLanes frequencies{};
        for (size_t i = 0; i < n_rows; ++i) frequencies[i] = static_cast<int32_t>(rows[i]->frequency(symbol));
        const Lanes shares = weights_ * __builtin_convertvector(frequencies, Lanes);
        Lanes moved = weights_ * (1.0f - rate) + shares * (rate / sum(shares));
        for (size_t i = 0; i < 4; ++i) moved[i] = i < n_rows && moved[i] < least_weight ? least_weight : moved[i];
        weights_ = moved * (0.99999f / sum(moved));  // so that they add up to at most 1 once rounded
    }

    Lanes weights_{};
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
