// How a value changes from place to place: inputs of a linear fit, on the scale of the values.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace ebz::attributes {

class Gradient {
public:
    static constexpr size_t n_inputs = 3;
    using Place = std::array<double, n_inputs>;

    // away: of an item from the mean of its neighbours.
    Place inputs(const Place& away) const { return {gain_ * away[0], gain_ * away[1], gain_ * away[2]}; }

    // off: how far its value was from their mean.  The first ones tell the scale, which then stays.
    void learn(const Place& away, double off) {
        if (n_seen_ == n_trials) return;
        values_ += off;
        for (const double x : away) places_ += std::abs(x);
        if (++n_seen_ == n_trials && places_ > 1e-100) gain_ = 2 * values_ / places_;
    }

private:
    static constexpr size_t n_trials = 16;

    double gain_ = 0, values_ = 0, places_ = 0;
    size_t n_seen_ = 0;
};

}  // namespace ebz::attributes
