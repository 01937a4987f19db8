// From the known items around an item to what is expected of each of its components.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../positions/least_squares.hpp"
#include "../positions/wrapping.hpp"
#include "attributes.hpp"
#include "candidates.hpp"
#include "gradient.hpp"
#include "neighbourhood.hpp"
#include "number_model.hpp"

namespace ebz::attributes {

using positions::wrapping_difference;
using positions::wrapping_sum;

template <class S>
class Predictor {
public:
    // corners: none where items are no vertices.
    Predictor(const Items& items, const Coding& coding, std::span<const int64_t> values,
              const positions::CornersOfVertices* corners)
        : n_components_(items.n_components),
          candidates_(items, coding, values, corners),
          size_(values.size(), -1.0f),
          turns_(std::min(items.n_components, max_turns)) {}

    // The item under way.
    void begin(int32_t v, const Neighbourhood& around) {
        item_ = v;
        around_ = &around;
        candidates_.begin(v, around);
    }

    // The component coded at a turn.
    size_t component(size_t turn) const { return candidates_.component(turn); }

    int64_t base() const { return base_; }

    void expect(size_t turn, Expectation& x) {
        const size_t c = component(turn);
        Turn& t = turns_[std::min(turn, max_turns - 1)];
        candidates_.gather(turn);
        set_features(turn);
        candidates_.put_fitted(candidates_.mean() + t.fit.predict(features_));
        scales(c, turn, t);
        choose_base();
        describe(turn, t, x);
    }

    void reveal(size_t turn, int64_t value) {
        Turn& t = turns_[std::min(turn, max_turns - 1)];
        const size_t c = component(turn);
        const double actual = S::value(value);
        const double weight = 1 / (local_ * local_ + 1e-4 * unit_ * unit_ + 1e-300);
        if (std::abs(actual) < 1e150 && usable_) t.fit.add(features_, actual - candidates_.mean(), weight), t.fit.tick();
        if (candidates_.has_gradient()) t.gradient.learn(candidates_.away(), distance(actual, candidates_.mean()));
        unsigned hit = 0;
        for (size_t k = 0; k < n_candidates; ++k) {
            if (!candidates_.has(k)) continue;
            const double error = distance(actual, candidates_.expected(k)) / (candidates_.is_implied(k) ? candidates_.spread() : norm_);
            t.error[k] += (error - t.error[k]) * rate(t.n_seen[k]);
            if (candidates_.integer(k) == value) hit |= 1u << k;
        }
        for (size_t k = 0; k < n_candidates; ++k)
            t.history[k] = static_cast<uint8_t>((t.history[k] << 1 | (hit >> k & 1)) & 7);
        hits_ = hit;
        deviation_[turn % kept] = actual - candidates_.mean();
        steepness_[turn % kept] = candidates_.expected(Kind::parallelogram) - candidates_.mean();
        difference_[turn % kept] = wrapping_difference(value, base_);
        size_[at(item_, c)] = static_cast<float>(std::min(distance(actual, S::value(base_)) / norm_, 1e30));
        t.last = difference_[turn % kept];
        candidates_.reveal(value);
    }

    void end() { candidates_.end(); }

private:
    using Kind = Candidates<S>;
    static constexpr size_t max_turns = 64, kept = 4, n_differences = 11, n_features = n_differences + Gradient::n_inputs;
    using Fit = positions::LeastSquares<n_features>;

    struct Turn {
        Fit fit{{0.6, 0, 0, 0.5, 0.5}, 3.0, 3000};
        Gradient gradient;
        std::array<double, n_candidates> error{};
        std::array<uint16_t, n_candidates> n_seen{};
        std::array<uint8_t, n_candidates> history{};
        int64_t last = 0;
    };

    size_t at(int32_t item, size_t c) const { return static_cast<size_t>(item) * n_components_ + c; }

    static double distance(double a, double b) {
        const double d = std::abs(a - b);
        return d < 1e150 ? d : 1e150;
    }

    static double rate(uint16_t& n) {
        n = static_cast<uint16_t>(std::min(n + 1, 40));
        return 1.0 / n;
    }

    void set_features(size_t turn) {
        const auto difference = [&](size_t k) { return candidates_.has(k) ? candidates_.expected(k) - candidates_.mean() : 0.0; };
        const double third = candidates_.has_guess() ? candidates_.guess_error_around(component(turn)) : difference(Kind::second);
        features_ = {difference(Kind::parallelogram), difference(Kind::near), third, difference(Kind::guess), difference(Kind::implied)};
        for (size_t back = 1; back <= 3 && back <= turn; ++back) features_[4 + back] = deviation_[(turn - back) % kept];
        for (size_t back = 1; back <= 3 && back <= turn; ++back) features_[7 + back] = steepness_[(turn - back) % kept];
        const auto by_place = turns_[std::min(turn, max_turns - 1)].gradient.inputs(candidates_.away());
        std::copy(by_place.begin(), by_place.end(), features_.begin() + n_differences);
        usable_ = true;
        for (double& x : features_) {
            if (!(std::abs(x) < 1e150)) usable_ = false;
        }
        if (!usable_) features_.fill(0);
    }

