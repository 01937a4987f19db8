// Logistic mixing with two weight sets whose sum applies.
//
// Reference: M. Mahoney, "Adaptive weighing of context models for lossless data compression", 2005.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "float_logistic.hpp"
#include "lanes.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <size_t n_lanes>
class Mixer {
public:
    // Aligned for every instruction set: without AVX, GCC takes less for wide vectors.
    struct alignas(32) Inputs {
        std::array<WideLanes, n_lanes> lanes;
        WideLanes& operator[](size_t i) { return lanes[i]; }
        const WideLanes& operator[](size_t i) const { return lanes[i]; }
    };

    Mixer(size_t n_sets_a, size_t n_sets_b) : a_(n_sets_a, Inputs{}), b_(n_sets_b, Inputs{}) {}

    void start(size_t set_a, const std::array<float, 8 * n_lanes>& weights) {
        for (size_t i = 0; i < weights.size(); ++i) a_[set_a][i / 8][i % 8] = weights[i];
    }

    // The logit of the bit being 1.
    float mix(const Inputs& x, size_t set_a, size_t set_b) {
        active_a_ = &a_[set_a];
        active_b_ = &b_[set_b];
        WideLanes total{};
        for (size_t i = 0; i < n_lanes; ++i) total += ((*active_a_)[i] + (*active_b_)[i]) * x[i];
        return clamp(sum(total), -16.0f, 16.0f);
    }

    void update(const Inputs& x, float change) {
        Inputs &a = *active_a_, &b = *active_b_;
        for (size_t i = 0; i < n_lanes; ++i) {
            const WideLanes step = change * x[i];
            a[i] += step;
            b[i] += step;
        }
    }

private:
    std::vector<Inputs> a_, b_;
    Inputs *active_a_ = nullptr, *active_b_ = nullptr;
};

// Of a bit being 1, and its share of 2^16, as coders take it.
struct Probability {
    float p;
    uint32_t p16;
};

// Of logits within 2^-6: nearer ones would gain less than 2^-15 bits.
inline constexpr auto probabilities = [] {
    std::array<Probability, 1025> table{};
    for (size_t i = 0; i < table.size(); ++i) {
        const float p = squash((static_cast<float>(i) - 512.0f) * (1.0f / 32.0f));
        table[i] = {p, static_cast<uint32_t>(std::clamp(static_cast<int32_t>(p * 65536.0f), 1, 65535))};
    }
    return table;
}();

// Logits are within 16.
inline Probability probability(float logit) {
    return probabilities[static_cast<size_t>(static_cast<int32_t>(logit * 32.0f + 512.5f))];
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
