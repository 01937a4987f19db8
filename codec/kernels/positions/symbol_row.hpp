// Adaptive frequencies of 16 symbols, mixed with those of other contexts.
//
// Reference: F. Giesen, "Models for adaptive arithmetic coding", 2015.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "../entropy/adaptive_symbol.hpp"
#include "../instruction_set.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// starts[i] of 2^15 is where symbol i begins; starts[0], always 0, holds a counter of the symbols seen instead.
struct alignas(32) SymbolRow {
    static constexpr int total_bits = 15, n_symbols = 16, total = 1 << total_bits;
    static constexpr int least_frequency = 8;
    // Counters end where signed ones of 16 bits saturate.
    static constexpr uint16_t last_count = INT16_MAX, first_count = last_count - 255;

    std::array<uint16_t, n_symbols> starts;

    constexpr SymbolRow() : starts{} {
        starts[0] = first_count;
        for (int i = 1; i < n_symbols; ++i) starts[static_cast<size_t>(i)] = static_cast<uint16_t>(i * (total / n_symbols));
    }

    // Of the symbols but the first and the last.
    int32_t inner_frequency(uint32_t symbol) const { return starts[symbol + 1] - starts[symbol]; }

    uint32_t frequency(uint32_t symbol) const {
        const uint32_t begin = symbol == 0 ? 0 : starts[symbol], end = symbol == n_symbols - 1 ? total : starts[symbol + 1];
        return end - begin;
    }
};

// What symbols are coded with: a mean of rows, as they are but for starts[0] = 0.  Not adaptive.
struct alignas(32) SymbolMix {
    static constexpr int total_bits = SymbolRow::total_bits;

    std::array<uint16_t, SymbolRow::n_symbols + 1> starts;

    SymbolMix() { starts[SymbolRow::n_symbols] = SymbolRow::total; }

    Share share(uint32_t symbol) const {
        return {starts[symbol], static_cast<uint16_t>(starts[symbol + 1] - starts[symbol])};
    }

    // The symbol that owns slot < 2^15.
    uint32_t find(uint32_t slot) const {
#if defined(EBZ_AVX2)
        const __m256i row = _mm256_load_si256(reinterpret_cast<const __m256i*>(starts.data()));
        const __m256i above = _mm256_cmpgt_epi16(row, _mm256_set1_epi16(static_cast<int16_t>(slot)));
        return 15 - static_cast<uint32_t>(std::popcount(static_cast<uint32_t>(_mm256_movemask_epi8(above)))) / 2;
#elif defined(__SSE2__)
        const auto* row = reinterpret_cast<const __m128i*>(starts.data());
        const __m128i at = _mm_set1_epi16(static_cast<int16_t>(slot));
        const __m128i above = _mm_packs_epi16(_mm_cmpgt_epi16(_mm_load_si128(row), at), _mm_cmpgt_epi16(_mm_load_si128(row + 1), at));
        return static_cast<uint32_t>(std::countr_zero(static_cast<uint32_t>(_mm_movemask_epi8(above)) | 1u << SymbolRow::n_symbols)) - 1;
#else
        uint32_t symbol = 0;
        while (symbol + 1 < SymbolRow::n_symbols && starts[symbol + 1] <= slot) ++symbol;
        return symbol;
#endif
    }
};

namespace symbol_rows {

// After n symbols a row moves by 2^-rates[n] of the distance to the latest.
inline constexpr auto rates = [] {
    std::array<uint8_t, SymbolRow::last_count - SymbolRow::first_count + 1> table{};
    for (size_t i = 0; i < table.size(); ++i)
        table[i] = static_cast<uint8_t>(i < 2 ? 2 : i < 6 ? 3 : i < 20 ? 4 : i < 63 ? 5 : i < 255 ? 6 : 7);
    return table;
}();
// A row that has seen nothing starts from the mix, 1 / 32 of the way to equal frequencies.
inline constexpr int start_rate = 5;

struct alignas(32) Target : std::array<int16_t, SymbolRow::n_symbols> {};
inline constexpr auto targets = [] {
    std::array<Target, SymbolRow::n_symbols> table{};
    for (size_t s = 0; s < table.size(); ++s)
        for (size_t i = 1; i < table.size(); ++i)
            table[s][i] = static_cast<int16_t>(SymbolRow::least_frequency * static_cast<int>(i) +
                                               (i > s ? SymbolRow::total - SymbolRow::least_frequency * SymbolRow::n_symbols : 0));
    return table;
}();
inline constexpr Target flat = [] {
    Target all{};
    for (size_t i = 1; i < all.size(); ++i) all[i] = static_cast<int16_t>(i * (SymbolRow::total / SymbolRow::n_symbols));
    return all;
}();
// What is no counter, one in place of it, and the first.
inline constexpr Target others = {0, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}, one = {1}, unseen = {SymbolRow::first_count};

}  // namespace symbol_rows

