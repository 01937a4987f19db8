#include "lattices.hpp"

#include <bit>
#include <limits>
#include <type_traits>

namespace ebz {

namespace {

// To the nearest integer, ties to even, for |x| < 2^51.
double round_to_integer(double x) {
    constexpr double shift = 6755399441055744.0;  // 1.5 * 2^52: the sum has no fraction bits left
    return (x + shift) - shift;
}

template <class Float>
bool on_lattice(Float value, double scale) {
    using Bits = std::conditional_t<sizeof(Float) == 4, uint32_t, uint64_t>;
    const double multiple = static_cast<double>(value) * scale;
    if (!(multiple >= -max_multiple && multiple <= max_multiple)) return false;
    const Float back = static_cast<Float>(round_to_integer(multiple) / scale);
    return std::bit_cast<Bits>(back) == std::bit_cast<Bits>(value);
}

template <class Float>
bool most_on_lattice(std::span<const Float> values, double scale, size_t max_misses) {
    size_t misses = 0;
    for (const Float value : values) {
        misses += !on_lattice(value, scale);
        if (misses > max_misses) return false;
    }
    return true;
}

}  // namespace

template <class Float>
int decimal_digits(std::span<const Float> values, int max_digits, size_t max_misses) {
    double scale = 1;
    for (int digits = 0; digits <= max_digits; ++digits, scale *= 10) {
        if (most_on_lattice(values, scale, max_misses)) return digits;
    }
    return -1;
}

template <class Float>
std::array<double, 6> bounds(std::span<const Float> coordinates) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<Float, 3> low, high;
    low.fill(std::numeric_limits<Float>::infinity());
    high.fill(-std::numeric_limits<Float>::infinity());
    std::array<Float, 3> poison{};  // NaN from the first value on that is not finite
    for (size_t i = 0; i + 2 < coordinates.size(); i += 3) {
        for (size_t axis = 0; axis < 3; ++axis) {
            const Float x = coordinates[i + axis];
            low[axis] = x < low[axis] ? x : low[axis];
            high[axis] = x > high[axis] ? x : high[axis];
            poison[axis] += x * 0;
        }
    }
    std::array<double, 6> all{-infinity, -infinity, -infinity, infinity, infinity, infinity};
    if (poison[0] + poison[1] + poison[2] != 0) return all;
    for (size_t axis = 0; axis < 3; ++axis) {
        all[axis] = static_cast<double>(low[axis]);
        all[axis + 3] = static_cast<double>(high[axis]);
    }
    return all;
}

template <class Float>
void to_multiples(std::span<const Float> coordinates, const Steps& steps, std::span<int64_t> multiples) {
    const Steps fixed = steps;  // in registers whatever is written
    for (size_t i = 0; i + 2 < coordinates.size(); i += 3) {
        for (size_t axis = 0; axis < 3; ++axis) {
            const double x = (static_cast<double>(coordinates[i + axis]) - fixed.origin[axis]) / fixed.step;
            const bool inside = x >= -max_multiple && x <= max_multiple;
            multiples[i + axis] = static_cast<int64_t>(round_to_integer(inside ? x : 0));
        }
    }
}

template <class Integer, class Float>
void from_multiples(const Rows<Integer>& multiples, const Steps& steps, std::span<Float> coordinates) {
    const Steps fixed = steps;  // in registers whatever is written
    const Integer* row = multiples.first;
    for (size_t i = 0; i < 3 * multiples.n; i += 3, row += multiples.stride) {
        for (size_t axis = 0; axis < 3; ++axis) {
            const double x = fixed.origin[axis] + static_cast<double>(row[axis]) * fixed.step;
            coordinates[i + axis] = static_cast<Float>(x);
        }
    }
}

template std::array<double, 6> bounds(std::span<const float>);
template std::array<double, 6> bounds(std::span<const double>);
template void to_multiples(std::span<const float>, const Steps&, std::span<int64_t>);
template void to_multiples(std::span<const double>, const Steps&, std::span<int64_t>);
template void from_multiples(const Rows<int32_t>&, const Steps&, std::span<float>);
template void from_multiples(const Rows<int32_t>&, const Steps&, std::span<double>);
template void from_multiples(const Rows<int64_t>&, const Steps&, std::span<float>);
template void from_multiples(const Rows<int64_t>&, const Steps&, std::span<double>);
template int decimal_digits(std::span<const float>, int, size_t);
template int decimal_digits(std::span<const double>, int, size_t);

}  // namespace ebz
