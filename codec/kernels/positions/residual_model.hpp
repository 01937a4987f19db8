// One residual as binary decisions, each the mix of distributions, counted contexts and exact values.
//
// The residual e becomes a side (e < 0), then the distance a = e or -1 - e on that side: its class
// (number of binary digits), searched from the expected class outwards, then its digits from the top.
// Every decision splits an interval of values in two, so that each distribution states its odds.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "counter.hpp"
#include "lanes.hpp"
#include "float_logistic.hpp"
#include "mixer.hpp"

namespace ebz::positions {

// What is known about one coordinate before it is coded; values are relative to its base.
struct Expectation {
    static constexpr size_t n_distributions = 4, n_contexts = 8, n_values = 8;

    alignas(16) std::array<float, n_distributions> mean;
    alignas(16) std::array<float, n_distributions> scale;  // of logistic distributions
    std::array<uint32_t, n_contexts> context;         // hashed
    std::array<int64_t, n_values> value;              // exact values seen nearby
    std::array<uint8_t, n_values> value_context;      // < 64
    unsigned values;                                  // bit i: value[i] holds
    size_t turn;                                      // 0, 1, 2: how many axes came before
    int level;                                        // half-octaves of the expected size, after the shift
    int shift;                                        // of the classes, for sizes beyond all contexts
    int expected_class;
};

class ResidualModel {
public:
    explicit ResidualModel(size_t n_vertices);

    // Codes e and returns it; decoders pass anything.
    template <class Coder>
    int64_t code(Coder& coder, const Expectation& x, int64_t e);

    static constexpr int max_class = 44;  // coordinates and predictions of magnitude 2^40 stay below

private:
    static constexpr size_t n_contexts = Expectation::n_contexts, n_values = Expectation::n_values;
    static constexpr size_t n_distribution_lanes = Expectation::n_distributions / 4;
    static constexpr size_t n_lanes = n_contexts / 4 + n_distribution_lanes + n_values / 4 + 1;
    static constexpr size_t n_levels = 12, n_nodes = 32;
    static constexpr int n_mixed_digits = 2;  // deeper ones only if an exact value may tell them

    // Nodes of the decision tree, of weights; slots of the counters of one context.
    static constexpr size_t side_node = 0, class_node = 1, digit_node = 8;
    static constexpr size_t side_slot = 0, class_slot = 1, digit_slot = 15, n_slots = 31;

    using Tails = std::array<Lanes, n_distribution_lanes>;
    struct alignas(64) Line {  // two cache lines
        std::array<CounterState, n_slots> counters;
        uint32_t tag;

        void reset(uint32_t new_tag) {
            counters.fill(counter::unseen);
            tag = new_tag;
        }
    };

    void start(const Expectation& x);
    void take_side(const Expectation& x, bool negative);
    void mirror(const Expectation& x, bool negative);
    void tails(int64_t at, Tails& out) const;
    void add_distributions(const Tails& low, const Tails& at, const Tails& high);
    void split_values(int64_t at);
    uint32_t predict(const Expectation& x, size_t node, size_t slot);
    void learn(const Expectation& x, bool bit);
    void enter_split(int64_t at);
    void leave_split(int64_t at, bool upper);
    void learn_hits(const Expectation& x, int64_t e);

    template <class Coder>
    bool decide(Coder& coder, const Expectation& x, size_t node, size_t slot, bool bit);
    template <class Coder>
    bool split(Coder& coder, const Expectation& x, int64_t at, size_t node, size_t slot, int64_t a);
    template <class Coder>
    int code_class(Coder& coder, const Expectation& x, int64_t a);
    template <class Coder>
    int64_t code_digits(Coder& coder, const Expectation& x, int n_digits, int64_t a);
    template <class Coder>
    int64_t code_raw(Coder& coder, int n_digits, int64_t a);

    int log2_lines_;
    std::array<std::vector<Line>, n_contexts> lines_;
    Mixer<n_lanes> mixer_;
    Curve curve_;
    std::array<std::array<std::array<Counter, n_nodes>, 64>, n_values> value_counters_{};
    std::array<std::array<Counter, 64>, n_values> hits_{};  // how often a value is the one
    float n_decisions_ = 0;

