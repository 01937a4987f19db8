#include "axes.hpp"

#include <algorithm>
#include <cmath>

#include "float_logistic.hpp"

namespace ebz::positions {

namespace {

// Half-octaves of a magnitude: 1 gives 11.
int level_of(double x) {
    const auto size = static_cast<float>(x < 1e30 ? x : 1e30) + 0.03f;
    return std::clamp(static_cast<int>(log2_approx(size) * 2.0f + 64.0f) - 53, 0, 90);
}

uint32_t hash(uint32_t a, uint32_t b, uint32_t c = 0, uint32_t d = 0) {
    uint32_t h = a * 0x9E3779B1u;
    h = (h ^ (h >> 15)) + b * 0x85EBCA6Bu;
    h = (h ^ (h >> 13)) * 0xC2B2AE35u + c * 0x27D4EB2Fu;
    h = (h ^ (h >> 16)) + d * 0x165667B1u;
    return h ^ (h >> 15);
}

uint32_t bucket(int64_t x, int64_t limit) { return static_cast<uint32_t>(std::clamp(x, -limit, limit) + limit); }

uint32_t low_bits(int64_t x) { return static_cast<uint32_t>(static_cast<uint64_t>(x)); }

// How often a source was exact on earlier axes of this vertex: 0 if there were none, else never: 1,
// sometimes: 2, always: 3.
uint32_t agreement_of(size_t turn, size_t hits) { return turn == 0 ? 0 : hits == 0 ? 1 : hits < turn ? 2 : 3; }

void add_value(Expectation& x, size_t i, int64_t value, uint32_t context) {
    x.value[i] = value;
    x.value_context[i] = static_cast<uint8_t>(context);
    x.values |= 1u << i;
}

}  // namespace

void Axes::begin(const Surroundings& s, const Prediction& p, const Twins* twin) {
    s_ = &s;
    p_ = &p;
    twin_ = twin;
    plain_mean_ = p.plain;
    refined_mean_ = p.refined;
    covariance_ = p.covariance;
    for (size_t d = 0; d < 3; ++d) base_[d] = rounded(p.plain[d]);
    first_residual_ = last_residual_ = 0;
}

void Axes::find_contexts(size_t turn, Expectation& x) {
    const size_t d = p_->axes[turn];
    x.turn = turn;
    set_keys(turn);  // first: what is recalled has to come from memory
    nearest_ = nearest(d);
    set_sizes(d, x);
    set_contexts(turn, x);
}

void Axes::expect(size_t turn, Expectation& x) {
    const size_t d = p_->axes[turn];
    x.values = 0;
    x.value.fill(0);
    x.value_context.fill(0);
    set_distributions(d, x);
    set_values(turn, x);
    set_recalled(turn, x);
}

// Factors from a standard deviation or a mean magnitude to the scale of a logistic distribution.
void Axes::set_distributions(size_t d, Expectation& x) const {
    const auto base = static_cast<double>(base_[d]);
    const double sigma = sigma_, error = p_->error[d] * 0.48 + 0.12;
    const double sharper = std::clamp(p_->refined_size / (p_->size + 0.01), 0.1, 4.0);
    const auto set = [&](size_t i, double mean, double scale) {
        x.mean[i] = static_cast<float>(mean - base);
        x.scale[i] = static_cast<float>(scale);
    };
    set(0, plain_mean_[d], sigma * 0.55 + 0.08);
    set(1, p_->weighted[d], p_->spread[d] * 0.5 + p_->error[d] * 0.2 + 0.15);
    set(2, refined_mean_[d], sigma * 0.55 * sharper + 0.08);
    set(3, p_->fitted[d], error * sharper + 0.05);
    for (size_t i = 4; i < 8; ++i) set(i, base, 1.0);
}

void Axes::set_sizes(size_t d, Expectation& x) {
    const double sigma = sigma_ = std::sqrt(std::max(covariance_[d][d], 1e-3));
    const int level = level_of(sigma);
    x.shift = std::max(0, (level - 18) / 2);
    x.level = std::min(level - 2 * x.shift, 22) / 2;
    const double typical = std::clamp(sigma * 0.6, 0.25, 1e12);
    const int digits = static_cast<int>(log2_approx(static_cast<float>(typical)) + 10.5f) - 10;
    x.expected_class = std::clamp(digits, 0, Expectation::max_class - 1);
}

Axes::Nearest Axes::nearest(size_t d) const {
    Nearest near{wrapping_difference(s_->neighbour_offset[0][d], base_[d]), 0, false};
    for (size_t i = 1; i < static_cast<size_t>(s_->n_neighbours); ++i) {
        const int64_t off = wrapping_difference(s_->neighbour_offset[i][d], base_[d]);
        if (off == near.first) continue;
        if (magnitude(off) < magnitude(near.first)) {
            near = {off, near.first, true};
        } else if (!near.has_second || magnitude(off) < magnitude(near.second)) {
            near.second = off;
            near.has_second = true;
        }
    }
    return near;
}

uint32_t Axes::agreement(size_t turn, const Offset& at) const {
    size_t hits = 0;
    for (size_t i = 0; i < turn; ++i) hits += at[p_->axes[i]] == value_[p_->axes[i]] ? 1 : 0;
    return agreement_of(turn, hits);
}

// Of predictions around this vertex; < 16.
uint32_t Axes::exactness(size_t d) const {
    return static_cast<uint32_t>(std::min(p_->n_exact[d], 3) * 4 + std::min(p_->n_traces, 3));
}

void Axes::set_values(size_t turn, Expectation& x) {
    const size_t d = p_->axes[turn];
    uint32_t first = 0, second = 0;
    for (size_t i = 0; i < static_cast<size_t>(s_->n_neighbours); ++i) {
        const int64_t off = wrapping_difference(s_->neighbour_offset[i][d], base_[d]);
        if (off == nearest_.first) first = std::max(first, agreement(turn, s_->neighbour_offset[i]));
        if (off == nearest_.second) second = std::max(second, agreement(turn, s_->neighbour_offset[i]));
    }
    const uint32_t exact = exactness(d);
    add_value(x, 0, nearest_.first, exact + 16 * first);
    if (nearest_.has_second) add_value(x, 1, nearest_.second, exact + 16 * second);
    const bool has_twin = twin_ != nullptr && twin_->exists();
    const int n_tips = std::min(s_->n_parallelograms, has_twin ? 1 : 2);
    for (size_t i = 0; i < static_cast<size_t>(n_tips); ++i) {
        const Offset& tip = s_->parallelograms[i].tip;
        add_value(x, 2 + i, wrapping_difference(tip[d], base_[d]), exact + 16 * agreement(turn, tip));
    }
    if (!has_twin) return;
    const auto strength = static_cast<uint32_t>(twin_->strength());
    add_value(x, 3, wrapping_difference(twin_->value(d), base(d)), 64 + 4 * strength + agreement_of(turn, twin_->n_agree()));
}

// 0 where there is no such neighbour.
uint32_t Axes::neighbour_value(size_t i, size_t d) const {
    const bool there = i < static_cast<size_t>(s_->n_neighbours);
    return there ? low_bits(wrapping_sum(s_->origin[d], s_->neighbour_offset[i][d])) : 0;
}

// Circumstances in which a coordinate may come again: the same coordinates on earlier axes, the same
// ones of neighbours on this axis, and some of both.
void Axes::set_keys(size_t turn) {
    const size_t d = p_->axes[turn], before = turn > 0 ? p_->axes[turn - 1] : 0;
    const auto axis = static_cast<uint32_t>(d), axis_and_turn = static_cast<uint32_t>(d * 4 + turn);
    const auto axes = static_cast<uint32_t>(axis_and_turn * 4 + before);
    const uint32_t origin = low_bits(s_->origin[d]), latest = turn > 0 ? low_bits(value(before)) : 0;
    const uint32_t one = turn > 0 ? low_bits(value(p_->axes[0])) : origin, two = turn > 1 ? latest : 0;
    const uint32_t second = neighbour_value(1, d), third = neighbour_value(2, d);
    keys_[0] = hash(axis_and_turn, one, two);
    keys_[1] = hash(axis, origin, second, 1);
    keys_[2] = turn == 0 ? hash(axis, origin, second, third) : hash(axes, latest, turn == 1 ? origin : 0, 2);
    for (size_t i = 0; i < n_recalls; ++i) recalls_[i].prefetch(keys_[i]);
}

// What is nearest among the coordinates with these lower bits.
int64_t Axes::from_base(size_t d, uint32_t coordinate) const { return int64_t{static_cast<int32_t>(coordinate - low_bits(base(d)))}; }

void Axes::set_recalled(size_t turn, Expectation& x) {
    const size_t d = p_->axes[turn];
    const auto context = static_cast<uint32_t>(16 * turn);
    for (size_t i = 0; i < n_recalls; ++i) {
        const Coordinates::Entry* r = recalls_[i].find(keys_[i]);
        if (r != nullptr) add_value(x, 4 + i, from_base(d, r->value), r->hits() + context);
        if (i == 0) along_axes_ = r;
    }
    if (along_axes_ == nullptr) return;
    add_value(x, 7, from_base(d, mirrors_[d].sum - along_axes_->value), mirrors_[d].hits + context);
}

// A value that was recalled as another on this axis may be its mirror image.
void Axes::learn_mirror(size_t d) {
    if (along_axes_ == nullptr || along_axes_->value == low_bits(value(d))) return;
    Mirror& mirror = mirrors_[d];
    const uint32_t sum = along_axes_->value + low_bits(value(d));
    mirror.hits = sum == mirror.sum ? std::min(mirror.hits + 1, Coordinates::max_hits) : 1;
    mirror.sum = sum;
}

void Axes::set_contexts(size_t turn, Expectation& x) const {
    const size_t d = p_->axes[turn];
    const uint32_t t = static_cast<uint32_t>(turn), axis = static_cast<uint32_t>(d);
    const auto spread = static_cast<uint32_t>(std::clamp(level_of(p_->spread[d]) - 2 * x.shift, 0, 40));
    const uint32_t first = bucket(nearest_.first, 20), second = nearest_.has_second ? bucket(nearest_.second, 20) : 50;
    const int64_t e = first_residual_ >> x.shift;
    // Which slots of a context are in use depends on where the search for the class begins.
    const auto start = static_cast<uint32_t>(std::clamp(x.expected_class - x.shift + 8, 0, 15));
    x.context = {
        hash(spread, static_cast<uint32_t>(s_->n_parallelograms), 1, start),
        hash(first, second + 256 * axis, 2, start),
        hash(turn == 0 ? 7 : low_bits(value(p_->axes[0])), low_bits(s_->origin[d]), t, start),
        hash(bucket(e, 2000), bucket(last_residual_ >> x.shift, 2000), t, start),
    };
}

void Axes::reveal(size_t turn, int64_t e) {
    const size_t d = p_->axes[turn];
    residual_[d] = e;
    value_[d] = wrapping_sum(base_[d], e);
    (turn == 0 ? first_residual_ : last_residual_) = e;
    learn_mirror(d);
    for (size_t i = 0; i < n_recalls; ++i) recalls_[i].learn(keys_[i], low_bits(value(d)));
    // The remaining axes, conditioned on this one.
    const auto at = static_cast<double>(value_[d]);
    const double off_plain = at - plain_mean_[d], off_refined = at - refined_mean_[d];
    for (size_t i = turn + 1; i < 3; ++i) {
        const size_t a = p_->axes[i];
        const double gain = covariance_[a][d] / covariance_[d][d];
        plain_mean_[a] += gain * off_plain;
        refined_mean_[a] += gain * off_refined;
        for (size_t j = turn + 1; j < 3; ++j) covariance_[a][p_->axes[j]] -= gain * covariance_[d][p_->axes[j]];
    }
}

}  // namespace ebz::positions
