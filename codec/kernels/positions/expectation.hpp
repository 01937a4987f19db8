// What is known about one coordinate before it is coded; values are relative to its base.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ebz::positions {

struct Expectation {
    static constexpr size_t n_distributions = 7, n_contexts = 4, n_values = 8, n_value_contexts = 80;
    static constexpr int max_class = 44;  // coordinates and predictions of magnitude 2^40 stay below

    alignas(32) std::array<float, n_distributions + 1> mean;   // the last is not used
    alignas(32) std::array<float, n_distributions + 1> scale;  // of logistic distributions
    std::array<uint32_t, n_contexts> context;         // hashed
    std::array<int64_t, n_values> value;              // exact values seen nearby
    std::array<uint8_t, n_values> value_context;      // < n_value_contexts, 0 where there is no value
    unsigned values;                                  // bit i: value[i] holds
    size_t turn;                                      // 0, 1, 2: how many axes came before
    int level;                                        // half-octaves of the expected size, after the shift
    int shift;                                        // of the classes, for sizes beyond all contexts
    int expected_class;
};

}  // namespace ebz::positions
