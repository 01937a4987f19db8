// How residuals lie to the tangent plane: on it, two coordinates tell the third.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "int_lanes.hpp"
#include "lane_fit.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

class TangentPlane {
public:
    using Fit = LaneFit<3>;

    TangentPlane() : fits_{Fit(prior), Fit(prior), Fit(prior), Fit(prior)} {}

    // normal: of any length.  Gives what is to be added to a prediction, for its part along the normal to be fitted on its own.
    Lanes fit(Lanes normal, const Fit::Inputs& inputs, Lanes predicted, size_t n_tips) {
        const float square = dot(normal, normal);
        exists_ = square > 0;
        if (!exists_) return Lanes{};
        normal_ = normal * (1.0f / std::sqrt(square));
        const Lanes across = magnitudes(normal_);
        last_ = across[0] > across[1] ? (across[0] > across[2] ? 0 : 2) : (across[1] > across[2] ? 1 : 2);
        for (size_t i = 0; i < inputs.size(); ++i) heights_[i] = Lanes{dot(inputs[i], normal_), 0, 0, 0};
        fit_ = &fits_[n_tips - 1];
        return normal_ * (fit_->predict(heights_)[0] - dot(predicted, normal_));
    }

    bool exists() const { return exists_; }

    // The axis nearest to the normal: by then the others tell most about it.
    size_t last() const { return last_; }

    // residual: of the other axes, from the prediction.  The change of the last one that is expected then.
    float slide(Lanes residual) {
        residual[static_cast<int>(last_)] = 0;
        const float across = normal_[last_];
        // Of residuals: how much wider they are along the plane.
        const float wider = across * across * std::max(3.0f * along_energy_ / across_energy_ - 1.0f, 0.0f);
        slid_ = -wider / (1.0f + wider) * (dot(residual, normal_) / across);
        return gain_with_ < gain_without_ ? slid_ : 0.0f;
    }

    // residual: of all axes, from the prediction; moved: from where the fits begin.
    void learn(Lanes residual, Lanes moved, float weight) {
        const float without = std::abs(residual[last_]), with = std::abs(residual[last_] - slid_);
        const float scale = 0.005f / (1.0f + with + without);
        gain_with_ += with * scale - gain_with_ * 0.005f;
        gain_without_ += without * scale - gain_without_ * 0.005f;
        const float height = dot(residual, normal_), share = height * height / (dot(residual, residual) + 0.1f);
        across_energy_ += (share + 0.001f - across_energy_) * 0.02f;
        along_energy_ += ((1.0f - share) * 0.5f + 0.01f - along_energy_) * 0.02f;
        fit_->add(heights_, Lanes{dot(moved, normal_), 0, 0, 0}, weight);
    }

private:
    static constexpr std::array<float, 3> prior = {0.0f, 0.5f, 0.1f};

    std::array<Fit, 4> fits_;
    float along_energy_ = 4, across_energy_ = 1, gain_with_ = 1, gain_without_ = 1;

    // Of the vertex under way.
    Lanes normal_{};
    Fit::Inputs heights_{};
    Fit* fit_ = nullptr;
    size_t last_ = 2;
    float slid_ = 0;
    bool exists_ = false;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
