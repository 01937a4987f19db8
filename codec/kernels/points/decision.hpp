// A bit whose log-odds are a sum of learnt weights and of what places met before say, as far as such
// places have been worth it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "../entropy/context_mixing.hpp"
#include "../order/log_odds.hpp"

namespace ebz::points {

// How far to trust an estimate, in 2^-16.
struct Gain {
    static constexpr int32_t limit = 2 << probability_bits;

    // |x| < 2^12 and |error| < 2^16, so products fit 31 bits.
    void learn(int x, int error) {
        value = std::clamp(value + ((x * ((error * rate) >> 12) + 2048) >> 12), -limit, limit);
    }

    static constexpr int32_t rate = 200;

    int32_t value = 1 << (probability_bits - 2);
};

class Decision {
public:
    static constexpr int max_features = 8, max_estimates = 4, n_trust = 6;
    using Gains = std::array<Gain, n_trust>;  // by how often the place was met

    void add(order::Weight& feature) { features_[n_features_++] = &feature; }

    void add(Estimate& estimate, Gains& gains) {
        const uint32_t n = estimate.count();
        const uint32_t trust = n < 4 ? n : n < 16 ? 4 : 5;
        estimates_[n_estimates_++] = {&estimate, &gains[trust], n == 0 ? 0 : stretch(estimate.p12())};
    }

    template <class Coder>
    bool code(Coder& coder, bool bit) {
        int sum = 0;
        for (int i = 0; i < n_features_; ++i) sum += features_[i]->value;
        sum >>= order::Weight::fraction_bits;
        for (int i = 0; i < n_estimates_; ++i) sum += (estimates_[i].x * estimates_[i].gain->value) >> probability_bits;
        const int p = squash(sum);
        bit = coder.bit(bit, static_cast<uint32_t>(p));
        const int error = (bit << probability_bits) - p;
        for (int i = 0; i < n_features_; ++i) features_[i]->learn(error);
        for (int i = 0; i < n_estimates_; ++i) {
            estimates_[i].gain->learn(estimates_[i].x, error);
            estimates_[i].estimate->learn(bit);
        }
        return bit;
    }

private:
    struct Input {
        Estimate* estimate;
        Gain* gain;
        int x;
    };

    int n_features_ = 0, n_estimates_ = 0;
    std::array<order::Weight*, max_features> features_;
    std::array<Input, max_estimates> estimates_;
};

}  // namespace ebz::points
