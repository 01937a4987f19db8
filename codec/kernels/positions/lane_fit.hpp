// Online least squares of several axes together, with forgetting, a prior, and solutions at growing intervals.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "lanes.hpp"
#include "least_squares.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Each lane but the last is an observation, with the same weights w for all; 0 counts for nothing.
template <size_t D>
class LaneFit {
public:
    using Inputs = std::array<Lanes, D>;

    explicit LaneFit(const std::array<float, D>& prior) : a_{}, b_{}, w_(prior), prior_(prior) {}

    Lanes predict(const Inputs& x) const {
        Lanes sum = x[0] * w_[0];
        for (size_t i = 1; i < D; ++i) sum += x[i] * w_[i];
        return sum;
    }

    // Solves after 1, 2, 3, 4, 5, ... of them.
    void add(const Inputs& x, Lanes y, float weight) {
        for (size_t i = 0; i < D; ++i) {
            const Lanes wx = x[i] * weight;
            for (size_t j = 0; j <= i; ++j) a_[i][j] += wx * x[j];
            b_[i] += wx * y;
        }
        if (++n_ < due_) return;
        solve();
        due_ = n_ + least_squares_interval(n_);
        if (n_ >= 128) forget();
    }

private:
    static constexpr double ridge = 50, largest = 1e4;

    void forget() {
        constexpr float keep = 1 - 32.0f / 2000;
        for (Inputs& row : a_)
            for (Lanes& x : row) x *= keep;
        for (Lanes& x : b_) x *= keep;
    }

    static double over_axes(Lanes x) { return (double{x[0]} + double{x[1]}) + double{x[2]}; }

    void solve() {
        std::array<std::array<double, D>, D> a{};
        std::array<double, D> b, prior;
        for (size_t i = 0; i < D; ++i) {
            for (size_t j = 0; j <= i; ++j) a[i][j] = over_axes(a_[i][j]);
            b[i] = over_axes(b_[i]);
            prior[i] = double{prior_[i]};
        }
        const std::array<double, D> w = ridge_solution(a, b, prior, ridge);
        for (size_t i = 0; i < D; ++i) w_[i] = static_cast<float>(std::clamp(w[i], -largest, largest));
    }

    std::array<Inputs, D> a_;
    Inputs b_;
    std::array<float, D> w_, prior_;
    int n_ = 0, due_ = 1;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
