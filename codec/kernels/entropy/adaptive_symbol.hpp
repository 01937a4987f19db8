// Adaptive frequencies of 8 or 16 symbols: cumulative frequencies that move towards each symbol seen.
//
// Reference: F. Giesen, "Models for adaptive arithmetic coding", 2015.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "../instruction_set.hpp"

namespace ebz {
inline namespace EBZ_INSTRUCTIONS {

struct Share {
    uint16_t start, frequency;
};

template <int n>
class alignas(n == 16 ? 64 : 32) AdaptiveSymbol {
    static_assert(n == 8 || n == 16);

public:
    static constexpr int total_bits = 15;
    static constexpr int n_symbols = n;
    static constexpr int least_frequency = 8;  // of 2^15

    // The first n_used symbols are equally likely, the others as rare as can be.
    constexpr explicit AdaptiveSymbol(int n_used = n) {
        const int share = (total - (n - n_used) * least_frequency) / n_used;
        for (int i = 0; i <= n; ++i) {
            const int start = i < n_used ? i * share : total - (n - i) * least_frequency;
            starts_[i] = static_cast<uint16_t>(start);
        }
    }

    // The first symbols have these shares of 2^16, which are all of it.
    template <size_t n_used>
    explicit AdaptiveSymbol(const std::array<uint32_t, n_used>& shares) {
        uint64_t sum = 0;
        for (size_t i = 0; i <= n; ++i) {
            starts_[i] = static_cast<uint16_t>(least_frequency * i + ((total - least_frequency * n) * sum >> 16));
            if (i < n_used) sum += shares[i];
        }
    }

    uint16_t start(uint32_t symbol) const { return starts_[symbol]; }

    Share share(uint32_t symbol) const {
        return {starts_[symbol], static_cast<uint16_t>(starts_[symbol + 1] - starts_[symbol])};
    }

    // The symbol that owns slot < 2^15.
    uint32_t find(uint32_t slot) const {
#ifdef EBZ_AVX2
        if constexpr (n == 16) {
            const __m256i row = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(starts_.data()));
            const __m256i above = _mm256_cmpgt_epi16(row, _mm256_set1_epi16(static_cast<int16_t>(slot)));
            return static_cast<uint32_t>(std::countr_zero(static_cast<uint32_t>(_mm256_movemask_epi8(above)))) / 2 - 1;
        }
#endif
#ifdef __SSE2__
        const __m128i at = _mm_set1_epi16(static_cast<int16_t>(slot));
        const auto* row = reinterpret_cast<const __m128i*>(starts_.data());
        const __m128i above = _mm_packs_epi16(_mm_cmpgt_epi16(_mm_load_si128(row), at),
                                              _mm_cmpgt_epi16(_mm_load_si128(row + n / 8 - 1), at));
        return static_cast<uint32_t>(std::countr_zero(static_cast<uint32_t>(_mm_movemask_epi8(above)) | 1u << n)) - 1;
#else
        uint32_t symbol = 0;
        while (symbol + 1 < n_symbols && starts_[symbol + 1] <= slot) ++symbol;
        return symbol;
#endif
    }

    // Every start moves by 2^-rate of its distance to where it would be if only this symbol occurred;
    // the rate falls from 1/8 to 1/64 (rounding keeps each frequency at least_frequency or above).
    void learn(uint32_t symbol) {
        const int rate = rates[n_seen_];
        n_seen_ = static_cast<uint8_t>(n_seen_ + (n_seen_ < max_seen));
#ifdef EBZ_AVX2
        if constexpr (n == 16) {
            auto* row = reinterpret_cast<__m256i*>(starts_.data());
            const __m256i old = _mm256_loadu_si256(row);
            const __m256i target = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(targets[symbol].data()));
            const __m256i change = _mm256_sra_epi16(_mm256_sub_epi16(target, old), _mm_cvtsi32_si128(rate));
            return _mm256_storeu_si256(row, _mm256_add_epi16(old, change));
        }
#endif
#ifdef __SSE2__
        auto* row = reinterpret_cast<__m128i*>(starts_.data());
        const auto* target = reinterpret_cast<const __m128i*>(targets[symbol].data());
        const __m128i shift = _mm_cvtsi32_si128(rate);
        for (int i = 0; i < n / 8; ++i) {
            const __m128i old = _mm_load_si128(row + i);
            _mm_store_si128(row + i, _mm_add_epi16(old, _mm_sra_epi16(_mm_sub_epi16(_mm_load_si128(target + i), old), shift)));
        }
#else
        for (int i = 0; i < n_symbols; ++i) {
            const int old = starts_[i];
            starts_[i] = static_cast<uint16_t>(old + ((targets[symbol][i] - old) >> rate));
        }
#endif
    }

private:
    static constexpr int total = 1 << total_bits;
    static constexpr int max_seen = 63;

    struct alignas(16) Row : std::array<int16_t, n_symbols> {};
    static constexpr auto targets = [] {
        std::array<Row, n_symbols> table{};
        for (int s = 0; s < n_symbols; ++s)
            for (int i = 0; i < n_symbols; ++i)
                table[s][i] = static_cast<int16_t>(least_frequency * i + (i > s ? total - least_frequency * n_symbols : 0));
        return table;
    }();
    static constexpr auto rates = [] {
        std::array<uint8_t, max_seen + 1> table{};
        for (int i = 0; i <= max_seen; ++i) table[i] = i < 6 ? 3 : i < 20 ? 4 : i < max_seen ? 5 : 6;
        return table;
    }();

    std::array<uint16_t, n_symbols + 1> starts_;
    uint8_t n_seen_ = 0;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz
