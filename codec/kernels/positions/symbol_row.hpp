// Adaptive frequencies of 16 symbols, mixed with those of other contexts.
//
// Reference: F. Giesen, "Models for adaptive arithmetic coding", 2015.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "../adaptive_symbol.hpp"
#include "../instruction_set.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// starts[i] of 2^15 is where symbol i begins; starts[0], always 0, holds the number of symbols seen instead.
struct alignas(16) SymbolRow {
    static constexpr int total_bits = 15, n_symbols = 16, total = 1 << total_bits;
    static constexpr int least_frequency = 8;

    std::array<uint16_t, n_symbols> starts;

    constexpr SymbolRow() : starts{} {
        for (int i = 1; i < n_symbols; ++i) starts[static_cast<size_t>(i)] = static_cast<uint16_t>(i * (total / n_symbols));
    }

    uint32_t frequency(uint32_t symbol) const {
        const uint32_t begin = symbol == 0 ? 0 : starts[symbol], end = symbol == n_symbols - 1 ? total : starts[symbol + 1];
        return end - begin;
    }
};

// What symbols are coded with: a mean of rows.  Not adaptive.
struct alignas(16) SymbolMix : SymbolRow {
    Share share(uint32_t symbol) const {
        return {symbol == 0 ? uint16_t{0} : starts[symbol], static_cast<uint16_t>(frequency(symbol))};
    }

    // The symbol that owns slot < 2^15.
    uint32_t find(uint32_t slot) const {
#ifdef __SSE2__
        const auto* row = reinterpret_cast<const __m128i*>(starts.data());
        const __m128i at = _mm_set1_epi16(static_cast<int16_t>(slot));
        const __m128i above = _mm_packs_epi16(_mm_cmpgt_epi16(_mm_load_si128(row), at), _mm_cmpgt_epi16(_mm_load_si128(row + 1), at));
        return static_cast<uint32_t>(std::countr_zero(static_cast<uint32_t>(_mm_movemask_epi8(above)) | 1u << n_symbols)) - 1;
#else
        uint32_t symbol = 0;
        while (symbol + 1 < n_symbols && starts[symbol + 1] <= slot) ++symbol;
        return symbol;
#endif
    }
};

namespace symbol_rows {

// After n symbols a row moves by 2^-rates[n] of the distance to the latest.
inline constexpr int max_seen = 255;
inline constexpr auto rates = [] {
    std::array<uint8_t, max_seen + 1> table{};
    for (int i = 0; i <= max_seen; ++i)
        table[static_cast<size_t>(i)] = static_cast<uint8_t>(i < 2 ? 2 : i < 6 ? 3 : i < 20 ? 4 : i < 63 ? 5 : i < 255 ? 6 : 7);
    return table;
}();
// A row that has seen nothing starts from the mix, 1 / 32 of the way to equal frequencies.
inline constexpr int start_rate = 5;

struct alignas(16) Target : std::array<int16_t, SymbolRow::n_symbols> {};
inline constexpr auto targets = [] {
    std::array<Target, SymbolRow::n_symbols> table{};
    for (size_t s = 0; s < table.size(); ++s)
        for (size_t i = 1; i < table.size(); ++i)
            table[s][i] = static_cast<int16_t>(SymbolRow::least_frequency * static_cast<int>(i) +
                                               (i > s ? SymbolRow::total - SymbolRow::least_frequency * SymbolRow::n_symbols : 0));
    return table;
}();
inline constexpr SymbolRow flat;

}  // namespace symbol_rows

// sum of weights[i] rows[i] / 2^16, rounded down one by one; the weights add up to less than 2^16.
//
// As each of at most 7 rounds by less than 1 and rows have frequencies of 8 or above, none vanishes.
template <size_t n_rows>
SymbolMix mixed(const std::array<SymbolRow*, n_rows>& rows, const std::array<uint16_t, n_rows>& weights) {
    static_assert(n_rows < SymbolRow::least_frequency);
    SymbolMix mix;
#ifdef __SSE2__
    __m128i low = _mm_setzero_si128(), high = low;
    for (size_t i = 0; i < n_rows; ++i) {
        const auto* row = reinterpret_cast<const __m128i*>(rows[i]->starts.data());
        const __m128i weight = _mm_set1_epi16(static_cast<int16_t>(weights[i]));
        low = _mm_add_epi16(low, _mm_mulhi_epu16(_mm_load_si128(row), weight));
        high = _mm_add_epi16(high, _mm_mulhi_epu16(_mm_load_si128(row + 1), weight));
    }
    auto* out = reinterpret_cast<__m128i*>(mix.starts.data());
    _mm_store_si128(out, _mm_insert_epi16(low, 0, 0));
    _mm_store_si128(out + 1, high);
#else
    for (size_t k = 1; k < SymbolRow::n_symbols; ++k) {
        uint32_t sum = 0;
        for (size_t i = 0; i < n_rows; ++i) sum += uint32_t{rows[i]->starts[k]} * weights[i] >> 16;
        mix.starts[k] = static_cast<uint16_t>(sum);
    }
#endif
    return mix;
}

// The row moves towards the symbol; rounding keeps each frequency at least_frequency or above.
inline void learn(SymbolRow& row, const SymbolMix& mix, uint32_t symbol) {
    using namespace symbol_rows;
    const uint16_t n_seen = row.starts[0];
    const auto n_now = static_cast<uint16_t>(n_seen < max_seen ? n_seen + 1 : n_seen);
    const int rate = rates[n_seen];
#ifdef __SSE2__
    auto* at = reinterpret_cast<__m128i*>(row.starts.data());
    const auto* target = reinterpret_cast<const __m128i*>(targets[symbol].data());
    const auto* start = reinterpret_cast<const __m128i*>(mix.starts.data());
    const auto* equal = reinterpret_cast<const __m128i*>(flat.starts.data());
    const __m128i shift = _mm_cvtsi32_si128(rate);
    for (int i = 0; i < 2; ++i) {
        __m128i old = _mm_load_si128(at + i);
        if (n_seen == 0) {
            old = _mm_load_si128(start + i);
            old = _mm_add_epi16(old, _mm_srai_epi16(_mm_sub_epi16(_mm_load_si128(equal + i), old), start_rate));
        }
        _mm_store_si128(at + i, _mm_add_epi16(old, _mm_sra_epi16(_mm_sub_epi16(_mm_load_si128(target + i), old), shift)));
    }
#else
    for (size_t i = 1; i < SymbolRow::n_symbols; ++i) {
        int old = row.starts[i];
        if (n_seen == 0) old = mix.starts[i] + ((flat.starts[i] - mix.starts[i]) >> start_rate);
        row.starts[i] = static_cast<uint16_t>(old + ((targets[symbol][i] - old) >> rate));
    }
#endif
    row.starts[0] = n_now;
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