    // The residual under way: distances a still possible are those in [low_, high).
    std::array<Line*, n_contexts> line_;
    Tails mean_, sharpness_;
    Tails from_low_, from_at_, from_high_;  // P(a >= bound) of each distribution
    int64_t low_ = 0;
    std::array<int64_t, n_values> value_;  // as distances on this side
    unsigned alive_ = 0, upper_ = 0;       // values in the interval, and in its upper part
    bool negative_ = false;

    // The decision under way.
    Mixer<n_lanes>::Inputs inputs_;
    std::array<IntLanes, n_contexts / 4> states_;  // of the counters
    size_t node_ = 0, slot_ = 0;
    float p_ = 0;
    uint32_t p16_ = 0;
};

template <class Coder>
bool ResidualModel::decide(Coder& coder, const Expectation& x, size_t node, size_t slot, bool bit) {
    const uint32_t p = predict(x, node, slot);
    bit = coder.bit(bit, p);
    learn(x, bit);
    return bit;
}

template <class Coder>
bool ResidualModel::split(Coder& coder, const Expectation& x, int64_t at, size_t node, size_t slot, int64_t a) {
    enter_split(at);
    const bool upper = decide(coder, x, node, slot, a >= at);
    leave_split(at, upper);
    return upper;
}

template <class Coder>
int ResidualModel::code_class(Coder& coder, const Expectation& x, int64_t a) {
    const auto above = [&](int k) {  // a >= 2^k, that is class > k
        const auto j = static_cast<size_t>(std::clamp(k - x.shift, 0, 6));
        return split(coder, x, int64_t{1} << k, class_node + j, class_slot + j + (negative_ ? 7 : 0), a);
    };
    int k = x.expected_class;
    if (above(k)) {
        while (++k < max_class && above(k)) {}
        return k;
    }
    while (k > 0 && !above(k - 1)) --k;
    return k;
}

template <class Coder>
int64_t ResidualModel::code_digits(Coder& coder, const Expectation& x, int n_digits, int64_t a) {
    const auto group = static_cast<size_t>(std::clamp(n_digits - 1 - x.shift, 0, 3));
    bool first = false;
    for (int left = n_digits; left > 0; --left) {
        const int depth = n_digits - left;
        if (depth >= n_mixed_digits && alive_ == 0) return code_raw(coder, left, a);
        const size_t node = digit_node + static_cast<size_t>(std::min(depth, 3)) * 4 + group;
        const size_t slot = depth == 0   ? digit_slot + group * 2 + (negative_ ? 1 : 0)
                            : depth == 1 ? digit_slot + 8 + group * 2 + (first ? 1 : 0)
                                         : n_slots;  // no counters
        const bool upper = split(coder, x, low_ + (int64_t{1} << (left - 1)), node, slot, a);
        if (depth == 0) first = upper;
    }
    return low_;
}

template <class Coder>
int64_t ResidualModel::code_raw(Coder& coder, int n_digits, int64_t a) {
    int64_t digits = 0;
    for (int left = n_digits; left > 0;) {
        const int n_raw = std::min(left, 16);
        left -= n_raw;
        const auto bits = static_cast<uint32_t>(static_cast<uint64_t>(a) >> left) & ((1u << n_raw) - 1);
        digits = digits << n_raw | coder.raw(bits, n_raw);
    }
    return low_ + digits;
}

template <class Coder>
int64_t ResidualModel::code(Coder& coder, const Expectation& x, int64_t e) {
    start(x);
    const bool negative = decide(coder, x, side_node, side_slot, e < 0);
    take_side(x, negative);
    const int64_t a = negative ? -1 - e : e;
    const int k = code_class(coder, x, a);
    const int64_t decoded = k < 2 ? k : code_digits(coder, x, k - 1, a);
    const int64_t residual = negative ? -1 - decoded : decoded;
    learn_hits(x, residual);
    return residual;
}

}  // namespace ebz::positions
