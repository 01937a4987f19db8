// Floats as integers in their order, and predictions among them: the float nearest to a mean.
//
// Both sides compute it, by IEEE sums and quotients without contraction, correctly rounded everywhere.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace ebz::positions {

// Floats as integers in the same order; the sign bit becomes the sign, -0.0 is -1 and 0.0 is 0.
template <class Bits>
constexpr int64_t ordered_from_bits(Bits bits) {
    using Signed = std::make_signed_t<Bits>;
    const Signed value = static_cast<Signed>(bits);
    return value >= 0 ? value : static_cast<Signed>(value ^ std::numeric_limits<Signed>::max());
}

template <class Bits>
constexpr Bits bits_from_ordered(int64_t ordered) {
    using Signed = std::make_signed_t<Bits>;
    const Signed value = static_cast<Signed>(ordered);
    return static_cast<Bits>(value >= 0 ? value : value ^ std::numeric_limits<Signed>::max());
}

template <class Float, class Bits>
struct FloatSpace {
    using Sum = double;
    static Sum value(int64_t ordered) {
        const Float x = std::bit_cast<Float>(bits_from_ordered<Bits>(ordered));
        return std::isfinite(x) ? static_cast<double>(x) : 0.0;
    }
    static int64_t mean(Sum sum, int n) {
        const double mean = sum / n;
        // Also false for NaN; a sum of doubles may overflow, and then predicts nothing.
        const bool fits = std::abs(mean) <= static_cast<double>(std::numeric_limits<Float>::max());
        return ordered_from_bits(std::bit_cast<Bits>(fits ? static_cast<Float>(mean) : Float{0}));
    }
};

using Float32Space = FloatSpace<float, uint32_t>;
using Float64Space = FloatSpace<double, uint64_t>;

}  // namespace ebz::positions