// sum of weights[i] rows[i] / 2^16, rounded down one by one; the weights add up to less than 2^16.
//
// As each of at most 7 rounds by less than 1 and rows have frequencies of 8 or above, none vanishes.
template <size_t n_rows>
SymbolMix mixed(const std::array<SymbolRow*, n_rows>& rows, const std::array<uint16_t, n_rows>& weights) {
    static_assert(n_rows < SymbolRow::least_frequency);
    SymbolMix mix;
#if defined(EBZ_AVX2)
    const auto* inner = reinterpret_cast<const __m256i*>(symbol_rows::others.data());
    __m256i all = _mm256_setzero_si256();
    for (size_t i = 0; i < n_rows; ++i) {
        const auto* row = reinterpret_cast<const __m256i*>(rows[i]->starts.data());
        all = _mm256_add_epi16(all, _mm256_mulhi_epu16(_mm256_load_si256(row), _mm256_set1_epi16(static_cast<int16_t>(weights[i]))));
    }
    _mm256_store_si256(reinterpret_cast<__m256i*>(mix.starts.data()), _mm256_and_si256(all, _mm256_load_si256(inner)));
#elif defined(__SSE2__)
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

inline SymbolMix mean(const std::array<SymbolRow*, 1>& rows) {
    SymbolMix mix;
    std::copy(rows[0]->starts.begin(), rows[0]->starts.end(), mix.starts.begin());
    mix.starts[0] = 0;
    return mix;
}

// Half of the last row, a quarter of either other; rounded up.
inline SymbolMix mean(const std::array<SymbolRow*, 3>& rows) {
    SymbolMix mix;
#if defined(EBZ_AVX2)
    const auto row = [&](size_t i) { return _mm256_load_si256(reinterpret_cast<const __m256i*>(rows[i]->starts.data())); };
    const __m256i all = _mm256_avg_epu16(row(2), _mm256_avg_epu16(row(0), row(1)));
    const auto* inner = reinterpret_cast<const __m256i*>(symbol_rows::others.data());
    _mm256_store_si256(reinterpret_cast<__m256i*>(mix.starts.data()), _mm256_and_si256(all, _mm256_load_si256(inner)));
#else
    for (size_t k = 1; k < SymbolRow::n_symbols; ++k) {
        const uint32_t side = (uint32_t{rows[0]->starts[k]} + rows[1]->starts[k] + 1) >> 1;
        mix.starts[k] = static_cast<uint16_t>((rows[2]->starts[k] + side + 1) >> 1);
    }
    mix.starts[0] = 0;
#endif
    return mix;
}

// The row moves towards the symbol; rounding keeps each frequency at least_frequency or above.
inline void learn(SymbolRow& row, const SymbolMix& mix, uint32_t symbol) {
    using namespace symbol_rows;
    const auto n_seen = static_cast<size_t>(row.starts[0] - SymbolRow::first_count);
    const int rate = rates[n_seen];
#if defined(EBZ_AVX2)
    const auto at = [](const Target& table) { return _mm256_load_si256(reinterpret_cast<const __m256i*>(table.data())); };
    auto* starts = reinterpret_cast<__m256i*>(row.starts.data());
    __m256i old = _mm256_load_si256(starts);
    if (n_seen == 0) {
        old = _mm256_load_si256(reinterpret_cast<const __m256i*>(mix.starts.data()));
        old = _mm256_add_epi16(old, _mm256_srai_epi16(_mm256_sub_epi16(at(flat), old), start_rate));
        old = _mm256_or_si256(old, at(unseen));
    }
    const __m256i change = _mm256_sra_epi16(_mm256_sub_epi16(at(targets[symbol]), old), _mm_cvtsi32_si128(rate));
    // The counter goes on by one with all else: were it stored on its own, the next load of the row would wait for it.
    _mm256_store_si256(starts, _mm256_adds_epi16(_mm256_add_epi16(old, _mm256_and_si256(change, at(others))), at(one)));
#elif defined(__SSE2__)
    const auto at = [](const Target& table, int i) { return _mm_load_si128(reinterpret_cast<const __m128i*>(table.data()) + i); };
    auto* starts = reinterpret_cast<__m128i*>(row.starts.data());
    const auto* start = reinterpret_cast<const __m128i*>(mix.starts.data());
    const __m128i shift = _mm_cvtsi32_si128(rate);
    for (int i = 0; i < 2; ++i) {
        __m128i old = _mm_load_si128(starts + i);
        if (n_seen == 0) {
            old = _mm_load_si128(start + i);
            old = _mm_add_epi16(old, _mm_srai_epi16(_mm_sub_epi16(at(flat, i), old), start_rate));
            old = _mm_or_si128(old, at(unseen, i));
        }
        const __m128i change = _mm_sra_epi16(_mm_sub_epi16(at(targets[symbol], i), old), shift);
        _mm_store_si128(starts + i, _mm_adds_epi16(_mm_add_epi16(old, _mm_and_si128(change, at(others, i))), at(one, i)));
    }
#else
    for (size_t i = 1; i < SymbolRow::n_symbols; ++i) {
        int old = row.starts[i];
        if (n_seen == 0) old = mix.starts[i] + ((flat[i] - mix.starts[i]) >> start_rate);
        row.starts[i] = static_cast<uint16_t>(old + ((targets[symbol][i] - old) >> rate));
    }
    row.starts[0] = std::min<uint16_t>(row.starts[0] + 1, SymbolRow::last_count);
#endif
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
