// Distributions of the next symbol of the word in four contexts, mixed.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "direct_word.hpp"
#include "positions/mixing_weights.hpp"
#include "word_contexts.hpp"
#include "word_view.hpp"

namespace ebz {

// starts[i], 0 < i < 5, of 2^15 is where symbol i begins; starts[0], always 0, holds the number of symbols seen
// instead, and what would end the last symbol a part of the context's hash, 0 if the row is empty.
struct alignas(16) WordRow {
    static constexpr size_t counter = 0, check = n_symbols;
    static constexpr uint16_t last_count = INT16_MAX, first_count = last_count - 255;

    std::array<uint16_t, 8> starts{};
};

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
        sum = _mm_or_si128(_mm_and_si128(sum, vector(inner)), vector(end));
        _mm_store_si128(reinterpret_cast<__m128i*>(mean_.starts.data()), sum);
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
    // What is neither counter nor check, one in place of the counter, the end of the last symbol.
    static constexpr WordRow inner{{0, 0xffff, 0xffff, 0xffff, 0xffff}}, one{{1}}, end{{0, 0, 0, 0, 0, total}};

#ifdef __SSE2__
    static __m128i vector(const WordRow& row) { return _mm_load_si128(reinterpret_cast<const __m128i*>(row.starts.data())); }
#endif

    static void learn(WordRow& row, uint32_t symbol) {
        const int rate = rates[static_cast<size_t>(row.starts[WordRow::counter] - WordRow::first_count)];
#ifdef __SSE2__
        const __m128i old = vector(row), change = _mm_sra_epi16(_mm_sub_epi16(vector(targets[symbol]), old), _mm_cvtsi32_si128(rate));
        // The counter saturates where it ends.
        const __m128i moved = _mm_adds_epi16(_mm_add_epi16(old, _mm_and_si128(change, vector(inner))), vector(one));
        _mm_store_si128(reinterpret_cast<__m128i*>(row.starts.data()), moved);
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

// The first context is that of DirectRows, from which rows of the others start.
class MixedRows {
public:
    // The symbols so far, and the degree of the gate's left end.
    struct History {
        WordHistory symbols;
        uint8_t degree = 0;
    };
    static constexpr bool has_excesses = true;

    explicit MixedRows(Index word_size)
        : n_bits_(std::clamp<int>(std::bit_width(static_cast<uint32_t>(word_size)) - 2, 8, 13)), others_(n_others << n_bits_) {
        const DirectRows& prior = DirectRows::initial();
        for (uint32_t c = 0; c < first_.size(); ++c) {
            for (uint32_t i = 1; i < n_symbols; ++i) first_[c].starts[i] = prior.at(c).start(i);
            first_[c].starts[WordRow::counter] = WordRow::first_count + 4;
        }
    }

    WordMix& next(const Reverse& reverse, const History& past) {
        const LoopEdge& gate = reverse.edge(reverse.gate());
        const uint32_t l0 = past.degree, l1 = reverse.edge(gate.previous).degree, r0 = reverse.edge(gate.next).degree;
        const WordHistory& symbols = past.symbols;
        const std::array<uint32_t, n_others> hashes = {context_hash(0, symbols.latest(6), pack(l0, r0)),
                                                       context_hash(1, symbols.latest(10), pack(symbols.closed_degrees(4), l0)),
                                                       context_hash(2, pack(l0, l1, gate.excess, r0), symbols.closed_degrees(2))};
        std::array<WordRow*, WordMix::n_rows> rows;
        rows[0] = &first_[DirectRows::context(l0, symbols.latest(2))];
        size_t known = 0;
        for (size_t i = 0; i < n_others; ++i) {
            rows[i + 1] = &others_[i << n_bits_ | hashes[i] >> (32 - n_bits_)];
            known |= size_t{find(*rows[i + 1], static_cast<uint16_t>(hashes[i] | 1), *rows[0])} << i;
        }
        mix_.mix(rows, weights_[known]);
        return mix_;
    }

    static History after(History past, Symbol symbol, uint8_t degree) {
        past.symbols.advance(symbol, past.degree);
        past.degree = degree;
        return past;
    }

private:
    static constexpr size_t n_others = WordMix::n_rows - 1;

    // False if the context was not known.
    static bool find(WordRow& row, uint16_t check, const WordRow& first) {
        if (row.starts[WordRow::check] == check) return true;
        row = first;
        row.starts[WordRow::counter] = WordRow::first_count;
        row.starts[WordRow::check] = check;
        return false;
    }

    int n_bits_;
    std::array<WordRow, (max_degree + 1) * 64> first_;
    std::vector<WordRow> others_;
    std::array<WordMix::Weights, 1 << n_others> weights_;  // by which contexts were known
    WordMix mix_;
};

}  // namespace ebz
