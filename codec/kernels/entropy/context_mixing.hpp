// Binary decisions predicted by many contexts, mixed in the logistic domain.
//
// Reference: M. Mahoney, "Adaptive weighing of context models for lossless data compression", 2005.
// Different here: mixers learn fast at first, and one knows how many contexts were met before.  Integers
// only, so that both sides agree on every machine, in loops that compilers turn into vectors.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "logistic.hpp"
#include "range_coder.hpp"

namespace ebz {

// Probabilities of a decision stay this far from 0 and 1, in 2^-16: it costs more than 2^-12 bits, which
// bounds what a count may be.
inline constexpr int least_share = 12;

inline uint32_t bounded(int p) {
    return static_cast<uint32_t>(std::clamp(p, least_share, (1 << probability_bits) - least_share));
}

// A probability in 2^-22 and how often it was met, in one word.
class Estimate {
public:
    static constexpr uint32_t max_count = 255;

    constexpr Estimate() = default;
    Estimate(uint32_t probability, uint32_t count) : word_(probability << count_bits | count) {}

    uint32_t probability() const { return word_ >> count_bits; }
    uint32_t count() const { return word_ & ((1u << count_bits) - 1); }
    int p12() const { return static_cast<int>(word_ >> 20); }
    int p16() const { return static_cast<int>(word_ >> 16); }

    // As it is, where all bits are set; new where none is.
    void keep(uint32_t bits) { word_ = (word_ & bits) | (fresh & ~bits); }

    template <class Coder>
    bool code(Coder& coder, bool bit) {
        bit = coder.bit(bit, bounded(p16()));
        learn(bit);
        return bit;
    }

    // Modulo 2^32, within which every sum stays.
    void learn(bool bit) {
        const int32_t distance = (bit << 22) - bit - static_cast<int32_t>(probability());
        const uint32_t change = static_cast<uint32_t>(distance >> 3) * rates[count()];
        word_ += (change & ~((1u << count_bits) - 1)) + (count() < max_count);
    }

private:
    static constexpr int count_bits = 10;

    // 2^13 / (count + 1.2), between the mean (+ 1) and the last value (+ 0).
    static constexpr auto rates = [] {
        std::array<uint32_t, max_count + 1> table{};
        for (uint32_t n = 0; n <= max_count; ++n) table[n] = 81920 / (10 * n + 12);
        return table;
    }();

    static constexpr uint32_t fresh = 1u << 31;

    uint32_t word_ = fresh;
};

// An entry of DegreePrior as an estimate; 0 is no knowledge.
inline Estimate starting_estimate(int prior) {
    return Estimate(static_cast<uint32_t>(squash(prior * 16)) << 6, prior == 0 ? 0 : 2);
}

// The estimates of up to three decisions in one context.
struct Evidence {
    static constexpr int n_decisions = 3;
    uint32_t check = 0;
    std::array<Estimate, n_decisions> estimates;

    // Whether the context was met before; if not, it starts anew.  Without a branch, which nobody could foresee.
    bool meet(uint32_t hash) {
        const bool known = check == hash;
        const uint32_t kept = known ? ~uint32_t{0} : 0;
        for (Estimate& estimate : estimates) estimate.keep(kept);
        check = hash;
        return known;
    }
};

// The evidence of several contexts, a table each, by hash; what collides starts anew.
class EvidenceTables {
public:
    EvidenceTables(int n_tables, int n_bits) : n_bits_(n_bits), slots_(size_t{1} * n_tables << n_bits) {}

    // Asked for ahead of what is done with it.
    Evidence& at(int table, uint32_t hash) {
        Evidence& slot = slots_[static_cast<size_t>(table) << n_bits_ | hash >> (32 - n_bits_)];
        __builtin_prefetch(&slot, 1);
        return slot;
    }

private:
    int n_bits_;
    std::vector<Evidence> slots_;
};

// Sets of weights of n inputs, one of which is selected for each decision.
template <int n>
class Mixer {
public:
    // Whole vectors; those past n stay 0.
    static constexpr int width = (n + 7) / 8 * 8;
    struct alignas(16) Vector : std::array<int16_t, width> {};

    class Set {
    public:
        int mix(const Vector& inputs) const {
            int32_t sum = 0;
            for (int i = 0; i < width; ++i) sum += weights_[i] * inputs[i];
            return std::clamp(sum >> weight_bits, -stretch_limit, stretch_limit);
        }

        // Gradient descent on the code length of what was mixed.
        void learn(const Vector& inputs, int mixed, bool bit) {
            const int error = (bit << probability_bits) - squash(mixed);
            // Errors have 17 bits with their sign, rates 11, steps 16.
            const int16_t step = static_cast<int16_t>((error * rates[std::min(n_uses_, max_count)]) >> 12);
            ++n_uses_;
            for (int i = 0; i < width; ++i) {
                // Inputs have 13 bits with their sign: products below 2^31, changes below 3711.
                const int16_t input = static_cast<int16_t>(inputs[i] * 8);
                const int16_t change = static_cast<int16_t>((input * step) >> 16);
                const int16_t weight = static_cast<int16_t>(weights_[i] + ((change + 1) >> 1));
                weights_[i] = std::clamp<int16_t>(weight, -max_weight, max_weight);
            }
        }

    private:
        friend class Mixer;
        friend struct Training;
        Vector weights_{};
        int n_uses_ = 0;  // fewer than symbols
    };

    explicit Mixer(size_t n_sets) : sets_(n_sets) {}

    // Weights in 2^-10 to start from.
    void start(size_t set, const std::array<int16_t, n>& weights) {
        for (int i = 0; i < n; ++i) {
            sets_[set].weights_[i] = static_cast<int16_t>(weights[i] * (1 << (weight_bits - 10)));
        }
    }

    Set& at(size_t set) { return sets_[set]; }

private:
    friend struct Training;

    static constexpr int weight_bits = 14;
    static constexpr int16_t max_weight = 28000;
    static_assert(int64_t{n} * max_weight * stretch_limit < INT32_MAX);
    static constexpr int max_count = 255;
    // In 2^-16: 0.025 at first, less than a third of that after 255 uses.
    static constexpr auto rates = [] {
        std::array<int, max_count + 1> table{};
        for (int uses = 0; uses <= max_count; ++uses) table[uses] = 150 + 1500 * 32 / (32 + uses);
        return table;
    }();

    std::vector<Set> sets_;
};

// Secondary estimation: what a prediction was worth in a context.
class Refinement {
public:
    explicit Refinement(size_t n_contexts) : curves_(n_contexts) {
        for (Curve& curve : curves_) {
            for (int i = 0; i <= n_steps; ++i) {
                curve[i] = static_cast<uint16_t>(squash((i - n_steps / 2) * step));
            }
        }
    }

    int refine(size_t context, int stretched) {
        const int at = stretched + n_steps / 2 * step;
        low_ = &curves_[context][at / step];
        const int part = at % step;
        nearer_ = low_ + (2 * part >= step);
        return (low_[0] * (step - part) + low_[1] * part) / step;
    }

    void learn(bool bit) {
        *nearer_ = static_cast<uint16_t>(*nearer_ + (((bit ? 65535 : 0) - *nearer_) >> 6));
    }

private:
    static constexpr int step = 144, n_steps = 32;
    static_assert(n_steps / 2 * step > stretch_limit);
    using Curve = std::array<uint16_t, n_steps + 1>;

    std::vector<Curve> curves_;
    uint16_t* low_ = nullptr;
    uint16_t* nearer_ = nullptr;
};

}  // namespace ebz
