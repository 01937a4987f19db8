#include "residual_model.hpp"

#include <bit>

#include "initial_weights.hpp"


namespace ebz::positions {

namespace {

constexpr float log2_e = 1.442695f;
constexpr float max_logit = 11.0f;
constexpr uint32_t min_hits = 1024;  // of 65536: values that are hardly ever the one do not pay for their time

}  // namespace

ResidualModel::ResidualModel(size_t n_vertices)
    : log2_lines_(std::clamp(static_cast<int>(std::bit_width(n_vertices)), 9, 13)),
      mixer_(n_nodes, n_nodes * 3 * n_levels),
      curve_(n_nodes * 3) {
    static_assert(n_contexts + Expectation::n_distributions + n_values == initial_weights[0].size());
    for (size_t node = 0; node < n_nodes; ++node) {
        const size_t kind = node == side_node ? 0 : node < digit_node ? 1 : std::min<size_t>(2 + (node - digit_node) / 4, 4);
        mixer_.start(node, initial_weights[kind]);
    }
    for (auto& lines : lines_) lines.resize(size_t{1} << log2_lines_);
}

void ResidualModel::start(const Expectation& x) {
    for (size_t i = 0; i < n_contexts; ++i) {
        line_[i] = &lines_[i][x.context[i] >> (32 - log2_lines_)];
        __builtin_prefetch(line_[i], 1);
        __builtin_prefetch(&line_[i]->counters[n_slots / 2 + 1], 1);
    }
    for (size_t i = 0; i < n_distribution_lanes; ++i) {
        const Lanes scale = {x.scale[4 * i], x.scale[4 * i + 1], x.scale[4 * i + 2], x.scale[4 * i + 3]};
        sharpness_[i] = log2_e / scale;
        from_low_[i] = splat(1.0f);
        from_high_[i] = splat(0.0f);
    }
    // Among distances of the negative side, e < 0 is "at least 0".
    mirror(x, true);
    alive_ = 0;
    for (unsigned rest = x.values; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(rest));
        const Counter& c = hits_[i][x.value_context[i]];
        if (c.p16() >= min_hits) alive_ |= 1u << i;
    }
    enter_split(0);
    for (size_t i = 0; i < n_contexts; ++i)
        if (line_[i]->tag != x.context[i]) line_[i]->reset(x.context[i]);
}

void ResidualModel::mirror(const Expectation& x, bool negative) {
    negative_ = negative;
    for (size_t i = 0; i < n_distribution_lanes; ++i) {
        const Lanes mean = {x.mean[4 * i], x.mean[4 * i + 1], x.mean[4 * i + 2], x.mean[4 * i + 3]};
        mean_[i] = negative ? -1.0f - mean : mean;
    }
    for (size_t i = 0; i < n_values; ++i) value_[i] = negative ? -1 - x.value[i] : x.value[i];
}

void ResidualModel::take_side(const Expectation& x, bool negative) {
    alive_ = negative ? upper_ : alive_ & ~upper_;
    if (negative) {
        from_low_ = from_at_;
    } else {
        mirror(x, false);
        tails(0, from_low_);
    }
    low_ = 0;
}

void ResidualModel::tails(int64_t at, Tails& out) const {
    const float edge = static_cast<float>(at) - 0.5f;
    for (size_t i = 0; i < n_distribution_lanes; ++i)
        out[i] = squash(max(min((mean_[i] - edge) * sharpness_[i], splat(80.0f)), splat(-80.0f)));
}

void ResidualModel::enter_split(int64_t at) {
    tails(at, from_at_);
    constexpr Lanes tiny = {1e-30f, 1e-30f, 1e-30f, 1e-30f};
    for (size_t i = 0; i < n_distribution_lanes; ++i) {
        const Lanes upper = max(from_at_[i] - from_high_[i], tiny), lower = max(from_low_[i] - from_at_[i], tiny);
        const Lanes odds = log2_approx(upper) - log2_approx(lower);
        inputs_[n_contexts / 4 + i] = max(min(odds, splat(max_logit)), splat(-max_logit));
    }
    upper_ = 0;
    for (unsigned rest = alive_; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(rest));
        if (value_[i] >= at) upper_ |= 1u << i;
    }
}

void ResidualModel::leave_split(int64_t at, bool upper) {
    if (upper) {
        low_ = at;
        from_low_ = from_at_;
        alive_ = upper_;
    } else {
        from_high_ = from_at_;
        alive_ &= ~upper_;
    }
}

void ResidualModel::learn_hits(const Expectation& x, int64_t e) {
    for (unsigned rest = x.values; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(rest));
        hits_[i][x.value_context[i]].update(x.value[i] == e, 16384);
    }
}

uint32_t ResidualModel::predict(const Expectation& x, size_t node, size_t slot) {
    node_ = node;
    slot_ = slot;
    if (slot < n_slots) {
        for (size_t i = 0; i < n_contexts / 4; ++i) {
            const auto at = [&](size_t k) { return static_cast<int32_t>(line_[4 * i + k]->counters[slot]); };
            states_[i] = IntLanes{at(0), at(1), at(2), at(3)};
            inputs_[i] = counter::opinion(states_[i]);
        }
    } else {
        for (size_t i = 0; i < n_contexts / 4; ++i) inputs_[i] = Lanes{};
    }
    Lanes* const values = &inputs_[n_contexts / 4 + n_distribution_lanes];
    for (size_t i = 0; i < n_values / 4; ++i) values[i] = Lanes{};
    for (unsigned rest = alive_; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(rest));
        const Counter& c = value_counters_[i][x.value_context[i]][node];
        const float agrees = c.n() == 0 ? 0.0f : logits[c.p16() >> 4];
        values[i / 4][i % 4] = (upper_ >> i & 1) != 0 ? agrees : -agrees;
    }
    values[n_values / 4] = Lanes{0.4f, 0, 0, 0};
    const size_t set = node * 3 + x.turn;
    const float logit = mixer_.mix(inputs_, node, set * n_levels + static_cast<size_t>(x.level));
    p_ = squash(logit);
    const float refined = curve_.refine(logit, set);
    const float q = p_ + 0.35f * (refined - p_);
    p16_ = static_cast<uint32_t>(std::clamp(static_cast<int32_t>(q * 65536.0f), 1, 65535));
    return p16_;
}

void ResidualModel::learn(const Expectation& x, bool bit) {
    const float target = bit ? 1.0f : 0.0f;
    n_decisions_ += 1.0f;
    const float rate = 0.0021f * (1.0f + 4.0f / (1.0f + n_decisions_ * (1.0f / 10000.0f)));
    mixer_.update(inputs_, (target - p_) * rate);
    curve_.update(target, 0.02f);
    if (slot_ < n_slots) {
        const float expected = static_cast<float>(p16_ << 6);
        for (size_t i = 0; i < n_contexts / 4; ++i) {
            const IntLanes next = counter::updated(states_[i], bit, expected);
            for (size_t k = 0; k < 4; ++k) line_[4 * i + k]->counters[slot_] = static_cast<CounterState>(next[k]);
        }
    }
    for (unsigned rest = alive_; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(rest));
        value_counters_[i][x.value_context[i]][node_].update(bit == ((upper_ >> i & 1) != 0), 49152);
    }
}

}  // namespace ebz::positions
