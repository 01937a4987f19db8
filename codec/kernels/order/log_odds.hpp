// Binary decisions whose log-odds are a sum: a base that both sides know, and a learnt weight for each
// feature that is present.
//
// That is logistic regression on sparse features, learnt by gradient descent on the code length; with no
// experience it predicts what the base says.  Integers only.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "../entropy/logistic.hpp"
#include "../entropy/range_coder.hpp"

namespace ebz::order {

// What a feature adds, in 2^-16, and how often it was met.
struct Weight {
    static constexpr int fraction_bits = 8;  // below stretch_unit
    static constexpr int32_t limit = 16 * stretch_unit << fraction_bits;
    static constexpr uint32_t max_count = 255;

    void learn(int error) {
        value = std::clamp(value + ((error * rates[count]) >> 12), -limit, limit);
        if (count < max_count) ++count;
    }

    // In 2^-12: 0.02 in the long run, 0.31 at first; error has 17 bits, so products fit 31.
    static constexpr auto rates = [] {
        std::array<int32_t, max_count + 1> table{};
        for (int n = 0; n <= max_count; ++n) table[n] = 80 + 1200 * 16 / (16 + n);
        return table;
    }();

    // 22 bits and 8: in one word, since there are many.
    int32_t value : 24 = 0;
    uint32_t count : 8 = 0;
};

class LogOdds {
public:
    // base: the log-odds before anything is added, in units of stretch.
    explicit LogOdds(int base) : base_(base) {}

    void add(Weight& feature) { features_[n_++] = &feature; }

    template <class Coder>
    bool code(Coder& coder, bool bit) {
        int32_t sum = 0;
        for (int i = 0; i < n_; ++i) sum += features_[i]->value;
        const int p = squash(base_ + (sum >> Weight::fraction_bits));
        bit = coder.bit(bit, static_cast<uint32_t>(p));
        for (int i = 0; i < n_; ++i) features_[i]->learn((bit << probability_bits) - p);
        return bit;
    }

    static constexpr int max_features = 12;
    static_assert(int64_t{max_features} * Weight::limit < INT32_MAX);

private:
    int base_;
    int n_ = 0;
    std::array<Weight*, max_features> features_;
};

// Weights by the values of several small numbers.
template <int... extents>
class Weights {
public:
    template <class... Parts>
    Weight& at(Parts... parts) {
        static_assert(sizeof...(Parts) == sizeof...(extents));
        size_t place = 0;
        ((place = place * extents + static_cast<size_t>(parts)), ...);
        return weights_[place];
    }

private:
    std::vector<Weight> weights_ = std::vector<Weight>((size_t{1} * ... * extents));
};

namespace logarithms {

inline constexpr int ln_fraction_bits = 6, ln_index_bits = 8;

// ln(1 + i / 256) in 2^-14; the series of 2 artanh(x / (2 + x)).
inline constexpr auto ln_table = [] {
    std::array<int32_t, 1 << ln_index_bits> table{};
    for (int i = 0; i < 1 << ln_index_bits; ++i) {
        const double y = i / (512.0 + i);
        double power = y, sum = 0;
        for (int k = 1; k < 40; k += 2, power *= y * y) sum += power / k;
        table[i] = static_cast<int32_t>(2 * sum * (stretch_unit << ln_fraction_bits) + 0.5);
    }
    return table;
}();
inline constexpr int32_t ln_2 = 11357;  // in 2^-14

}  // namespace logarithms

// ln(x) in units of stretch, rounded down; x > 0.
inline int logarithm(uint32_t x) {
    using namespace logarithms;
    const int width = std::bit_width(x) - 1;
    const uint32_t mantissa = width > ln_index_bits ? x >> (width - ln_index_bits) : x << (ln_index_bits - width);
    return (width * ln_2 + ln_table[mantissa - (1u << ln_index_bits)]) >> ln_fraction_bits;
}

}  // namespace ebz::order
