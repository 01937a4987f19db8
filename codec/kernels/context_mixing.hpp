// Binary decisions predicted by many contexts, mixed in the logistic domain.
//
// Reference: M. Mahoney, "Adaptive weighing of context models for lossless data compression", 2005.
// Different here: a context met for the first time starts from what the others predicted, and mixers
// learn fast at first.  Integers only, so that both sides agree on every machine.
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

// A probability in 2^-22 and how often it was met.
struct Estimate {
    static constexpr uint32_t max_count = 255;

    uint32_t probability : 22 = 1u << 21;
    uint32_t count : 10 = 0;

    int p12() const { return static_cast<int>(probability >> 10); }
    int p16() const { return static_cast<int>(probability >> 6); }

    template <class Coder>
    bool code(Coder& coder, bool bit) {
        bit = coder.bit(bit, bounded(p16()));
        learn(bit);
        return bit;
    }

    void learn(bool bit) {
        const int64_t target = bit ? (1 << 22) - 1 : 0;
        const int64_t change = (target - probability) * rates[count];
        probability = static_cast<uint32_t>(probability + (change >> 16));
        count += count < max_count;
    }

    // 2^16 / (count + 1.2), between the mean (+ 1) and the last value (+ 0).
    static constexpr auto rates = [] {
        std::array<int64_t, max_count + 1> table{};
        for (int n = 0; n <= static_cast<int>(max_count); ++n) table[n] = 655360 / (10 * n + 12);
        return table;
    }();
};

// An entry of DegreePrior as an estimate; 0 is no knowledge.
inline Estimate starting_estimate(int prior) {
    Estimate estimate;
    estimate.probability = static_cast<uint32_t>(squash(prior * 16)) << 6;
    estimate.count = prior == 0 ? 0 : 2;
    return estimate;
}

// The estimates of up to three decisions in one context.
struct Evidence {
    static constexpr int n_decisions = 3;
    uint32_t check = 0;
    std::array<Estimate, n_decisions> estimates;
};

// One context's evidence by hash; what collides starts anew.
class EvidenceTable {
public:
    explicit EvidenceTable(int n_bits) : shift_(32 - n_bits), slots_(size_t{1} << n_bits) {}

    Evidence& find(uint32_t hash) {
        Evidence& slot = slots_[hash >> shift_];
        if (slot.check != hash) {
            slot = {};
            slot.check = hash;
        }
        return slot;
    }

private:
    int shift_;
    std::vector<Evidence> slots_;
};

// Weighs n inputs in sets, one of which is selected for each decision.
template <int n>
class Mixer {
public:
    // Whole vectors; those past n stay 0.
    static constexpr int width = (n + 7) / 8 * 8;
    struct alignas(16) Inputs : std::array<int16_t, width> {};

    explicit Mixer(size_t n_sets) : sets_(n_sets) {}

    // Weights in 2^-10 to start from.
    void start(size_t set, const std::array<int16_t, n>& weights) {
        for (int i = 0; i < n; ++i) {
            sets_[set].weights[i] = weights[i] * (1 << (weight_bits - 10));
            sets_[set].rounded[i] = static_cast<int16_t>(sets_[set].weights[i] >> rounding_bits);
        }
    }

    void select(size_t set) { selected_ = &sets_[set]; }

    int mix(const Inputs& inputs) {
        int32_t sum = 0;
        for (int i = 0; i < width; ++i) sum += selected_->rounded[i] * inputs[i];
        mixed_ = std::clamp(sum >> (weight_bits - rounding_bits), -stretch_limit, stretch_limit);
        return mixed_;
    }

    // Gradient descent on the code length.
    void learn(const Inputs& inputs, bool bit) {
        const int error = (bit << probability_bits) - squash(mixed_);
        Set& set = *selected_;
        // Errors have 17 bits with their sign, rates 11, steps 16.
        const int16_t step = static_cast<int16_t>((error * rates[std::min(set.n_uses, max_count)]) >> 12);
        ++set.n_uses;
        for (int i = 0; i < width; ++i) {
            const int32_t weight = set.weights[i] + ((inputs[i] * step + (1 << 11)) >> 12);
            set.weights[i] = std::clamp(weight, -max_weight, max_weight);
            set.rounded[i] = static_cast<int16_t>(set.weights[i] >> rounding_bits);
        }
    }

private:
    friend struct Training;

    static constexpr int weight_bits = 16, rounding_bits = 4;
    // Below 8, so that rounded weights fit 16 bits and n products with inputs fit 31.
    static constexpr int32_t max_weight = (8 << weight_bits) - 1;
    static_assert(int64_t{n} * (max_weight >> rounding_bits) * stretch_limit < INT32_MAX);
    static constexpr int max_count = 255;
    // In 2^-16: 0.025 at first, less than a third of that after 255 uses.
    static constexpr auto rates = [] {
        std::array<int, max_count + 1> table{};
        for (int uses = 0; uses <= max_count; ++uses) table[uses] = 150 + 1500 * 32 / (32 + uses);
        return table;
    }();

    struct Set {
        alignas(16) std::array<int32_t, width> weights{};  // what learns
        alignas(16) std::array<int16_t, width> rounded{};  // what mixes
        int n_uses = 0;                                     // fewer than symbols
    };

    std::vector<Set> sets_;
    Set* selected_ = nullptr;
    int mixed_ = 0;
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
