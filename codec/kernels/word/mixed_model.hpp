// An adaptive model of the reverse word: mixed contexts of what both sides know.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "../entropy/context_mixing.hpp"
#include "word_contexts.hpp"

namespace ebz {

// Decisions in turn: C or not, R or not, L or not, S or E.
template <class Contexts>
class MixedModel {
public:
    explicit MixedModel(Index n_symbols)
        : far_(20, n_symbols),
          near_(12, n_symbols),
          tables_(n, std::clamp<int>(std::bit_width(static_cast<uint32_t>(n_symbols)) - 2, 10, Contexts::n_table_bits)),
          by_known_(n_decisions * (n + 1)),
          by_symbols_(thorough ? n_decisions * 128 : 0),
          by_match_(thorough ? n_decisions * 512 : 0),
          by_degrees_(thorough ? n_decisions * 256 : 0),
          by_loop_(thorough ? n_decisions * 256 : 0) {
        start_weights();
        start_estimates();
    }

    template <class Coder>
    Symbol code(Coder& coder, Symbol symbol, const WordView& view) {
        Contexts::hash(view, history_, near_, far_, hashes_);
        if (view.in_polygon) for (uint32_t& hash : hashes_) hash += 0x85EBCA6Bu;
        find(0, 0);
        if (view.can_close && decide(coder, 0, symbol == C, view)) return C;
        if (view.in_polygon) return view.can_split && !decide(coder, 2, symbol == L, view) ? S : L;
        if (decide(coder, 1, symbol == R, view)) return R;
        if (decide(coder, 2, symbol == L, view)) return L;
        if (!view.can_split) return E;
        find(3, view.below_length);
        return decide(coder, 3, symbol == S, view) ? S : E;
    }

    void advance(std::span<const uint8_t> symbols, Index position, uint32_t left_degree,
                 bool in_polygon = false) {
        history_.advance(static_cast<Symbol>(symbols[position]), left_degree, in_polygon);
        far_.advance(symbols, position, history_.recent());
        if constexpr (thorough) near_.advance(symbols, position, history_.recent());
    }

private:
    friend struct Training;

    static constexpr int n = Contexts::n;
    static constexpr bool thorough = Contexts::thorough;

    void start_weights() {
        const MixingPrior<n>& prior = Contexts::prior;
        for (size_t d = 0; d < n_decisions; ++d) {
            for (size_t k = 0; k <= n; ++k) by_known_.start(d * (n + 1) + k, prior.by_known[d][k]);
            for (size_t k = 0; thorough && k < 128; ++k) by_symbols_.start(d * 128 + k, prior.weights[d]);
            for (size_t k = 0; thorough && k < 512; ++k) by_match_.start(d * 512 + k, prior.weights[d]);
        }
    }

    // The first context is that of DegreePrior.
    void start_estimates() {
        for (int d = 0; d < n_decisions; ++d) {
            for (uint32_t degree = 0; degree < 16; ++degree) {
                for (uint32_t latest = 0; latest < 64; ++latest) {
                    const int prior = degree_prior[d][degree][latest];
                    if (prior == 0) continue;
                    const uint32_t hash = context_hash(0, degree, latest) + salt(d, 0);
                    Evidence& evidence = tables_.at(0, hash);
                    evidence.meet(hash);
                    evidence.estimates[slot(d)] = starting_estimate(prior);
                }
            }
        }
    }

    // S or E has evidence of its own; that of a context may also know the loop below.
    static constexpr int slot(int decision) { return decision % Evidence::n_decisions; }
    static constexpr uint32_t salt(int decision, uint32_t below_length) {
        return decision < Evidence::n_decisions ? 0 : 0x632BE5ABu * (1 + below_length);
    }

    void find(int decision, uint32_t below_length) {
        std::array<uint32_t, n> hashes;
        for (int i = 0; i < n; ++i) {
            hashes[i] = hashes_[i] + salt(decision, i == Contexts::of_lengths ? below_length : 0);
            evidence_[i] = &tables_.at(i, hashes[i]);
        }
        n_known_ = 0;
        for (int i = 0; i < n; ++i) n_known_ += evidence_[i]->meet(hashes[i]);
    }

    template <class Coder>
    bool decide(Coder& coder, int decision, bool bit, const WordView& view) {
        typename Mixer<n>::Vector inputs{};
        for (int i = 0; i < n; ++i) {
            inputs[i] = static_cast<int16_t>(stretch(evidence_[i]->estimates[slot(decision)].p12()));
        }
        auto& by_known = by_known_.at(decision * (n + 1) + n_known_);
        const int mixed = by_known.mix(inputs);
        if constexpr (thorough) {
            bit = decide_thoroughly(coder, decision, bit, view, inputs, mixed);
        } else {
            bit = coder.bit(bit, bounded(squash(mixed)));
        }
        by_known.learn(inputs, mixed, bit);
        for (int i = 0; i < n; ++i) evidence_[i]->estimates[slot(decision)].learn(bit);
        return bit;
    }

    // by_known: what the mixer says that selects by what is known.
    template <class Coder>
    bool decide_thoroughly(Coder& coder, int decision, bool bit, const WordView& view,
                           const typename Mixer<n>::Vector& inputs, int by_known) {
        const uint32_t matches = far_.confidence() << 3 | near_.confidence();
        auto& by_symbols = by_symbols_.at(decision * 128 + (view.l0 << 3 | history_.latest(1)));
        auto& by_match = by_match_.at(decision * 512 + (matches << 3 | std::min(history_.since_close(), 7u)));
        const int b = by_symbols.mix(inputs), c = by_match.mix(inputs), mixed = (by_known + b + c) / 3;
        const uint32_t degrees = pack(view.l0, view.l1);
        const uint32_t loop = pack(std::min(view.length, 15u), view.conflict);
        const int refined = (2 * squash(mixed) + by_degrees_.refine(decision * 256 + degrees, mixed) +
                             by_loop_.refine(decision * 256 + loop, mixed)) / 4;
        bit = coder.bit(bit, bounded(refined));
        by_symbols.learn(inputs, b, bit);
        by_match.learn(inputs, c, bit);
        by_degrees_.learn(bit);
        by_loop_.learn(bit);
        return bit;
    }

    WordHistory history_;
    MatchModel far_, near_;
    EvidenceTables tables_;
    Mixer<n> by_known_, by_symbols_, by_match_;
    Refinement by_degrees_, by_loop_;
    std::array<uint32_t, n> hashes_{};
    std::array<Evidence*, n> evidence_{};
    int n_known_ = 0;
};

}  // namespace ebz
