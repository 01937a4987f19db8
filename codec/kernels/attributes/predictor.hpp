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
#include "../positions/recall.hpp"
#include "../positions/wrapping.hpp"
#include "attributes.hpp"
#include "hinges.hpp"
#include "neighbourhood.hpp"
#include "normal_guess.hpp"
#include "number_model.hpp"
#include "texture_map.hpp"

namespace ebz::attributes {

using positions::wrapping_difference;
using positions::wrapping_sum;

template <class S>
class Predictor {
public:
    // corners: none where items are no vertices.
    Predictor(const Items& items, const Coding& coding, std::span<const int64_t> values,
              const positions::CornersOfVertices* corners)
        : items_(items),
          coding_(coding),
          values_(values),
          size_(values.size(), -1.0f),
          latest_(n_sites(items), -1),
          turns_(std::min(items.n_components, max_turns)),
          guess_(items, coding, values, corners),
          hinges_(items.item.empty() || guess_.is_there() ? std::span<const double>() : items.points) {}

    // The item under way.
    void begin(int32_t v, const Neighbourhood& around) {
        item_ = v;
        around_ = &around;
        near_ = around.n_neighbours > 0 ? around.neighbours[0] : last_;
        second_ = around.n_neighbours > 1 ? around.neighbours[1] : before_last_;
        twin_ = items_.site.empty() ? -1 : latest_[static_cast<size_t>(items_.site[static_cast<size_t>(v)])];
        map_ = is_texture() ? texture_.predict(items_, v, around, values_, S::value) : TextureMap::Guess{};
        guess_.begin(v);
        hinges_.begin(v, around);
        order_components();
        direct();
    }

    // The component coded at a turn.
    size_t component(size_t turn) const { return turn < order_.size() && ordered_ ? order_[turn] : turn; }

    int64_t base() const { return base_; }

    void expect(size_t turn, Expectation& x) {
        const size_t c = component(turn);
        Turn& t = turns_[std::min(turn, max_turns - 1)];
        gather(c, turn);
        set_features(turn);
        expected_[fitted] = mean_ + t.fit.predict(features_);
        is_there_ |= 1u << fitted;
        scales(c, turn, t);
        choose_base();
        describe(turn, t, x);
    }

    void reveal(size_t turn, int64_t value) {
        Turn& t = turns_[std::min(turn, max_turns - 1)];
        const size_t c = component(turn);
        const double actual = S::value(value);
        const double weight = 1 / (local_ * local_ + 1e-4 * unit_ * unit_ + 1e-300);
        if (std::abs(actual) < 1e150 && usable_) t.fit.add(features_, actual - mean_, weight), t.fit.tick();
        unsigned hit = 0;
        for (size_t k = 0; k < n_candidates; ++k) {
            if ((is_there_ >> k & 1) == 0) continue;
            const double error = distance(actual, expected_[k]) / (k == implied && is_implied_ ? spread_ : norm_);
            t.error[k] += (error - t.error[k]) * rate(t.n_seen[k]);
            if (integer_[k] == value) hit |= 1u << k;
        }
        for (size_t k = 0; k < n_candidates; ++k)
            t.history[k] = static_cast<uint8_t>((t.history[k] << 1 | (hit >> k & 1)) & 7);
        hits_ = hit;
        deviation_[turn % kept] = actual - mean_;
        steepness_[turn % kept] = expected_[parallelogram] - mean_;
        difference_[turn % kept] = wrapping_difference(value, base_);
        size_[at(item_, c)] = static_cast<float>(std::min(distance(actual, S::value(base_)) / norm_, 1e30));
        t.last = difference_[turn % kept];
        recall_.learn(key_, mirrored(value));
        guess_error_ = actual - expected_[guess];
    }

    void end() {
        if (!items_.site.empty()) latest_[static_cast<size_t>(items_.site[static_cast<size_t>(item_)])] = item_;
        if (is_texture()) texture_.learn(items_, item_, *around_, values_, S::value);
        if (twin_ < 0) guess_.end(item_);
        before_last_ = last_;
        last_ = item_;
    }

private:
    // Candidates.
    enum : size_t { fitted, parallelogram, average, near, second, guess, implied, last };
    static constexpr size_t max_turns = 64, kept = 4, n_features = 11;
    using Fit = positions::LeastSquares<n_features>;

    struct Turn {
        Fit fit{{0.6, 0, 0, 0.5, 0.5, 0, 0, 0, 0, 0, 0}, 3.0, 3000};
        std::array<double, n_candidates> error{};
        std::array<uint16_t, n_candidates> n_seen{};
        std::array<uint8_t, n_candidates> history{};
        int64_t last = 0;
    };

