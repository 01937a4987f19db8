// From the prediction of a vertex to what is expected of each coordinate, given those coded before it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "expectation.hpp"
#include "prediction.hpp"
#include "recall.hpp"
#include "surroundings.hpp"
#include "wrapping.hpp"

namespace ebz::positions {

// The three axes of one vertex, in the order p.axes.
class Axes {
public:
    explicit Axes(const Predictor& predictor) : predictor_(predictor) {}

    void begin(const Surroundings& s, const Prediction& p);
    void find_contexts(size_t turn, Expectation& x);
    void expect(size_t turn, Expectation& x);  // after find_contexts
    void reveal(size_t turn, int64_t residual);

    int64_t base(size_t d) const { return wrapping_sum(s_->origin[d], base_[d]); }
    const Offset& residuals() const { return residual_; }

private:
    // Offsets from the base at which the value would equal a neighbour's: the nearest two.
    struct Nearest {
        int64_t first, second;
        bool has_second;
    };

    void set_distributions(size_t d, Expectation& x) const;
    void set_sizes(size_t d, Expectation& x) const;
    Nearest nearest(size_t d) const;
    void set_values(size_t turn, Expectation& x);
    void set_recalled(size_t turn, Expectation& x);
    void set_keys(size_t turn);
    void set_contexts(size_t turn, Expectation& x) const;
    uint32_t agreement(size_t turn, const Offset& at) const;
    uint32_t exactness(size_t d) const;
    uint32_t codes(size_t neighbour) const;
    int64_t value(size_t d) const { return wrapping_sum(s_->origin[d], value_[d]); }

    const Predictor& predictor_;
    const Surroundings* s_ = nullptr;
    const Prediction* p_ = nullptr;
    Recall residual_recall_{14}, value_recall_{14};
    uint32_t residual_key_ = 0, value_key_ = 0;

    Point plain_mean_{}, refined_mean_{};  // shifted by what earlier axes revealed
    std::array<std::array<double, 3>, 3> covariance_{};
    Nearest nearest_{};
    Offset base_{}, residual_{}, value_{};  // base and value are relative to the surroundings' origin
    int64_t first_residual_ = 0, last_residual_ = 0;
};

}  // namespace ebz::positions
