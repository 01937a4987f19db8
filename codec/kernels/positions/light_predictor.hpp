// Where a vertex is expected: the mean of its parallelograms, exact where coordinates repeat, or what
// least squares make of its surroundings; the last axis along the tangent plane.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "float_logistic.hpp"
#include "lanes.hpp"
#include "least_squares.hpp"
#include "light_survey.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Half-octaves: 1 gives 6, at most 90.
inline int half_octaves(float x) {
    return static_cast<int>(clamp(log2_approx(x + 0.125f) * 2.0f + 6.0f, 0.0f, 90.0f));
}

class LightPredictor {
public:
    static constexpr size_t n_sets = 15;

    LightPredictor() { fits_.fill(Fit({-0.1, 0.4, 0.1, -0.1, 0.5}, 50.0, 2000)); }

    // s has a neighbour and stays as it is until the vertex has been learnt.
    void predict(const LightSurroundings& s) {
        s_ = &s;
        const int n = s.n_parallelograms;
        plain_ = refined_ = n > 0 ? s.tips_sum * (1.0 / n) : s.neighbours[0];
        if (n > 0) refine(s);
        order_axes(s.normal);
        square_ = dot(s.normal, s.normal);
        const Lanes size = s.size[3] > 0 ? s.size * (1.0f / s.size[3]) : splat<Lanes>(4.0f);
        spread_ = n > 1 ? __builtin_convertvector(s.spread, Lanes) * (1.0f / static_cast<float>(n - 1)) : size;
        scales_ = {size * 0.6f + spread_ * 0.25f, size * 0.75f + spread_ * 0.1f};
        trace_ = {};
        trace_.size[3] = 1;
    }

    size_t axis(size_t turn) const { return axes_[turn]; }
    int64_t base() const { return base_; }
    bool is_plain() const { return is_plain_; }
    int level() const { return level_; }
    int wide(int shift) const { return std::clamp(half_octaves(spread_[axis_]) - 2 * shift, 0, 17); }
    double plain() const { return plain_[axis_]; }
    double expected() const { return expected_; }
    double value(size_t d) const { return value_[d]; }
    size_t set(size_t turn) const { return 5 * turn + static_cast<size_t>(std::min(s_->n_parallelograms, 4)); }

    void expect(size_t turn) {
        axis_ = axes_[turn];
        expected_ = refined_[axis_];
        slides_ = turn == 2 && square_ > 0;
        if (slides_) slide();
        level_ = half_octaves(scales_[turn == 2][axis_]);
        const int64_t plain_base = rounded(plain_[axis_]);
        is_plain_ = true;
        {
            const Costs& costs = costs_[turn == 2][axis_];
            is_plain_ = costs.plain <= costs.expected;
        }
        base_ = is_plain_ ? plain_base : rounded(expected_);
    }

    // exact: whether the value was told as one that had been met.
    void reveal(size_t turn, int64_t position, int64_t e, bool exact) {
        const auto value = static_cast<double>(position);
        value_[axis_] = value;
        {
            Costs& costs = costs_[turn == 2][axis_];
            costs.plain += (cost(value - plain_[axis_]) - costs.plain) * 0.01f;
            costs.expected += (cost(value - expected_) - costs.expected) * 0.01f;
        }
        if (slides_) judge_slide(value);
        trace_.size[axis_] = static_cast<float>(magnitude(e));
        trace_.exact |= (exact || e == 0 ? 1u : 0u) << (8 * axis_);
        trace_.residuals |= static_cast<uint32_t>(std::clamp<int64_t>(e, -100, 100) + 128) << (8 * axis_);
    }

