// Weights of four distributions that are mixed; they go to those that told the symbols best.
//
// Each step is one of expectation maximisation for a mixture: a weight moves towards the share that its
// distribution had in the probability of the symbol.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lanes.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// least: a weight that nothing earns ends at least / (rate + 4 least), about.
struct MixingRates {
    float rate, least;
};

template <MixingRates rates>
class MixingWeights {
public:
    static constexpr size_t n = 4;
    using Shares = std::array<uint16_t, n>;

    MixingWeights() : weights_(splat<Lanes>(1.0f / n)) { set_shares(); }

    // The weights in 2^-16; they add up to less than 1.
    const Shares& shares() const { return shares_; }

    // frequencies: of the symbol.
    void learn(IntLanes frequencies) {
        constexpr float kept = 1.0f - (rates.rate + n * rates.least);
        const Lanes earned = weights_ * __builtin_convertvector(frequencies, Lanes);
        weights_ = weights_ * kept + earned * (rates.rate / sum(earned)) + rates.least;
        set_shares();
    }

private:
    // The sum of weights is within 2^-15 of 1, as each step leaves only a part of what it was off.
    void set_shares() {
        const IntLanes shares = __builtin_convertvector(weights_ * 65530.0f, IntLanes);
        for (size_t i = 0; i < n; ++i) shares_[i] = static_cast<uint16_t>(shares[i]);
    }

    Lanes weights_;
    Shares shares_;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
