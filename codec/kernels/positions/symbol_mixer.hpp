// A symbol under the weighted mean of several adaptive rows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mixing_weights.hpp"
#include "symbol_row.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class SymbolMixer {
    using Weights = MixingWeights<MixingRates{0.02f, 0.0001f}>;

public:
    static constexpr size_t n_rows = Weights::n;

    template <class Coder>
    uint32_t code(Coder& coder, size_t lane, const std::array<SymbolRow*, n_rows>& rows, uint32_t symbol) {
        const SymbolMix mix = mixed(rows, weights_.shares());
        symbol = coder.fixed(lane, mix, symbol);
        weights_.learn(frequencies(rows, symbol));
        for (SymbolRow* row : rows) learn(*row, mix, symbol);
        return symbol;
    }

private:
    static IntLanes frequencies(const std::array<SymbolRow*, n_rows>& rows, uint32_t symbol) {
        IntLanes of_rows;
        const bool is_inner = symbol - 1 < SymbolRow::n_symbols - 2;
        if (is_inner) [[likely]]
            for (size_t i = 0; i < n_rows; ++i) of_rows[i] = rows[i]->inner_frequency(symbol);
        else
            for (size_t i = 0; i < n_rows; ++i) of_rows[i] = static_cast<int32_t>(rows[i]->frequency(symbol));
        return of_rows;
    }

    Weights weights_;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
