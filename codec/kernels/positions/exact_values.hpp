// Values that a residual may repeat: what they say of a decision, as long as they are in the interval.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "counter.hpp"
#include "expectation.hpp"
#include "lanes.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class ExactValues {
public:
    static constexpr size_t n_nodes = 32;

    ExactValues() {
        for (auto& table : hits_) table.fill(counter::unseen);
    }

    // The interval is all; distances are those of the negative side.
    void start(const Expectation& x) {
        for (size_t i = 0; i < n; ++i) {
            nodes_[i] = &told_[i][x.value_context[i]];
            hit_[i] = &hits_[i][x.value_context[i]];
            value_[i] = x.value[i];
            distance_[i] = ~value_[i];
        }
        present_ = x.values;
        alive_ = 0;
        CounterState most = 0;
        for (size_t i = 0; i < n; ++i) {
            const CounterState hits = (present_ >> i & 1) != 0 ? *hit_[i] : 0;
            alive_ |= static_cast<unsigned>(hits >= min_hits) << i;
            if (hits > most) {
                most = hits;
                likeliest_ = i;
            }
        }
        likely_ = most >= sure_hits;
    }

    void take_side(bool negative) {
        take(negative);
        if (!negative) distance_ = value_;
    }

    // Whether one value is all but certain.
    bool may_hit() const { return likely_; }
    int64_t likeliest() const { return value_[likeliest_]; }

    bool any() const { return alive_ != 0; }

    // Logits of the distance being at least `at`, by how often each value told it right.
    WideLanes split(int64_t at, size_t node) {
        upper_ = 0;
        for (size_t i = 0; i < n; ++i) upper_ |= static_cast<unsigned>(distance_[i] >= at) << i;
        return opinions(node);
    }

    // The same of the residual being the likeliest value.
    WideLanes single_out(size_t node) {
        upper_ = 0;
        for (size_t i = 0; i < n; ++i) upper_ |= static_cast<unsigned>(value_[i] == value_[likeliest_]) << i;
        return opinions(node);
    }

    // After the last split.
    void learn(bool upper, size_t node) {
        const WideIntLanes right = lanes_of(upper ? upper_ : ~upper_);
        const WideLanes target = only(right, splat<WideLanes>(counter::certain));
        const WideIntLanes learnt = counter::updated(states_, target, splat<WideLanes>(expected_right));
        const WideIntLanes next = lanes_of(alive_) != 0 ? learnt : states_;
        for (size_t i = 0; i < n; ++i) (*nodes_[i])[node] = static_cast<CounterState>(next[i]);
    }

    void take(bool upper) { alive_ &= upper ? upper_ : ~upper_; }

    void finish(int64_t e) {
        unsigned hits = 0;
        for (size_t i = 0; i < n; ++i) hits |= static_cast<unsigned>(value_[i] == e) << i;
        const auto state = [&](size_t i) { return static_cast<int32_t>(*hit_[i]); };
        const WideIntLanes states = {state(0), state(1), state(2), state(3), state(4), state(5), state(6), state(7)};
        const WideLanes target = only(lanes_of(hits), splat<WideLanes>(counter::certain));
        const WideIntLanes learnt = counter::updated(states, target, splat<WideLanes>(expected_hit));
        const WideIntLanes next = lanes_of(present_) != 0 ? learnt : states;
        for (size_t i = 0; i < n; ++i) *hit_[i] = static_cast<CounterState>(next[i]);
    }

private:
    static constexpr size_t n = Expectation::n_values, n_contexts = Expectation::n_value_contexts;
    static_assert(n == 8, "one vector");
    static constexpr CounterState sure_hits = 0xE8000000u;  // 0.9: below, a decision of its own does not pay
    static constexpr CounterState min_hits = 1u << 26;  // 1/64: rarer ones do not pay
    static constexpr float expected_right = 0.75f * 4194304, expected_hit = 0.25f * 4194304;

    WideLanes opinions(size_t node) {
        const auto state = [&](size_t i) { return static_cast<int32_t>((*nodes_[i])[node]); };
        states_ = WideIntLanes{state(0), state(1), state(2), state(3), state(4), state(5), state(6), state(7)};
        const WideLanes agrees = counter::logit_of<WideLanes>(states_);
        return only(lanes_of(alive_) & (counter::n(states_) != 0), lanes_of(upper_) != 0 ? agrees : -agrees);
    }

    using Nodes = std::array<CounterState, n_nodes>;

    std::array<std::array<Nodes, n_contexts>, n> told_{};         // by context: whether a value told right
    std::array<std::array<CounterState, n_contexts>, n> hits_{};  // how often a value is the one
    std::array<Nodes*, n> nodes_{};
    std::array<CounterState*, n> hit_{};
    std::array<int64_t, n> value_{}, distance_{};
    unsigned present_ = 0, alive_ = 0, upper_ = 0;  // a bit per value
    WideIntLanes states_{};
    size_t likeliest_ = 0;
    bool likely_ = false;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