    static size_t n_sites(const Items& items) {
        int32_t n = 0;
        for (const int32_t s : items.site) n = std::max(n, s + 1);
        return static_cast<size_t>(n);
    }

    size_t at(int32_t item, size_t c) const { return static_cast<size_t>(item) * items_.n_components + c; }
    int64_t integer(int32_t item, size_t c) const { return values_[at(item, c)]; }
    double value(int32_t item, size_t c) const { return S::value(integer(item, c)); }

    static double distance(double a, double b) {
        const double d = std::abs(a - b);
        return d < 1e150 ? d : 1e150;
    }

    static double rate(uint16_t& n) {
        n = static_cast<uint16_t>(std::min(n + 1, 40));
        return 1.0 / n;
    }

    void put(size_t k, double x) {
        expected_[k] = x;
        integer_[k] = S::nearest(x);
        is_there_ |= 1u << k;
    }
    void put_value(size_t k, int64_t x) {
        expected_[k] = S::value(x);
        integer_[k] = x;
        is_there_ |= 1u << k;
    }

    void gather(size_t c, size_t turn) {
        is_there_ = 0;
        expected_.fill(0);
        const Neighbourhood& around = *around_;
        double sum = 0;
        for (size_t i = 0; i < around.n_neighbours; ++i) sum += value(around.neighbours[i], c);
        const auto n = static_cast<double>(around.n_neighbours);
        mean_ = around.n_neighbours > 0 ? sum / n : near_ >= 0 ? value(near_, c) : 0.0;
        if (around.n_neighbours > 1) put(average, mean_);
        gather_parallelograms(c);
        if (near_ >= 0) put_value(near, integer(near_, c));
        if (second_ >= 0) put_value(second, integer(second_, c));
        gather_special(c, turn);
        const bool tells_twin = twin_ >= 0 && directed_ && turn > 0;
        recall(c, turn);
        if (tells_twin) put_value(last, integer(twin_, c));
        else if (recalled_ != nullptr) put_value(last, mirrored(recalled_->value));
        else if (last_ >= 0 && last_ != near_) put_value(last, integer(last_, c));
    }

    // What came the last time that the nearest value and the next, or the component before, were these, perhaps mirrored.
    void recall(size_t c, size_t turn) {
        const int64_t a = near_ >= 0 ? integer(near_, c) : 0, b = second_ >= 0 ? integer(second_, c) : 0;
        is_mirrored_ = a < 0;
        const int64_t other = turn > 0 ? integer(item_, component(turn - 1)) : mirrored(b);
        key_ = hash(hash(c, static_cast<uint64_t>(mirrored(a))), static_cast<uint64_t>(other));
        recalled_ = recall_.find(key_);
    }

    int64_t mirrored(int64_t x) const { return is_mirrored_ ? S::mirrored(x) : x; }

    void gather_parallelograms(size_t c) {
        double sum = 0, least = 0, most = 0;
        int n = 0;
        for (size_t i = 0; i < around_->n_triangles; ++i) {
            const Parallelogram& p = around_->triangles[i];
            if (p.across < 0) continue;
            const double x = value(p.a, c) + value(p.b, c) - value(p.across, c);
            least = n == 0 ? x : std::min(least, x);
            most = n == 0 ? x : std::max(most, x);
            sum += x;
            ++n;
        }
        n_parallelograms_ = n;
        disagreement_ = most - least;
        if (n > 0) put(parallelogram, sum / n);
        else expected_[parallelogram] = mean_;
    }

    void gather_special(size_t c, size_t turn) {
        spread_ = 1;
        is_implied_ = false;
        const bool is_row = items_.opposite.empty() && items_.item.empty();
        const auto of = [&](int32_t item) { return value(item, c); };
        if (guess_.is_there()) put(guess, guess_(item_, c));
        else if (hinges_.has_hinges()) put(guess, hinges_.unfolded(of));
        else if (is_row && turn > 0) put_value(guess, integer(item_, component(turn - 1)));
        else if (is_row && last_ >= 0) put_value(guess, integer(last_, items_.n_components - 1));
        if (map_.is_there) put(implied, map_.value[c]);
        else if (relates() && turn + 1 == items_.n_components) imply(c);
        else if (directed_ && turn == 1) put(implied, expected_[guess] + direction_.slope * guess_error_);
        else if (twin_ >= 0) put_value(implied, integer(twin_, c));
        else if (items_.site.empty() && hinges_.has_mean()) put(implied, hinges_.mean(*around_, of));
    }

