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

#include "context_counters.hpp"
#include "distributions.hpp"
#include "exact_values.hpp"
#include "expectation.hpp"
#include "float_logistic.hpp"
#include "initial_weights.hpp"
#include "lanes.hpp"
#include "mixer.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <class Coder>
class ResidualModel {
public:
    ResidualModel(Coder& coder, size_t n_vertices)
        : coder_(coder), contexts_(n_vertices), mixer_(n_nodes, n_nodes * 3 * n_levels) {
        for (size_t node = 0; node < n_nodes; ++node) {
            mixer_.start(node, initial_weights[std::min(node, initial_weights.size() - 1)]);
        }
    }

    // To be called as soon as the contexts are known.
    void find(const Expectation& x) { contexts_.find(x); }

    // Codes e and returns it; decoders pass anything.
    int64_t code(const Expectation& x, int64_t e) {
        start(x);
        if (values_.may_hit() && hit(e)) {
            const int64_t value = values_.likeliest();
            values_.finish(value);
            return value;
        }
        const bool negative = split(0, side_node, side_slot, e < 0);
        take_side(negative);
        const int64_t a = negative ? ~e : e;
        const int k = code_class(a);
        const int64_t decoded = k < 2 ? k : code_digits(k - 1, a);
        const int64_t residual = negative ? ~decoded : decoded;
        values_.finish(residual);
        return residual;
    }

private:
    static constexpr size_t n_levels = 12, n_nodes = ExactValues::n_nodes;

    // Nodes of the decision tree, of weights; slots of the counters of one context.
    static constexpr size_t side_node = 0, class_node = 1, digit_node = 8, hit_node = 24;
    static constexpr size_t side_slot = 0, class_slot = 1, digit_slot = 15, hit_slot = 23;
    static constexpr size_t n_slots = ContextCounters::n_slots;

    void start(const Expectation& x) {
        x_ = &x;
        rate_ = 0.0021f * (1.0f + 4.0f / (1.0f + n_decisions_ * (1.0f / 10000.0f)));
        contexts_.start(x);
        distributions_.start(x);
        values_.start(x);
    }

    void take_side(bool negative) {
        negative_ = negative;
        low_ = 0;
        distributions_.take_side(negative);
        values_.take_side(negative);
    }

    // Whether the distance is at least `at`; `answer` is the encoder's.
    bool split(int64_t at, size_t node, size_t slot, bool answer) {
        const WideLanes values = values_.any() ? values_.split(at, node) : WideLanes{};
        return decide(distributions_.odds(), values, node, slot, answer);
    }

    // Whether the residual is the likeliest value.
    bool hit(int64_t e) {
        const int64_t value = values_.likeliest();
        const bool is = decide(distributions_.odds_of(value), values_.single_out(hit_node), hit_node, hit_slot, e == value);
        if (!is) values_.take(false);
        return is;
    }

    // Mixes what contexts, distributions and values say.
    bool decide(WideLanes odds, WideLanes values, size_t node, size_t slot, bool answer) {
        const bool counted = slot < n_slots;
        Mixer<3>::Inputs inputs;
        inputs[0] = counted ? contexts_.opinions(slot) : WideLanes{};
        inputs[1] = odds;
        inputs[2] = values;
        const size_t set = (node * 3 + x_->turn) * n_levels + static_cast<size_t>(x_->level);
        const auto [p, p16] = probability(mixer_.mix(inputs, node, set));
        const bool bit = coder_.bit(answer, p16);
        const float target = bit ? 1.0f : 0.0f;
        n_decisions_ += 1.0f;
        mixer_.update(inputs, (target - p) * rate_);
        if (counted) contexts_.learn(slot, bit, static_cast<float>(static_cast<int32_t>(p16 << 6)));
        if (values_.any()) values_.learn(bit, node);
        return bit;
    }

    bool narrow(int64_t at, size_t node, size_t slot, int64_t a) {
        const bool upper = split(at, node, slot, a >= at);
        if (upper) low_ = at;
        distributions_.take(upper);
        values_.take(upper);
        return upper;
    }

    int code_class(int64_t a) {
        const auto above = [&](int k) {  // a >= 2^k, that is class > k
            const auto j = static_cast<size_t>(std::clamp(k - x_->shift, 0, 6));
            distributions_.split_above_zero(k);
            return narrow(int64_t{1} << k, class_node + j, class_slot + j + (negative_ ? 7 : 0), a);
        };
        int k = x_->expected_class;
        if (above(k)) {
            while (++k < Expectation::max_class && above(k)) {}
            return k;
        }
        while (k > 0 && !above(k - 1)) --k;
        return k;
    }

    int64_t code_digits(int n_digits, int64_t a) {
        const auto group = static_cast<size_t>(std::clamp(n_digits - 1 - x_->shift, 0, 3));
        for (int left = n_digits; left > 0; --left) {
            const int depth = n_digits - left;
            if (depth > 0 && !values_.any()) return code_raw(left, a);  // close to noise
            const size_t node = digit_node + static_cast<size_t>(std::min(depth, 3)) * 4 + group;
            const size_t slot = depth == 0 ? digit_slot + group * 2 + (negative_ ? 1 : 0) : n_slots;  // no counters
            distributions_.split_above_low(left - 1);
            narrow(low_ + (int64_t{1} << (left - 1)), node, slot, a);
        }
        return low_;
    }

    int64_t code_raw(int n_digits, int64_t a) {
        int64_t digits = 0;
        for (int left = n_digits; left > 0;) {
            const int n_raw = std::min(left, 16);
            left -= n_raw;
            const auto bits = static_cast<uint32_t>(static_cast<uint64_t>(a) >> left) & ((1u << n_raw) - 1);
            digits = digits << n_raw | coder_.raw(bits, n_raw);
        }
        return low_ + digits;
    }

    Coder& coder_;
    ContextCounters contexts_;
    Distributions distributions_;
    ExactValues values_;
    Mixer<3> mixer_;
    float n_decisions_ = 0, rate_ = 0;

    // The residual under way: distances a still possible begin at low_.
    const Expectation* x_ = nullptr;
    int64_t low_ = 0;
    bool negative_ = false;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
