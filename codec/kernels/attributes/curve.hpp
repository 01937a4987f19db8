// Secondary estimation: what a logit was worth in a context.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../positions/float_logistic.hpp"

namespace ebz::attributes {

using positions::clamp;
using positions::squash;

// A curve of 33 knots over the logit per context, adapted to what happened.
class Curve {
public:
    explicit Curve(size_t n_contexts) : knots_(n_contexts) {
        for (auto& curve : knots_)
            for (size_t j = 0; j < n_knots; ++j) curve[j] = squash((static_cast<float>(j) - 16.0f) * 0.75f);
    }

    float refine(float logit, size_t context) {
        const float at = clamp(logit, -11.9f, 11.9f) * (1.0f / 0.75f) + 16.0f;
        const int32_t whole = static_cast<int32_t>(at);
        knot_ = &knots_[context][static_cast<size_t>(whole)];
        part_ = at - static_cast<float>(whole);
        return knot_[0] + (knot_[1] - knot_[0]) * part_;
    }

    void update(float bit, float rate) {
        knot_[0] += (bit - knot_[0]) * rate * (1.0f - part_);
        knot_[1] += (bit - knot_[1]) * rate * part_;
    }

private:
    static constexpr size_t n_knots = 33;
    std::vector<std::array<float, n_knots>> knots_;
    float* knot_ = nullptr;
    float part_ = 0;
};

}  // namespace ebz::attributes
