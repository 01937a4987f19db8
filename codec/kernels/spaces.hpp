// Arithmetic of the predictions in each space: sums of coordinates, and the value nearest to a mean.
//
// Both sides compute it, so it is exact or correctly rounded everywhere: integers that wrap, or IEEE
// sums and quotients without contraction.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace ebz {

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

struct LatticeSpace {
    using Sum = uint64_t;
    static Sum value(int64_t x) { return static_cast<uint64_t>(x); }
    static int64_t mean(Sum sum, int n) {
        // Rounds to nearest, halves up; n <= 64, and wrapped sums only predict badly.
        const int64_t doubled = static_cast<int64_t>(2 * sum + static_cast<uint64_t>(n));
        const int64_t quotient = doubled / (2 * n);
        return quotient - (doubled % (2 * n) < 0);
    }
};

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

}  // namespace ebz
