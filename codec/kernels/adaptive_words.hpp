// Adaptive models of the reverse word: mixed contexts of what both sides know.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "context_mixing.hpp"
#include "match_model.hpp"
#include "word_priors.hpp"
#include "word_view.hpp"

namespace ebz {

// One hash of a context's number and up to 96 bits.
constexpr uint32_t context_hash(uint32_t context, uint32_t a, uint32_t b = 0, uint32_t c = 0) {
    uint64_t h = (uint64_t{context} << 32 | a) * 0x9E3779B97F4A7C15u + b * 0xC2B2AE3D27D4EB4Fu + c * 0xFF51AFD7ED558CCDu;
    h = (h ^ h >> 29) * 0xBF58476D1CE4E5B9u;
    return static_cast<uint32_t>(h >> 32);
}

// Bits side by side, four each but for the first.
template <class... Nibble>
constexpr uint32_t pack(uint32_t first, Nibble... nibbles) {
    ((first = first << 4 | nibbles), ...);
    return first;
}

// An entry of DegreePrior as an estimate; 0 is no knowledge.
inline Estimate starting_estimate(int prior) {
    Estimate estimate;
    estimate.probability = static_cast<uint32_t>(squash(prior * 16)) << 6;
    estimate.count = prior == 0 ? 0 : 2;
    return estimate;
}

struct StrongContexts {
    static constexpr const auto& prior = strong_prior;
    static constexpr int n = 16, of_lengths = 11;
    static constexpr int n_table_bits = 18;
    static constexpr bool thorough = true;

    static void hash(const WordView& v, const WordHistory& past, const MatchModel& near, const MatchModel& far,
                     std::array<uint32_t, n>& h) {
        const uint64_t past16 = past.recent(16);
        int i = 0;
        const auto add = [&](uint32_t a, uint32_t b = 0, uint32_t c = 0) { h[i] = context_hash(i, a, b, c), ++i; };
        add(v.l0, past.latest(2));
        add(past.latest(3), pack(past.since_close(), v.l0));
        add(past.latest(4), pack(v.l0, v.l1));
        add(past.latest(10), v.l0);
        add(static_cast<uint32_t>(past16), static_cast<uint32_t>(past16 >> 32), v.l0);
        add(pack(v.l0, v.l1, v.l2, v.r0), v.can_close);
        add(pack(v.l0, v.l1, v.l2, v.l3, v.r0), past.closed_degrees(1));
        add(pack(v.l0, v.l1, v.l2, v.r0, v.r1, v.r2), past.latest(3));
        add(pack(v.l0, v.r0, v.excess_l0), v.can_close);
        add(pack(v.l0, v.l1, v.excess_l0, v.excess_l1), v.excess_r0);
        add(v.l0, past.closed_degrees(3), past.since_close());
        add(pack(std::min(v.length, 9u), std::min(v.conflict, 9u)), v.l0);
        add(pack(far.predicted(), far.confidence(), v.l0));
        add(pack(near.predicted(), near.confidence(), v.l0));
        add(pack(v.l0, v.l1, v.excess_l0, v.r0), past.closed_degrees(2));
        add(past.latest(10), past.closed_degrees(6));
    }
};

struct FastContexts {
    static constexpr const auto& prior = fast_prior;
    static constexpr int n = 6, of_lengths = -1;
    static constexpr int n_table_bits = 14;
    static constexpr bool thorough = false;

    static void hash(const WordView& v, const WordHistory& past, const MatchModel&, const MatchModel& far,
                     std::array<uint32_t, n>& h) {
        int i = 0;
        const auto add = [&](uint32_t a, uint32_t b = 0, uint32_t c = 0) { h[i] = context_hash(i, a, b, c), ++i; };
        add(v.l0, past.latest(2));
        add(pack(v.l0, v.l1, v.r0, v.r1), v.can_close);
        add(past.latest(6), pack(v.l0, v.r0));
        add(past.latest(10), v.l0);
        add(pack(v.l0, v.l1, v.excess_l0, v.r0), past.closed_degrees(2));
        add(pack(far.predicted(), far.confidence(), v.l0));
    }
};

// Decisions in turn: C or not, R or not, L or not, S or E.
template <class Contexts>
class MixedModel {
public:
    explicit MixedModel(Index n_symbols)
        : far_(20, n_symbols),
          near_(12, n_symbols),
          tables_(n, EvidenceTable(std::clamp<int>(std::bit_width(static_cast<uint32_t>(n_symbols)) - 2, 10,
                                                   Contexts::n_table_bits))),
          by_known_(n_decisions * (n + 1)),
          by_symbols_(n_decisions * 128),
          by_match_(n_decisions * 512),
          by_degrees_(n_decisions * 256),
          by_length_(n_decisions * 256) {
        start_weights();
        start_estimates();
    }

    template <class Coder>
    Symbol code(Coder& coder, Symbol symbol, const WordView& view) {
        Contexts::hash(view, history_, near_, far_, hashes_);
        find(0, 0);
        if (view.can_close && decide(coder, 0, symbol == C, view)) return C;
        if (decide(coder, 1, symbol == R, view)) return R;
        if (decide(coder, 2, symbol == L, view)) return L;
        if (!view.can_split) return E;
        find(3, view.below_length);
        return decide(coder, 3, symbol == S, view) ? S : E;
    }

    void advance(std::span<const uint8_t> symbols, Index position, uint32_t left_degree) {
        history_.advance(static_cast<Symbol>(symbols[position]), left_degree);
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
            for (size_t k = 0; k < 128; ++k) by_symbols_.start(d * 128 + k, prior.weights[d]);
            for (size_t k = 0; k < 512; ++k) by_match_.start(d * 512 + k, prior.weights[d]);
        }
    }

