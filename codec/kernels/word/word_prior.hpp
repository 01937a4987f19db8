// What adaptive models know of words before the first symbol.
#pragma once

#include <array>
#include <cstdint>

namespace ebz {

inline constexpr int n_decisions = 4;  // C or not, R or not, L or not, S or E

// By decision, degree of the gate's left end and the latest two symbols (WordHistory), in units of 1/16
// of the logistic domain.
using DegreePrior = std::array<std::array<std::array<int8_t, 64>, 16>, n_decisions>;

// Weights of n inputs in 2^-10.
template <int n>
struct MixingPrior {
    std::array<std::array<int16_t, n>, n_decisions> weights;
    std::array<std::array<std::array<int16_t, n>, n + 1>, n_decisions> by_known;  // number of contexts met before
};

}  // namespace ebz
