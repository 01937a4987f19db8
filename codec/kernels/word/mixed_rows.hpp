// Distributions of the next symbol of the word in four contexts, mixed.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "direct_word.hpp"
#include "match_model.hpp"
#include "../positions/mixing_weights.hpp"
#include "word_contexts.hpp"
#include "word_view.hpp"

namespace ebz {

// starts[i], 0 < i < 5, of 2^15 is where symbol i begins; starts[0], always 0, holds the number of symbols seen
// instead, and what would end the last symbol a part of the context's hash, 0 if the row is empty.
struct alignas(16) WordRow {
    static constexpr size_t counter = 0, check = n_symbols;
    static constexpr uint16_t last_count = INT16_MAX, first_count = last_count - 255;

    std::array<uint16_t, 8> starts{};

    // False if the row was not of the context with this check, and now starts as the first one is.
    bool claim(uint16_t of, const WordRow& first);
};

// What is neither counter nor check.
inline constexpr WordRow inner_starts{{0, 0xffff, 0xffff, 0xffff, 0xffff}};

#ifdef __SSE2__
inline __m128i vector(const WordRow& row) { return _mm_load_si128(reinterpret_cast<const __m128i*>(row.starts.data())); }
inline void store(WordRow& row, __m128i starts) { _mm_store_si128(reinterpret_cast<__m128i*>(row.starts.data()), starts); }

// Stored at once, as the next load of the row would wait for parts.
inline bool WordRow::claim(uint16_t of, const WordRow& first) {
    if (starts[check] == of) return true;
    const __m128i others = _mm_insert_epi16(_mm_cvtsi32_si128(first_count), of, check);
    store(*this, _mm_or_si128(_mm_and_si128(vector(first), vector(inner_starts)), others));
    return false;
}
#else
inline bool WordRow::claim(uint16_t of, const WordRow& first) {
    if (starts[check] == of) return true;
    starts = first.starts;
    starts[counter] = first_count;
    starts[check] = of;
    return false;
}
#endif

// A mean of rows, which teaches them.
class WordMix {
public:
    static constexpr size_t n_rows = 4;
    static constexpr int total_bits = 15;
    using Weights = positions::MixingWeights<positions::MixingRates{0.04f, 0.00005f}>;

    WordMix() { mean_.starts[n_symbols] = total; }

    void mix(const std::array<WordRow*, n_rows>& rows, Weights& weights) {
        rows_ = rows;
        weights_ = &weights;
        const Weights::Shares& shares = weights.shares();
#ifdef __SSE2__
        __m128i sum = _mm_setzero_si128();
        for (size_t i = 0; i < n_rows; ++i) {
            const __m128i share = _mm_set1_epi16(static_cast<int16_t>(shares[i]));
            sum = _mm_add_epi16(sum, _mm_mulhi_epu16(vector(*rows[i]), share));
        }
        store(mean_, _mm_or_si128(_mm_and_si128(sum, vector(inner_starts)), vector(end)));
#else
        for (size_t k = 1; k < n_symbols; ++k) {
            uint32_t sum = 0;
            for (size_t i = 0; i < n_rows; ++i) sum += uint32_t{rows[i]->starts[k]} * shares[i] >> 16;
            mean_.starts[k] = static_cast<uint16_t>(sum);
        }
#endif
    }

    uint16_t start(uint32_t symbol) const { return mean_.starts[symbol]; }
    Share share(uint32_t symbol) const { return {start(symbol), static_cast<uint16_t>(start(symbol + 1) - start(symbol))}; }

    void learn(uint32_t symbol) {
        positions::IntLanes frequencies;
        for (size_t i = 0; i < n_rows; ++i) {
            const int begin = symbol == 0 ? 0 : rows_[i]->starts[symbol], after = symbol == n_symbols - 1 ? total : rows_[i]->starts[symbol + 1];
            frequencies[i] = after - begin;
        }
        weights_->learn(frequencies);
        for (WordRow* row : rows_) learn(*row, symbol);
    }

private:
    static constexpr int total = 1 << total_bits, least_frequency = 8;  // of which rounding leaves 4 or more