    // How far off each candidate may be.
    void scales(size_t c, size_t turn, const Turn& t) {
        norm_ = candidates_.extent(turn);
        double sum = 0;
        int n = 0;
        for (size_t i = 0; i < around_->n_neighbours; ++i) {
            sum += size_[at(around_->neighbours[i], c)];
            ++n;
        }
        const double typical = t.n_seen[Kind::fitted] > 0 ? t.error[Kind::fitted] : 1.0;
        local_ = (n > 0 ? (sum + typical) / (n + 1) : typical) * norm_;
        for (size_t k = 0; k < n_candidates; ++k) {
            if (!candidates_.has(k)) continue;
            const double ratio = t.n_seen[k] > 0 ? t.error[k] / std::max(typical, 1e-300) : 1.0;
            scale_[k] = candidates_.is_implied(k) ? t.error[k] * candidates_.spread() : local_ * std::min(ratio, 1e6);
        }
    }

    // The candidate that is likely to be nearest.
    void choose_base() {
        size_t best = Kind::fitted;
        for (size_t k = 0; k < n_candidates; ++k)
            if (candidates_.has(k) && scale_[k] < 0.8 * scale_[best]) best = k;
        base_ = candidates_.integer(best);
        unit_ = S::unit(std::max(std::abs(S::value(base_)), std::min(scale_[best], 1e30)));
        best_scale_ = scale_[best] / unit_;
    }

    // NaN gives the lower limit.
    static double limited(double x, double low, double high) { return x > low ? (x < high ? x : high) : low; }

    static int size_class(double x) {
        return std::bit_width(static_cast<uint64_t>(limited(x, 0.0, 1e15)));
    }
    static uint32_t signed_class(int64_t x) {
        const int n = std::bit_width(positions::magnitude(x));
        return n < 3 ? static_cast<uint32_t>(x + 8) : static_cast<uint32_t>(x < 0 ? 100 - n : 100 + n);
    }

    void describe(size_t turn, const Turn& t, Expectation& x) {
        x.candidates = candidates_.all();
        for (size_t k = 0; k < n_candidates; ++k) {
            x.offset[k] = wrapping_difference(candidates_.integer(k), base_);
            x.mean[k] = static_cast<float>(limited(S::offset(candidates_.expected(k), base_), -1e18, 1e18));
            x.scale[k] = static_cast<float>(limited(0.6 * scale_[k] / unit_, 0.08, 1e18));
            const unsigned before = turn == 0 ? 0 : 1 + (hits_ >> k & 1);
            x.value_context[k] = static_cast<uint8_t>(before * 8 + t.history[k]);
        }
        const uint32_t n_recalls = candidates_.n_recalls();
        if (n_recalls > 0) x.value_context[Kind::last] = static_cast<uint8_t>(23 + std::min<uint32_t>(n_recalls, 8));
        x.turn = turn;
        x.expected_class = std::min(size_class(best_scale_), 56);
        x.level = static_cast<size_t>(std::min(size_class(best_scale_ * 2), static_cast<int>(Decision::n_levels) - 1));
        set_contexts(turn, t, x);
    }

    void set_contexts(size_t turn, const Turn& t, Expectation& x) const {
        const auto off = [&](size_t k) { return candidates_.has(k) ? wrapping_difference(candidates_.integer(k), base_) : INT64_MAX; };
        const auto coarse = [&](size_t k) { return signed_class(off(k)); };
        const int64_t e1 = turn > 0 ? difference_[(turn - 1) % kept] : 0, e2 = turn > 1 ? difference_[(turn - 2) % kept] : 0;
        const uint64_t c = std::min<uint64_t>(turn, 255) << 8 | static_cast<uint64_t>(x.expected_class);
        const auto fine = static_cast<uint64_t>(std::min(size_class(best_scale_ * 8), 60));
        const auto apart = static_cast<uint64_t>(std::min(size_class(candidates_.disagreement() / unit_), 60));
        const auto key = [&](uint64_t i, uint64_t a, uint64_t b) { return hash(i << 60 | c << 44 | a, b); };
        x.context[0] = key(0, fine, 0);
        x.context[1] = key(1, signed_class(e1), signed_class(e2));
        x.context[2] = key(2, coarse(Kind::near), coarse(Kind::parallelogram) << 8 | coarse(Kind::implied));
        const int64_t told = candidates_.has_hinges() ? INT64_MAX : off(Kind::guess);
        x.context[3] = key(3, 0, static_cast<uint64_t>(off(Kind::near)) * 31 + static_cast<uint64_t>(told));
        x.context[4] = key(4, signed_class(e1), static_cast<uint64_t>(base_));
        x.context[5] = key(5, apart, static_cast<uint64_t>(std::min(candidates_.n_parallelograms(), 3)));
        x.context[6] = key(6, coarse(Kind::guess), coarse(Kind::average) << 8 | signed_class(e1));
        x.context[7] = key(7, signed_class(t.last), around_->n_neighbours);
    }

    size_t n_components_;
    Candidates<S> candidates_;
    std::vector<float> size_;  // how far from its base each value was
    std::vector<Turn> turns_;

    // The item under way.
    const Neighbourhood* around_ = nullptr;
    int32_t item_ = 0;
    std::array<double, kept> deviation_{}, steepness_{};
    std::array<int64_t, kept> difference_{};
    unsigned hits_ = 0;

    // The component under way.
    std::array<double, n_candidates> scale_{};
    Fit::Vector features_{};
    double norm_ = 1, local_ = 1, unit_ = 1, best_scale_ = 1;
    int64_t base_ = 0;
    bool usable_ = false;
};

}  // namespace ebz::attributes
