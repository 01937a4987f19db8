// What a component of an item may be like, by the known items around it and by its other components.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../positions/recall.hpp"
#include "attributes.hpp"
#include "decision.hpp"
#include "hinges.hpp"
#include "neighbourhood.hpp"
#include "normal_guess.hpp"
#include "texture_map.hpp"

namespace ebz::attributes {

template <class S>
class Candidates {
public:
    enum Kind : size_t { fitted, parallelogram, average, near, second, guess, implied, last };

    // corners: none where items are no vertices.
    Candidates(const Items& items, const Coding& coding, std::span<const int64_t> values, const positions::CornersOfVertices* corners)
        : items_(items),
          coding_(coding),
          values_(values),
          latest_(n_sites(items), -1),
          guess_(items, coding, values, corners),
          hinges_(guess_.is_there() ? std::span<const double>() : items.points) {}

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

    // Of the component at a turn.
    void gather(size_t turn) {
        const size_t c = component(turn);
        is_there_ = 0;
        expected_.fill(0);
        const Neighbourhood& around = *around_;
        double sum = 0;
        for (size_t i = 0; i < around.n_neighbours; ++i) sum += value(around.neighbours[i], c);
        const auto n = static_cast<double>(around.n_neighbours);
        mean_ = around.n_neighbours > 0 ? sum / n : near_ >= 0 ? value(near_, c) : 0.0;
        if (around.n_neighbours > 1) put(average, mean_);
        gather_parallelograms(c);
        if (near_ >= 0) put_value(near, integer_at(near_, c));
        if (second_ >= 0) put_value(second, integer_at(second_, c));
        gather_special(c, turn);
        const bool tells_twin = twin_ >= 0 && directed_ && turn > 0;
        recall(c, turn);
        if (tells_twin) put_value(last, integer_at(twin_, c));
        else if (recalled_ != nullptr) put_value(last, mirrored(recalled_->value));
        else if (last_ >= 0 && last_ != near_) put_value(last, integer_at(last_, c));
    }

    void reveal(int64_t value) {
        recall_.learn(key_, mirrored(value));
        guess_error_ = S::value(value) - expected_[guess];
    }

    void end() {
        if (!items_.site.empty()) latest_[static_cast<size_t>(items_.site[static_cast<size_t>(item_)])] = item_;
        if (is_texture()) texture_.learn(items_, item_, *around_, values_, S::value);
        if (twin_ < 0) guess_.end(item_);
        before_last_ = last_;
        last_ = item_;
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

    // Of the component gathered last: what each candidate expects, as a number and as the nearest integer.
    bool has(size_t k) const { return (is_there_ >> k & 1) != 0; }
    unsigned all() const { return is_there_; }
    double expected(size_t k) const { return expected_[k]; }
    int64_t integer(size_t k) const { return integer_[k]; }
    void put_fitted(double x) {
        put(fitted, x);
        if (!(std::abs(x) < 1e300)) integer_[fitted] = S::nearest(mean_);
    }

    double mean() const { return mean_; }                  // of the neighbours
    double disagreement() const { return disagreement_; }  // of parallelograms
    int n_parallelograms() const { return n_parallelograms_; }
    // Whether other components imply one of the candidates, and what its error is to be divided by then.
    bool is_implied(size_t k) const { return k == implied && is_implied_; }
    double spread() const { return spread_; }
    uint32_t n_recalls() const { return recalled_ != nullptr ? recalled_->hits() : 0; }
    bool has_guess() const { return guess_.is_there(); }
    bool has_hinges() const { return hinges_.has_hinges(); }
    // Where the item is from the mean of its neighbours; zeros where nothing is anywhere, or a guess tells more.
    const std::array<double, 3>& away() const { return hinges_.away(); }
    // Whether values may be functions of the place: shares are not.
    bool has_gradient() const { return around_->n_neighbours > 0 && coding_.relation != Relation::sum; }
    // What errors are to be divided by.
    double extent(size_t turn) const { return directed_ && turn < 2 ? direction_.spread[turn] : hinges_.extent(); }

private:
    static size_t n_sites(const Items& items) {
        int32_t n = 0;
        for (const int32_t s : items.site) n = std::max(n, s + 1);
        return static_cast<size_t>(n);
    }

    size_t at(int32_t item, size_t c) const { return static_cast<size_t>(item) * items_.n_components + c; }
    int64_t integer_at(int32_t item, size_t c) const { return values_[at(item, c)]; }
    double value(int32_t item, size_t c) const { return S::value(integer_at(item, c)); }

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

    // What came the last time that the nearest value and the next, or the component before, were these, perhaps mirrored.
    void recall(size_t c, size_t turn) {
        const int64_t a = near_ >= 0 ? integer_at(near_, c) : 0, b = second_ >= 0 ? integer_at(second_, c) : 0;
        is_mirrored_ = a < 0;
        const int64_t other = turn > 0 ? integer_at(item_, component(turn - 1)) : mirrored(b);
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
        else if (is_row && turn > 0) put_value(guess, integer_at(item_, component(turn - 1)));
        else if (is_row && last_ >= 0) put_value(guess, integer_at(last_, items_.n_components - 1));
        if (map_.is_there) put(implied, map_.value[c]);
        else if (relates() && turn + 1 == items_.n_components) imply(c);
        else if (directed_ && turn == 1) put(implied, expected_[guess] + direction_.slope * guess_error_);
        else if (twin_ >= 0) put_value(implied, integer_at(twin_, c));
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

    const Items& items_;
    const Coding& coding_;
    std::span<const int64_t> values_;
    std::vector<int32_t> latest_;  // item of each site
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

    // The component under way.
    std::array<double, n_candidates> expected_{};
    std::array<int64_t, n_candidates> integer_{};
    unsigned is_there_ = 0;
    double mean_ = 0, spread_ = 1, disagreement_ = 0, guess_error_ = 0;
    int n_parallelograms_ = 0;
    uint32_t key_ = 0;
    const positions::Recall<int64_t>::Entry* recalled_ = nullptr;
    bool is_mirrored_ = false, is_implied_ = false;
};

}  // namespace ebz::attributes
