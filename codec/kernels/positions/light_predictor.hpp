// Where a vertex is expected: the mean of its parallelograms or what least squares make of its surroundings.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "int_lanes.hpp"
#include "lane_fit.hpp"
#include "light_survey.hpp"
#include "tangent_plane.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// What is known of the coordinates of a vertex, per axis.  A cell is 2^shift residuals.
template <class Unsigned>
struct LightExpectation {
    using Ints = std::array<int32_t, 4>;

    typename Integers<Unsigned>::Lanes base;  // what residuals are from
    alignas(16) Ints shift;
    Ints level;     // half-octaves of their likely size, in cells
    Ints spread;    // the same of what predicts them
    Ints near;      // the residual that would repeat a neighbour's value, in cells
    Ints fraction;  // the prediction in fractions of cells
    Ints tip;       // the second tip, in cells
    bool plain[3];  // whether the base is the mean of tips
};

template <class Unsigned>
class LightPredictor {
public:
    using Surroundings = LightSurroundings<Unsigned>;
    using Expectation = LightExpectation<Unsigned>;
    using Position = typename Surroundings::Position;
    static constexpr size_t n_levels = 14, n_spreads = 18, n_places = 15;

    LightPredictor() : fits_{Fit(prior), Fit(prior), Fit(prior), Fit(prior)} {}

    // s stays as it is until the vertex has been learnt.
    void predict(const Surroundings& s, bool slides) {
        s_ = &s;
        const float share = 1.0f / static_cast<float>(s.n_tips), each = 1.0f / static_cast<float>(s.n_neighbours);
        plain_ = limited(s.tips * share);
        inputs_ = {s.ahead * (0.5f * share), s.neighbours * each - plain_, s.drift * each};
        const size_t n_tips = std::min<size_t>(s.n_tips, fits_.size());
        fit_ = &fits_[n_tips - 1];
        Lanes moved = fit_->predict(inputs_);
        if (slides) moved += plane_.fit(s.normal, inputs_, moved, n_tips);
        slides_ = slides && plane_.exists();
        last_ = slides_ ? masks[plane_.last()] : IntLanes{};
        refined_ = expected_ = limited(plain_ + limited(moved));
        measure(s.size * each, s.n_tips > 1 ? s.spread * (1.0f / static_cast<float>(s.n_tips - 1)) : s.size * each);
    }

    // The axis to be coded last, if the others tell of it, else `otherwise`.
    size_t last(size_t otherwise) const { return slides_ ? plane_.last() : otherwise; }

    // position: with all axes but the last.  Whether that changes what is expected.
    bool slide(Position position) {
        if (!slides_) return false;
        const float by = plane_.slide(as_floats(position - s_->first) - refined_);
        expected_ = choose(last_, limited(refined_ + by), refined_);
        return by != 0;
    }

    void expect(Expectation& x) const {
        const IntLanes is_plain = choose(last_, leads_[1], leads_[0]) <= 0.0f;
        const IntLanes off = choose(is_plain, rounded(plain_), rounded(expected_));
        x.base = s_->first + widened(off);
        const Lanes at = __builtin_convertvector(off, Lanes);
        const Lanes fine = cells_ * choose(is_plain, splat<Lanes>(2.0f), splat<Lanes>(4.0f));
        x.near = ints(truncated(clamp(nearest(x.base) * cells_, -7.0f, 7.0f) + 7.5f));
        x.fraction = ints(fifteenths((expected_ - at) * fine));
        x.tip = ints(fifteenths(as_floats(s_->second - x.base) * cells_));
        x.level = ints(level_);
        x.spread = ints(spread_);
        x.shift = ints(shift_);
        for (size_t d = 0; d < 3; ++d) x.plain[d] = is_plain[d] != 0;
    }

    void learn(Position position) {
        const Lanes x = as_floats(position - s_->first), moved = x - plain_;
        const Lanes gain = bit_patterns(magnitudes(moved) + 1.0f) - bit_patterns(magnitudes(x - expected_) + 1.0f);
        leads_[0] += choose(last_, Lanes{}, gain - leads_[0]) * 0.01f;
        leads_[1] += choose(last_, gain - leads_[1], Lanes{}) * 0.01f;
        const float weight = 9.0f / (1.0f + dot(inputs_[0], inputs_[0]));
        if (slides_) plane_.learn(x - refined_, moved, weight);
        fit_->add(inputs_, moved, weight);
    }

private:
    using Fit = LaneFit<3>;
    static constexpr std::array<float, 3> prior = {-0.1f, 0.4f, 0.1f};
    static constexpr std::array<IntLanes, 3> masks = {IntLanes{-1, 0, 0, 0}, IntLanes{0, -1, 0, 0}, IntLanes{0, 0, -1, 0}};

    // So that sums of two can be rounded.
    static Lanes limited(Lanes x) { return clamp(x, -0x1p29f, 0x1p29f); }
    static std::array<int32_t, 4> ints(IntLanes x) { return std::bit_cast<std::array<int32_t, 4>>(x); }
    static IntLanes fifteenths(Lanes x) { return truncated(clamp(x, -7.5f, 6.5f) + 7.5f); }
    static Position widened(IntLanes x) {
        if constexpr (sizeof(Unsigned) == sizeof(uint32_t)) return as_uints(x);
        else return __builtin_convertvector(x, Position);
    }

    void measure(Lanes size, Lanes spread) {
        const Lanes of_size = choose(last_, splat<Lanes>(0.75f), splat<Lanes>(0.6f)), of_spread = choose(last_, splat<Lanes>(0.1f), splat<Lanes>(0.25f));
        const IntLanes octaves = half_octaves(size * of_size + spread * of_spread), above = octaves - 12;
        shift_ = (above & (above > 0)) >> 1;
        level_ = octaves - 2 * shift_;
        constexpr int most = n_spreads - 1;
        const IntLanes wide = half_octaves(spread) - 2 * shift_, positive = wide & (wide > 0);
        spread_ = choose(positive < most, positive, IntLanes{most, most, most, most});
        cells_ = reinterpret_cast<Lanes>((127 - shift_) << 23);  // 2^-shift
    }

    // The least residuals that would repeat neighbours' values.
    Lanes nearest(Position base) const {
        Lanes nearest = as_floats(s_->neighbour_at[0] - base);
        for (size_t i = 1; i < s_->n_kept_neighbours(); ++i) {
            const Lanes other = as_floats(s_->neighbour_at[i] - base);
            nearest = choose(magnitudes(other) < magnitudes(nearest), other, nearest);
        }
        return nearest;
    }

    std::array<Fit, 4> fits_;
    TangentPlane plane_;
    std::array<Lanes, 2> leads_{};  // of the expected position over the plain one; the second of last axes

    // Of the vertex under way, relative to the first tip.
    const Surroundings* s_ = nullptr;
    Fit* fit_ = nullptr;
    Fit::Inputs inputs_{};
    Lanes plain_{}, refined_{}, expected_{}, cells_{};
    IntLanes last_{}, shift_{}, level_{}, spread_{};
    bool slides_ = false;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
