// What the light and medium models are told about a residual.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ebz::positions {

struct LightContext {
    static constexpr size_t n_contexts = 4, n_values = 1024, n_value_contexts = 9;
    static constexpr int max_class = 44;

    std::array<size_t, n_contexts> context;  // < n_values
    int shift, expected_class;
    int64_t value;         // a residual that would repeat a neighbour's value
    size_t value_context;  // < n_value_contexts
};

}  // namespace ebz::positions