    bool relates() const { return coding_.relation == Relation::unit || coding_.relation == Relation::sum; }

    // What the other components leave for the last.
    void imply(size_t c) {
        is_implied_ = true;
        double rest = 0, most = 0;
        for (size_t d = 0; d < items_.n_components; ++d) {
            if (d == c) continue;
            const double x = value(item_, d);
            rest += coding_.relation == Relation::unit ? x * x : x;
            most = std::max(most, std::abs(x));
        }
        if (coding_.relation == Relation::sum) return put(implied, coding_.total - rest);
        const double square = coding_.total * coding_.total - rest;
        const double size = square > 0 ? std::sqrt(square) : 0.0;
        const double hint = (is_there_ >> guess & 1) != 0 ? expected_[guess] : mean_;
        spread_ = std::max(most, 1e-300) / std::max(size, std::max(most, 1e-300) * 1e-3);
        put(implied, hint < 0 ? -size : size);
    }

    // Of three that make a unit vector, the largest comes last: it is told best by the others.
    void order_components() {
        ordered_ = coding_.relation == Relation::unit && items_.n_components == 3;
        if (!ordered_) return;
        std::array<double, 3> size{};
        for (size_t c = 0; c < 3; ++c) {
            if (guess_.is_there()) size[c] = std::abs(guess_(item_, c));
            else if (near_ >= 0) size[c] = std::abs(value(near_, c));
        }
        order_ = {0, 1, 2};
        std::stable_sort(order_.begin(), order_.end(), [&](size_t a, size_t b) { return size[a] < size[b]; });
    }

    bool is_texture() const {
        return items_.n_components == 2 && !items_.points.empty() && coding_.relation != Relation::octahedral;
    }

    // What errors of the guess will be like.
    void direct() {
        directed_ = guess_.are_directions();
        if (directed_) direction_ = guess_.direction(item_, component(0), component(1));
    }

    // How far the guesses around were off: what spoils one often spoils its neighbour's.
    double guess_error_around(size_t c) const {
        double sum = 0;
        for (size_t i = 0; i < around_->n_neighbours; ++i) {
            const int32_t u = around_->neighbours[i];
            sum += value(u, c) - guess_(u, c);
        }
        return around_->n_neighbours > 0 ? sum / static_cast<double>(around_->n_neighbours) : 0.0;
    }

    void set_features(size_t turn) {
        const auto difference = [&](size_t k) { return (is_there_ >> k & 1) != 0 ? expected_[k] - mean_ : 0.0; };
        const double third = guess_.is_there() ? guess_error_around(component(turn)) : difference(second);
        features_ = {difference(parallelogram), difference(near), third, difference(guess), difference(implied)};
        for (size_t back = 1; back <= 3 && back <= turn; ++back) features_[4 + back] = deviation_[(turn - back) % kept];
        for (size_t back = 1; back <= 3 && back <= turn; ++back) features_[7 + back] = steepness_[(turn - back) % kept];
        usable_ = true;
        for (double& x : features_) {
            if (!(std::abs(x) < 1e150)) usable_ = false;
        }
        if (!usable_) features_.fill(0);
    }

    // How far off each candidate may be.
    void scales(size_t c, size_t turn, const Turn& t) {
        norm_ = directed_ && turn < 2 ? direction_.spread[turn] : hinges_.extent();
        double sum = 0;
        int n = 0;
        for (size_t i = 0; i < around_->n_neighbours; ++i) {
            sum += size_[at(around_->neighbours[i], c)];
            ++n;
        }
        const double typical = t.n_seen[fitted] > 0 ? t.error[fitted] : 1.0;
        local_ = (n > 0 ? (sum + typical) / (n + 1) : typical) * norm_;
        for (size_t k = 0; k < n_candidates; ++k) {
            if ((is_there_ >> k & 1) == 0) continue;
            const double ratio = t.n_seen[k] > 0 ? t.error[k] / std::max(typical, 1e-300) : 1.0;
            scale_[k] = k == implied && is_implied_ ? t.error[k] * spread_ : local_ * std::min(ratio, 1e6);
        }
    }

