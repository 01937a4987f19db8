// The odds that logistic distributions give to the upper part of an interval of distances.
//
// With z(b) = 2^((mean - b) / scale log2 e), the probability of at least b is z / (1 + z), and the odds
// of [at, high) against [low, at) are (z(at) - z(high)) (1 + z(low)) / ((z(low) - z(at)) (1 + z(high))).
// z(b + 2^j) is z(b) times a step that depends on j alone: steps near the expected class are made ahead.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "expectation.hpp"
#include "lanes.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class Distributions {
public:
    // The interval is all; among distances of the negative side, e < 0 is "at least 0".
    void start(const Expectation& x) {
        // Lane by lane: wide loads would have to wait for narrow stores.
        const auto lanes = [](const auto& y) { return WideLanes{y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7]}; };
        sharpness_ = log2_e / lanes(x.scale);
        centre_ = (lanes(x.mean) + 0.5f) * sharpness_;
        positive_ = power(centre_);
        at_ = power(-centre_);
        low_ = splat<WideLanes>(largest);
        high_ = WideLanes{};
        first_step_ = std::max(x.expected_class - 3, 0);
        for (int i = 0; i < n_steps; ++i) steps_[static_cast<size_t>(i)] = step(first_step_ + i);
    }

    // Logits of the residual being e, before anything else; the last lane is a constant.
    WideLanes odds_of(int64_t e) const {
        const float from = static_cast<float>(e);
        const WideLanes z = power(centre_ - from * sharpness_), z_next = power(centre_ - (from + 1.0f) * sharpness_);
        const WideLanes inside = max(z - z_next, splat<WideLanes>(tiny));
        return inputs(inside, max((1.0f + z) * (1.0f + z_next) - inside, splat<WideLanes>(tiny)));
    }

    // Which side was answered to the split at 0.
    void take_side(bool negative) { low_ = zero_ = negative ? at_ : positive_; }

    // The next split is at 2^j, or at low + 2^j.
    void split_above_zero(int j) { at_ = max(zero_ * step_of(j), splat<WideLanes>(least)); }
    void split_above_low(int j) { at_ = max(low_ * step_of(j), splat<WideLanes>(least)); }

    // Logits of the upper part; the last lane is a constant.
    WideLanes odds() const {
        const WideLanes upper = max(at_ - high_, splat<WideLanes>(tiny)), lower = max(low_ - at_, splat<WideLanes>(tiny));
        return inputs(upper * (1.0f + low_), lower * (1.0f + high_));
    }

    void take(bool upper) { (upper ? low_ : high_) = at_; }

private:
    static constexpr float log2_e = 1.442695f, max_logit = 11.0f, tiny = 1e-30f;
    // Of z: products stay normal.
    static constexpr float limit_log2 = 40.0f, largest = 0x1p40f, least = 0x1p-80f;
    static constexpr int n_steps = 6;

    static WideLanes inputs(WideLanes yes, WideLanes no) {
        const WideLanes limit = splat<WideLanes>(max_logit), odds = max(min(log2_ratio(yes, no), limit), -limit);
        constexpr WideLanes constant = {0, 0, 0, 0, 0, 0, 0, 0.4f};
        constexpr WideIntLanes given = {-1, -1, -1, -1, 0, 0, 0, 0};
        return only(given, odds) + constant;
    }

    static WideLanes power(WideLanes x) {
        const WideLanes limit = splat<WideLanes>(limit_log2);
        return exp2_approx(max(min(x, limit), -limit));
    }

    // z(b + 2^j) / z(b).
    WideLanes step(int j) const {
        const float distance = std::bit_cast<float>((127 + j) << 23);
        return exp2_approx(max(-distance * sharpness_, splat<WideLanes>(-limit_log2)));
    }
    WideLanes step_of(int j) const {
        const auto i = static_cast<unsigned>(j - first_step_);
        return i < n_steps ? steps_[i] : step(j);
    }

    alignas(32) std::array<WideLanes, n_steps> steps_;
    WideLanes centre_, sharpness_, positive_, zero_;
    WideLanes low_, at_, high_;  // z
    int first_step_ = 0;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
