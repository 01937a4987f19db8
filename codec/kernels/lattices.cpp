#include "lattices.hpp"

#include <bit>
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

template int decimal_digits(std::span<const float>, int, size_t);
template int decimal_digits(std::span<const double>, int, size_t);

}  // namespace ebz