    // The candidate that is likely to be nearest.
    void choose_base() {
        size_t best = fitted;
        for (size_t k = 0; k < n_candidates; ++k)
            if ((is_there_ >> k & 1) != 0 && scale_[k] < 0.8 * scale_[best]) best = k;
        const double x = std::abs(expected_[fitted]) < 1e300 ? expected_[fitted] : mean_;
        integer_[fitted] = S::nearest(x);
        base_ = integer_[best];
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
        x.candidates = is_there_;
        for (size_t k = 0; k < n_candidates; ++k) {
            x.offset[k] = wrapping_difference(integer_[k], base_);
            x.mean[k] = static_cast<float>(limited(S::offset(expected_[k], base_), -1e18, 1e18));
            x.scale[k] = static_cast<float>(limited(0.6 * scale_[k] / unit_, 0.08, 1e18));
            const unsigned before = turn == 0 ? 0 : 1 + (hits_ >> k & 1);
            x.value_context[k] = static_cast<uint8_t>(before * 8 + t.history[k]);
        }
        if (recalled_ != nullptr) x.value_context[last] = static_cast<uint8_t>(23 + std::min<uint32_t>(recalled_->hits(), 8));
        x.turn = turn;
        x.expected_class = std::min(size_class(best_scale_), 56);
        x.level = static_cast<size_t>(std::min(size_class(best_scale_ * 2), static_cast<int>(Decision::n_levels) - 1));
        set_contexts(turn, t, x);
    }

    void set_contexts(size_t turn, const Turn& t, Expectation& x) const {
        const auto off = [&](size_t k) { return (is_there_ >> k & 1) != 0 ? wrapping_difference(integer_[k], base_) : INT64_MAX; };
        const auto coarse = [&](size_t k) { return signed_class(off(k)); };
        const int64_t e1 = turn > 0 ? difference_[(turn - 1) % kept] : 0, e2 = turn > 1 ? difference_[(turn - 2) % kept] : 0;
        const uint64_t c = std::min<uint64_t>(turn, 255) << 8 | static_cast<uint64_t>(x.expected_class);
        const auto fine = static_cast<uint64_t>(std::min(size_class(best_scale_ * 8), 60));
        const auto apart = static_cast<uint64_t>(std::min(size_class(disagreement_ / unit_), 60));
        const auto key = [&](uint64_t i, uint64_t a, uint64_t b) { return hash(i << 60 | c << 44 | a, b); };
        x.context[0] = key(0, fine, 0);
        x.context[1] = key(1, signed_class(e1), signed_class(e2));
        x.context[2] = key(2, coarse(near), coarse(parallelogram) << 8 | coarse(implied));
        const int64_t told = hinges_.has_hinges() ? INT64_MAX : off(guess);
        x.context[3] = key(3, 0, static_cast<uint64_t>(off(near)) * 31 + static_cast<uint64_t>(told));
        x.context[4] = key(4, signed_class(e1), static_cast<uint64_t>(base_));
        x.context[5] = key(5, apart, static_cast<uint64_t>(std::min(n_parallelograms_, 3)));
        x.context[6] = key(6, coarse(guess), coarse(average) << 8 | signed_class(e1));
        x.context[7] = key(7, signed_class(t.last), around_->n_neighbours);
    }

    const Items& items_;
    const Coding& coding_;
    std::span<const int64_t> values_;
    std::vector<float> size_;      // how far from its base each value was
    std::vector<int32_t> latest_;  // item of each site
    std::vector<Turn> turns_;
    TextureMap texture_;
    NormalGuess<S> guess_;
    Hinges hinges_;
    positions::Recall<int64_t> recall_{14};
    int32_t last_ = -1, before_last_ = -1;

    // The item under way.
    const Neighbourhood* around_ = nullptr;
    int32_t item_ = 0, near_ = -1, second_ = -1, twin_ = -1;
    TextureMap::Guess map_;
    std::array<size_t, 3> order_{};
    bool ordered_ = false, directed_ = false;
    Direction direction_;
    std::array<double, kept> deviation_{}, steepness_{};
    std::array<int64_t, kept> difference_{};
    unsigned hits_ = 0;

    // The component under way.
    std::array<double, n_candidates> expected_{}, scale_{};
    std::array<int64_t, n_candidates> integer_{};
    unsigned is_there_ = 0;
    Fit::Vector features_{};
    double norm_ = 1, guess_error_ = 0;
    uint32_t key_ = 0;
    const positions::Recall<int64_t>::Entry* recalled_ = nullptr;
    bool is_mirrored_ = false;
    bool is_implied_ = false;
    double mean_ = 0, local_ = 1, unit_ = 1, spread_ = 1, disagreement_ = 0, best_scale_ = 1;
    int64_t base_ = 0;
    int n_parallelograms_ = 0;
    bool usable_ = false;
};

}  // namespace ebz::attributes
