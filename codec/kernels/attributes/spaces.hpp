// What the integers of an attribute stand for: themselves, or floats in their order.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../positions/spaces.hpp"
#include "../positions/wrapping.hpp"

namespace ebz::attributes {

// How predictions are made.
enum class Space : uint8_t { integers, float32, float64 };

struct IntegerSpace {
    static double value(int64_t x) { return static_cast<double>(x); }
    static int64_t nearest(double x) { return positions::rounded(x); }
    // That of the other sign.
    static int64_t mirrored(int64_t x) { return positions::wrapping_difference(0, x); }
    // The distance of neighbouring values at x.
    static double unit(double) { return 1.0; }
    // Where x is among the integers from base on.
    static double offset(double x, int64_t base) { return x - static_cast<double>(base); }
};

template <class Base, class Float>
struct FloatSpaceOf {
    static double value(int64_t x) { return Base::value(x); }
    static int64_t nearest(double x) { return Base::mean(x, 1); }
    static int64_t mirrored(int64_t x) { return -1 - x; }
    static double offset(double x, int64_t base) {
        return static_cast<double>(positions::wrapping_difference(nearest(x), base));
    }
    static double unit(double x) {
        const double at = std::min(std::abs(x), static_cast<double>(std::numeric_limits<Float>::max()) / 2);
        const int64_t ordered = nearest(at);
        const double step = value(ordered + 1) - value(ordered);
        return step > 1e-300 ? step : 1e-300;
    }
};

using Float32 = FloatSpaceOf<positions::Float32Space, float>;
using Float64 = FloatSpaceOf<positions::Float64Space, double>;

}  // namespace ebz::attributes