    LightTrace learn() {
        const Axes4 r = value_ - refined_;
        if (square_ > 0) {
            const double along = dot(r, s_->normal), energy = dot(r, r) + 0.1;
            const auto share = static_cast<float>(along * along / (square_ * energy));  // across the plane
            normal_energy_ += (share + 0.01f - normal_energy_) * 0.02f;
            tangent_energy_ += ((1.0f - share) * 0.5f + 0.01f - tangent_energy_) * 0.02f;
        }
        const Axes4 off = value_ - plain_;
        if (s_->n_parallelograms > 0) {
            const double weight = 9.0 / (1.0 + dot(inputs_[0], inputs_[0]));
            for (size_t d = 0; d < 3; ++d) fit_->add(inputs_of(d), off[d], weight);
            fit_->tick();
            trace_.residual = __builtin_convertvector(off, Lanes);
        }
        return trace_;
    }

private:
    static constexpr double fixed_share = 0.4;
    static constexpr size_t n_inputs = 5, n_fits = 16;
    using Fit = LeastSquares<n_inputs>;

    struct Costs {
        float plain = 0, expected = 0;  // bits, about
    };

    static float cost(double residual) { return log2_approx(1.0f + std::fabs(static_cast<float>(residual))); }

    void refine(const LightSurroundings& s) {
        const double share = 1.0 / s.n_parallelograms;
        const double traced = 1.0 / std::max(1.0, static_cast<double>(s.size[3]));
        inputs_ = {s.ahead * share, s.neighbours_sum * (1.0 / s.n_neighbours) - plain_,
                   __builtin_convertvector(s.drift, Axes4) * traced, s.behind * (1.0 / std::max(1, s.n_behind)),
                   s.beside * (1.0 / std::max(1, s.n_beside))};
        const int known = (s.n_behind > 0 ? 1 : 0) + (s.n_beside > 0 ? 2 : 0);
        fit_ = &fits_[static_cast<size_t>(4 * (std::min(s.n_parallelograms, 4) - 1) + known)];
        for (size_t d = 0; d < 3; ++d) refined_[d] += fit_->predict(inputs_of(d));
    }

    Fit::Vector inputs_of(size_t d) const {
        return {inputs_[0][d], inputs_[1][d], inputs_[2][d], inputs_[3][d], inputs_[4][d]};
    }

    // The axis nearest to the normal last: by then the others tell most about it.
    void order_axes(Axes4 normal) {
        const Axes4 length = magnitudes(normal);
        axes_ = {0, 1, 2};
        const auto swap_if = [&](size_t i, size_t j) {
            if (length[axes_[i]] > length[axes_[j]]) std::swap(axes_[i], axes_[j]);
        };
        swap_if(0, 1);
        swap_if(1, 2);
        swap_if(0, 1);
    }

    // On a plane the first two residuals tell the third; `wider` is how much wider they are along it.
    void slide() {
        const size_t i = axes_[0], j = axes_[1];
        const Axes4 n = s_->normal;
        const double along = n[i] * (value_[i] - refined_[i]) + n[j] * (value_[j] - refined_[j]);
        const double wider = std::max(tangent_energy_ / normal_energy_ - 1.0f, 0.0f);
        slid_ = expected_ - wider * n[axis_] * along / (square_ + wider * n[axis_] * n[axis_]);
        if (gain_with_ < gain_without_) expected_ = slid_;
    }

    void judge_slide(double value) {
        const auto with = std::fabs(static_cast<float>(value - slid_)), without = std::fabs(static_cast<float>(value - refined_[axis_]));
        const float scale = 1.0f / (1.0f + with + without);
        gain_with_ += (with * scale - gain_with_) * 0.005f;
        gain_without_ += (without * scale - gain_without_) * 0.005f;
    }

    const LightSurroundings* s_ = nullptr;
    std::array<Fit, n_fits> fits_;
    Fit* fit_ = nullptr;

    // Of the vertex under way.
    Axes4 plain_{}, refined_{}, value_{};
    std::array<Axes4, n_inputs> inputs_{};
    std::array<size_t, 3> axes_{};
    double square_ = 0;
    Lanes spread_{};
    std::array<Lanes, 2> scales_{};
    LightTrace trace_;

    // Of the axis under way.
    size_t axis_ = 0;
    double expected_ = 0, slid_ = 0;
    int64_t base_ = 0;
    int level_ = 0;
    bool is_plain_ = true, slides_ = false;

    std::array<std::array<Costs, 3>, 2> costs_{};
    float tangent_energy_ = 4, normal_energy_ = 1, gain_with_ = 1, gain_without_ = 1;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
