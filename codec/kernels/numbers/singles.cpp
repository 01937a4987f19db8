#include "singles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ebz {

namespace {

using Text = std::array<char, 64>;

bool is_same(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }

// Not a number where it is beyond all float32.
float nearest_single(double x) {
    const bool fits = std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()) || std::isinf(x);
    return fits ? static_cast<float>(x) : std::numeric_limits<float>::quiet_NaN();
}

double written(float x, int digits) {
    if (digits == 0 || !std::isfinite(x)) return static_cast<double>(x);
    Text text;
    const auto end = std::to_chars(text.begin(), text.end(), static_cast<double>(x), std::chars_format::scientific, digits - 1);
    double value = 0;
    std::from_chars(text.begin(), end.ptr, value);
    return value;
}

bool most_are_written(std::span<const double> values, int digits, size_t max_misses) {
    size_t misses = 0;
    for (const double x : values) {
        misses += !is_same(written(nearest_single(x), digits), x);
        if (misses > max_misses) return false;
    }
    return true;
}

// Of the shortest decimal that gives x.
int significant_digits(double x) {
    Text text;
    const auto end = std::to_chars(text.begin(), text.end(), x, std::chars_format::scientific);
    const auto exponent = std::find(text.begin(), end.ptr, 'e');
    return static_cast<int>(std::count_if(text.begin(), exponent, [](char c) { return c >= '0' && c <= '9'; }));
}

// The fewest digits that all values but max_misses have; -1 if there are too many.
int most_digits(std::span<const double> values, size_t max_misses) {
    std::array<size_t, max_single_digits + 1> n_with{};
    size_t misses = 0;
    for (const double x : values) {
        const int digits = std::isfinite(x) ? significant_digits(x) : 0;
        if (digits <= max_single_digits) ++n_with[static_cast<size_t>(digits)];
        else if (++misses > max_misses) return -1;
    }
    int digits = max_single_digits;
    while (digits > 1 && misses + n_with[static_cast<size_t>(digits)] <= max_misses) {
        misses += n_with[static_cast<size_t>(digits--)];
    }
    return digits;
}

}  // namespace

int single_digits(std::span<const double> values, size_t max_misses) {
    if (most_are_written(values, 0, max_misses)) return 0;
    const int digits = most_digits(values, max_misses);
    return digits > 0 && most_are_written(values, digits, max_misses) ? digits : -1;
}

void write_singles(std::span<const float> singles, int digits, std::span<double> values) {
    for (size_t i = 0; i < singles.size() && i < values.size(); ++i) values[i] = written(singles[i], digits);
}

}  // namespace ebz