    // The first context is that of DegreePrior.
    void start_estimates() {
        for (int d = 0; d < n_decisions; ++d) {
            for (uint32_t degree = 0; degree < 16; ++degree) {
                for (uint32_t latest = 0; latest < 64; ++latest) {
                    const int prior = degree_prior[d][degree][latest];
                    if (prior == 0) continue;
                    Evidence& evidence = tables_[0].find(context_hash(0, degree, latest) + salt(d, 0));
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
        for (int i = 0; i < n; ++i) {
            const uint32_t added = salt(decision, i == Contexts::of_lengths ? below_length : 0);
            evidence_[i] = &tables_[i].find(hashes_[i] + added);
        }
    }

    template <class Coder>
    bool decide(Coder& coder, int decision, bool bit, const WordView& view) {
        int n_known = 0;
        for (int i = 0; i < n; ++i) {
            const Estimate& e = evidence_[i]->estimates[slot(decision)];
            n_known += e.count > 0;
            inputs_[i] = static_cast<int16_t>(stretch(e.p12()) * confidence[e.count] >> 8);
        }
        by_known_.select(decision * (n + 1) + n_known);
        by_symbols_.select(decision * 128 + (view.l0 << 3 | history_.latest(1)));
        int mixed = by_known_.mix(inputs_) + by_symbols_.mix(inputs_);
        if constexpr (thorough) {
            by_match_.select(decision * 512 + (far_.confidence() << 6 | near_.confidence() << 3 | std::min(history_.since_close(), 7u)));
            mixed = (mixed + by_match_.mix(inputs_)) / 3;
        } else {
            mixed /= 2;
        }
        const int p = squash(mixed);
        int refined = p;
        if constexpr (thorough) {
            const int by_degrees = by_degrees_.refine(decision * 256 + pack(view.l0, view.l1), mixed);
            const int by_length = by_length_.refine(decision * 256 + pack(std::min(view.length, 15u), view.conflict), mixed);
            refined = (2 * p + by_degrees + by_length) / 4;
        }
        bit = coder.bit(bit, bounded(refined));
        by_known_.learn(inputs_, bit);
        by_symbols_.learn(inputs_, bit);
        if constexpr (thorough) {
            by_match_.learn(inputs_, bit);
            by_degrees_.learn(bit);
            by_length_.learn(bit);
        }
        for (int i = 0; i < n; ++i) learn(evidence_[i]->estimates[slot(decision)], bit, p);
        return bit;
    }

    // A new context starts from what was predicted without it.
    static void learn(Estimate& estimate, bool bit, int predicted) {
        if (estimate.count == 0) estimate.probability = static_cast<uint32_t>(std::clamp(predicted, 1311, 64225)) << 6;
        estimate.learn(bit);
    }

    // In 2^-8; 0 for a context that is new.
    static constexpr auto confidence = [] {
        std::array<int, Estimate::max_count + 1> table{};
        for (int n = 1; n <= static_cast<int>(Estimate::max_count); ++n) table[n] = 256 * (2 * n + 9) / (2 * n + 14);
        return table;
    }();

    WordHistory history_;
    MatchModel far_, near_;
    std::vector<EvidenceTable> tables_;
    Mixer<n> by_known_, by_symbols_, by_match_;
    Refinement by_degrees_, by_length_;
    std::array<uint32_t, n> hashes_{};
    std::array<Evidence*, n> evidence_{};
    typename Mixer<n>::Inputs inputs_{};
};

// The fastest: two contexts, the mean of their probabilities.
class DirectModel {
public:
    explicit DirectModel(Index) {
        for (size_t d = 0; d < n_decisions; ++d) {
            for (size_t i = 0; i < n_contexts; ++i) {
                // Both contexts begin with degree and latest two symbols, 3 more bits follow.
                const Estimate start = starting_estimate(degree_prior[d][i >> 9][i >> 3 & 63]);
                by_right_end_[d][i] = start;
                by_symbols_[d][(i & ~size_t{511}) | (i >> 3 & 63) | (i & 7) << 6] = start;
            }
        }
    }

    template <class Coder>
    Symbol code(Coder& coder, Symbol symbol, const WordView& view) {
        at_symbols_ = view.l0 << 9 | recent_;
        at_right_end_ = view.l0 << 9 | (recent_ & 63) << 3 | (std::min(view.r0, 9u) - 2);
        if (view.can_close && decide(coder, 0, symbol == C)) return C;
        if (decide(coder, 1, symbol == R)) return R;
        if (decide(coder, 2, symbol == L)) return L;
        if (!view.can_split) return E;
        return decide(coder, 3, symbol == S) ? S : E;
    }

    void advance(std::span<const uint8_t> symbols, Index position, uint32_t) {
        recent_ = (recent_ << 3 | (symbols[position] + 1u)) & 511;
    }

private:
    static constexpr size_t n_contexts = 1 << 13;
    using Estimates = std::vector<Estimate>;

    template <class Coder>
    bool decide(Coder& coder, size_t decision, bool bit) {
        Estimate& a = by_symbols_[decision][at_symbols_];
        Estimate& b = by_right_end_[decision][at_right_end_];
        bit = coder.bit(bit, bounded(squash((stretch(a.p12()) + stretch(b.p12())) * 9 / 16)));
        a.learn(bit);
        b.learn(bit);
        return bit;
    }

    std::array<Estimates, n_decisions> by_symbols_ = all(), by_right_end_ = all();
    uint32_t recent_ = 0, at_symbols_ = 0, at_right_end_ = 0;

    static std::array<Estimates, n_decisions> all() {
        std::array<Estimates, n_decisions> tables;
        tables.fill(Estimates(n_contexts));
        return tables;
    }
};

}  // namespace ebz