    // After n symbols a row moves by 2^-rates[n] of the distance to the latest.
    static constexpr auto rates = [] {
        std::array<uint8_t, WordRow::last_count - WordRow::first_count + 1> table{};
        for (size_t i = 0; i < table.size(); ++i)
            table[i] = static_cast<uint8_t>(i < 2 ? 1 : i < 4 ? 2 : i < 12 ? 3 : i < 30 ? 4 : i < 80 ? 5 : i < 255 ? 6 : 7);
        return table;
    }();
    static constexpr auto targets = [] {
        std::array<WordRow, n_symbols> table{};
        for (size_t s = 0; s < n_symbols; ++s)
            for (size_t i = 1; i < n_symbols; ++i)
                table[s].starts[i] = static_cast<uint16_t>(least_frequency * i + (i > s ? total - least_frequency * n_symbols : 0));
        return table;
    }();
    // In place of the counter, and as the end of the last symbol.
    static constexpr WordRow one{{1}}, end{{0, 0, 0, 0, 0, total}};

    static void learn(WordRow& row, uint32_t symbol) {
        const int rate = rates[static_cast<size_t>(row.starts[WordRow::counter] - WordRow::first_count)];
#ifdef __SSE2__
        const __m128i old = vector(row), change = _mm_sra_epi16(_mm_sub_epi16(vector(targets[symbol]), old), _mm_cvtsi32_si128(rate));
        // The counter saturates where it ends.
        const __m128i moved = _mm_adds_epi16(_mm_add_epi16(old, _mm_and_si128(change, vector(inner_starts))), vector(one));
        store(row, moved);
#else
        for (size_t i = 1; i < n_symbols; ++i)
            row.starts[i] = static_cast<uint16_t>(row.starts[i] + ((targets[symbol].starts[i] - row.starts[i]) >> rate));
        uint16_t& count = row.starts[WordRow::counter];
        count = std::min<uint16_t>(count + 1, WordRow::last_count);
#endif
    }

    std::array<WordRow*, n_rows> rows_{};
    Weights* weights_ = nullptr;
    WordRow mean_;
};

// By context: that of DirectRows, from which rows of the others start, what a match predicts, and two by hash.
class MixedRows {
public:
    struct History {};  // kept in the model
    static constexpr bool has_excesses = true;

    // symbols: of the word, as far as they are known.
    explicit MixedRows(std::span<const uint8_t> symbols)
        : symbols_(symbols), match_(20, static_cast<Index>(symbols.size())),
          n_bits_(std::clamp(static_cast<int>(std::bit_width(symbols.size())) - 2, 8, 13)), hashed_(n_hashed << n_bits_) {
        const DirectRows& prior = DirectRows::initial();
        for (uint32_t c = 0; c < first_.size(); ++c) {
            for (uint32_t i = 1; i < n_symbols; ++i) first_[c].starts[i] = prior.at(c).start(i);
            first_[c].starts[WordRow::counter] = WordRow::first_count + 4;
        }
    }

    WordMix& next(const Reverse& reverse, History) {
        const LoopEdge& gate = reverse.edge(reverse.gate());
        const uint32_t l0 = degree_, l1 = reverse.edge(gate.previous).degree, r0 = reverse.edge(gate.next).degree;
        const std::array<uint32_t, n_hashed> hashes = {context_hash(0, past_.latest(8), pack(past_.closed_degrees(3), l0)),
                                                       context_hash(1, pack(l0, l1, gate.excess, r0), past_.closed_degrees(2))};
        WordRow& first = first_[DirectRows::context(l0, past_.latest(2))];
        WordRow& matched = matched_[(match_.predicted() << 3 | match_.confidence()) << 4 | l0];
        std::array<WordRow*, WordMix::n_rows> rows = {&first, &matched};
        matched.claim(1, first);
        size_t known = match_.confidence();
        for (size_t i = 0; i < n_hashed; ++i) {
            WordRow& row = hashed_[i << n_bits_ | hashes[i] >> (32 - n_bits_)];
            known = known << 1 | size_t{row.claim(static_cast<uint16_t>(hashes[i] | 1), first)};
            rows[2 + i] = &row;
        }
        mix_.mix(rows, weights_[known]);
        return mix_;
    }

    // After the symbol at the position.
    History after(History, Index position, Symbol symbol, uint8_t degree) {
        past_.advance(symbol, degree_);
        degree_ = degree;
        match_.advance(symbols_, position, past_.recent());
        return {};
    }

private:
    static constexpr size_t n_hashed = 2;

    std::span<const uint8_t> symbols_;
    WordHistory past_;
    uint8_t degree_ = 0;  // of the gate's left end
    MatchModel match_;
    int n_bits_;
    std::array<WordRow, (max_degree + 1) * 64> first_;
    std::array<WordRow, (n_symbols + 1) * 8 * (max_degree + 1)> matched_;
    std::vector<WordRow> hashed_;
    std::array<WordMix::Weights, 8 << n_hashed> weights_;  // by the confidence of the match, and which contexts were known
    WordMix mix_;
};

}  // namespace ebz
