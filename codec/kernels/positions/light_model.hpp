// One residual as binary decisions, each the mix of four counted contexts.
//
// A residual that would repeat a neighbour's value has a decision of its own where such residuals are
// frequent; otherwise side, class, leading digit and raw digits: the tree of residual_model.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "counter.hpp"
#include "lanes.hpp"
#include "light_context.hpp"
#include "float_logistic.hpp"

namespace ebz::positions {

class LightModel {
public:
    using Context = LightContext;
    static constexpr size_t n_slots = 33;
    using Slots = std::array<CounterState, n_slots>;

    LightModel() {
        for (auto& slots : slots_)
            for (auto& s : slots) s.fill(counter::unseen);
        weights_.fill(splat<Lanes>(0.35f));
    }

    template <class Coder>
    int64_t code(Coder& coder, const Context& x, int64_t e) {
        for (size_t i = 0; i < n_contexts; ++i) active_[i] = &slots_[i][x.context[i]];
        Counter& hits = hits_[x.value_context];
        const uint32_t p = hits.p16();
        const bool hit = x.value != 0 && p >= min_hits ? coder.bit(e == x.value, std::min(p, 65000u)) : false;
        if (hit) {
            hits.update(true, 16384);
            return x.value;
        }
        const int64_t residual = code_residual(coder, x, e);
        if (x.value != 0) hits.update(residual == x.value, 16384);
        return residual;
    }

private:
    static constexpr size_t n_contexts = Context::n_contexts;
    static constexpr uint32_t min_hits = 4096;  // of 65536

    template <class Coder>
    int64_t code_residual(Coder& coder, const Context& x, int64_t e) {
        const bool negative = decide(coder, 0, e < 0);
        const int64_t a = negative ? -1 - e : e;
        const int k = code_class(coder, x, a, negative);
        const int64_t decoded = k < 2 ? k : code_digits(coder, x, k, a, negative);
        return negative ? -1 - decoded : decoded;
    }

    template <class Coder>
    bool decide(Coder& coder, size_t slot, bool bit) {
        const auto at = [&](size_t i) { return static_cast<int32_t>((*active_[i])[slot]); };
        const IntLanes states = {at(0), at(1), at(2), at(3)};
        const Lanes opinions = counter::opinion<Lanes>(states);
        Lanes& weights = weights_[slot];
        const float probability = squash(clamp(sum(weights * opinions), -20.0f, 20.0f));
        const auto p = static_cast<uint32_t>(std::clamp(static_cast<int32_t>(probability * 65536.0f), 1, 65535));
        bit = coder.bit(bit, p);
        weights += opinions * (((bit ? 1.0f : 0.0f) - probability) * learning_rate);
        const Lanes target = splat<Lanes>(bit ? counter::certain : 0.0f);
        const IntLanes next = counter::updated(states, target, splat<Lanes>(probability * counter::certain));
        for (size_t i = 0; i < n_contexts; ++i) (*active_[i])[slot] = static_cast<CounterState>(next[i]);
        return bit;
    }

    template <class Coder>
    int code_class(Coder& coder, const Context& x, int64_t a, bool negative) {
        const auto above = [&](int k) {
            const auto j = static_cast<size_t>(std::clamp(k - x.shift, 0, 7));
            return decide(coder, 1 + j + (negative ? 8 : 0), a >= int64_t{1} << k);
        };
        int k = x.expected_class;
        if (above(k)) {
            while (++k < Context::max_class && above(k)) {}
            return k;
        }
        while (k > 0 && !above(k - 1)) --k;
        return k;
    }

    template <class Coder>
    int64_t code_digits(Coder& coder, const Context& x, int k, int64_t a, bool negative) {
        auto value = uint64_t{1};
        int left = k - 1;
        const auto j = static_cast<size_t>(std::clamp(k - x.shift, 0, 7));
        --left;
        value = value * 2 + (decide(coder, 17 + j + (negative ? 8 : 0), (a >> left & 1) != 0) ? 1 : 0);
        while (left > 0) {
            const int n_raw = std::min(left, 16);
            left -= n_raw;
            const auto bits = static_cast<uint32_t>(static_cast<uint64_t>(a) >> left) & ((1u << n_raw) - 1);
            value = value << n_raw | coder.raw(bits, n_raw);
        }
        return static_cast<int64_t>(value);
    }

    static constexpr float learning_rate = 0.01f;

    std::array<std::array<Slots, Context::n_values>, n_contexts> slots_;
    std::array<Lanes, n_slots> weights_;
    std::array<Counter, Context::n_value_contexts> hits_{};
    std::array<Slots*, n_contexts> active_{};
};

}  // namespace ebz::positions
