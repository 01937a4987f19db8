#include "light_predictor.hpp"

#include "float_logistic.hpp"

namespace ebz::positions {

namespace {

int half_octaves(float x) {  // 1 gives 6, at most 90
    return std::clamp(static_cast<int>(log2_approx(x + 0.125f) * 2.0f + 6.0f), 0, 90);
}

}  // namespace

bool LightPredictor::predict(int32_t v) {
    n_ = n_sizes_ = 0;
    n_neighbours_ = 0;
    sum_ = spread_ = normal_ = {};
    size_ = {};
    for (int32_t c : corners_[v]) visit(c);
    if (n_neighbours_ == 0) return false;
    const double share = n_ > 0 ? 1.0 / n_ : 0;
    for (size_t d = 0; d < 3; ++d) {
        mean_[d] = sum_[d] * share;  // without parallelograms the first neighbour
        base_[d] = rounded(mean_[d]);
    }
    order_axes();
    total_ = slid_ = 0;
    slides_ = false;
    return true;
}

void LightPredictor::visit(int32_t c) {
    const int32_t a = vertex(next(c)), b = vertex(previous(c));
    const bool knows_a = traversal_.known(a), knows_b = traversal_.known(b);
    if (knows_a) add_neighbour(a);
    if (knows_b && opposite(previous(c)) < 0) add_neighbour(b);
    if (!knows_a || !knows_b) return;
    const int32_t across = opposite(next(c));
    if (across < 0) return;
    const int32_t apex = vertex(previous(across));
    if (!traversal_.known(apex)) return;
    const Offset oa = offset(a), ob = offset(b), oc = offset(apex);
    Point u, w;
    for (size_t d = 0; d < 3; ++d) {
        u[d] = static_cast<double>(wrapping_difference(oa[d], oc[d]));
        w[d] = static_cast<double>(wrapping_difference(ob[d], oc[d]));
        const double tip = u[d] + static_cast<double>(ob[d]);
        if (n_ > 0) spread_[d] += std::fabs(tip - last_tip_[d]);
        last_tip_[d] = tip;
        sum_[d] += tip;
    }
    for (size_t d = 0; d < 3; ++d) normal_[d] += u[(d + 1) % 3] * w[(d + 2) % 3] - u[(d + 2) % 3] * w[(d + 1) % 3];
    ++n_;
}

void LightPredictor::add_neighbour(int32_t u) {
    const size_t at = 3 * static_cast<size_t>(u);
    if (n_neighbours_ == 0)
        for (size_t d = 0; d < 3; ++d) origin_[d] = xyz_[at + d];
    if (n_neighbours_ < max_neighbours) neighbours_[n_neighbours_++] = offset(u);
    if (sizes_[at] == unknown) return;
    ++n_sizes_;
    for (size_t d = 0; d < 3; ++d) size_[d] += sizes_[at + d];
}

// The axis nearest to the normal last: by then the others tell most about it.
void LightPredictor::order_axes() {
    axes_ = {0, 1, 2};
    const auto swap_if = [&](size_t i, size_t j) {
        if (std::fabs(normal_[axes_[i]]) > std::fabs(normal_[axes_[j]])) std::swap(axes_[i], axes_[j]);
    };
    swap_if(0, 1);
    swap_if(1, 2);
    swap_if(0, 1);
}

void LightPredictor::expect(size_t turn, LightContext& x) {
    const size_t d = axes_[turn];
    const float size = n_sizes_ > 0 ? static_cast<float>(size_[d]) / static_cast<float>(n_sizes_) : 4.0f;
    const float spread = n_ > 1 ? static_cast<float>(std::min(spread_[d], 1e15)) / static_cast<float>(n_ - 1) : size;
    const float scale = turn == 2 ? 0.75f * size + 0.1f * spread : 0.6f * size + 0.25f * spread;
    const int level = half_octaves(scale);
    if (turn == 2) slide(turn, level > 8);
    x.shift = std::max(0, (level - 16) / 2);
    x.expected_class = std::clamp(level / 2 - 2, 0, LightContext::max_class - 1);
    const float earlier = turn == 0 ? 0 : static_cast<float>(total_) / static_cast<float>(turn);
    const int before = turn == 0 ? 0 : std::clamp(half_octaves(earlier) - level + 6, 0, 11);
    const int relative = level - 2 * x.shift;  // <= 17

    int64_t near = wrapping_difference(neighbours_[0][d], base_[d]);  // the value equals a neighbour's there
    for (size_t i = 1; i < n_neighbours_; ++i) {
        const int64_t off = wrapping_difference(neighbours_[i][d], base_[d]);
        if (magnitude(off) < magnitude(near)) near = off;
    }
    const auto o = static_cast<int>(std::clamp<int64_t>(near, -7, 7)) + 7;
    const double fraction = mean_[d] - static_cast<double>(base_[d]);
    const int f = static_cast<int>(std::clamp(fraction * 3.0 + 4.5, 0.0, 8.0));
    const int wide = std::clamp(half_octaves(spread) - 2 * x.shift, 0, 17);
    const int t = static_cast<int>(turn), axis = static_cast<int>(d);
    const auto index = [](int i) { return static_cast<size_t>(i); };
    x.context = {index((t * 18 + relative) * 12 + before), index((axis * 15 + o) * 9 + f),
                 index((t * 18 + wide) * 5 + std::min(n_, 4)), index((axis * 18 + relative) * 18 + wide)};
    expect_value(turn, x);
}

// On a plane the first two residuals tell the third; r is how much wider residuals are along it.
void LightPredictor::slide(size_t turn, bool far) {
    const size_t d = axes_[turn];
    const Point& n = normal_;
    const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    if (!(square > 0)) return;
    double along = 0;
    for (size_t i = 0; i < 2; ++i)
        along += n[axes_[i]] * (static_cast<double>(value_[axes_[i]]) - mean_[axes_[i]]);
    const double r = std::max(tangent_energy_ / normal_energy_ - 1.0, 0.0);
    const double shifted = mean_[d] - r * n[d] * along / (square + r * n[d] * n[d]);
    const int64_t straight = base_[d], slid = rounded(shifted);
    slid_ = wrapping_difference(slid, straight);
    slides_ = far && gain_with_ < gain_without_;
    if (slides_) base_[d] = slid;
    if (gain_with_ < gain_without_) mean_[d] = shifted;
}

// The value of the neighbour that agrees most on earlier axes, the nearest if several do.
void LightPredictor::expect_value(size_t turn, LightContext& x) {
    const size_t d = axes_[turn];
    uint32_t most = 0;
    uint64_t nearest = ~uint64_t{0};
    for (size_t i = 0; i < n_neighbours_; ++i) {
        uint32_t hits = 0;
        for (size_t k = 0; k < turn; ++k) hits += neighbours_[i][axes_[k]] == value_[axes_[k]] ? 1 : 0;
        if (hits < most) continue;
        const int64_t off = wrapping_difference(neighbours_[i][d], base_[d]);
        const uint64_t distance = magnitude(off);
        if (hits > most || distance < nearest) {
            most = hits;
            nearest = distance;
            x.value = off;
        }
    }
    x.value_context = turn * 3 + most;
}

void LightPredictor::reveal(size_t turn, int64_t e) {
    const size_t d = axes_[turn];
    const auto size = static_cast<int32_t>(std::clamp<int64_t>(e, -max_size, max_size));
    residual_sizes_[d] = size < 0 ? -size : size;
    total_ += residual_sizes_[d];
    value_[d] = wrapping_sum(base_[d], e);
    if (turn == 2 && slid_ != 0) {
        const double with = static_cast<double>(slides_ ? e : wrapping_difference(e, slid_));
        const double without = static_cast<double>(slides_ ? wrapping_sum(e, slid_) : e);
        const double scale = 1.0 / (1.0 + std::fabs(with) + std::fabs(without));
        gain_with_ += (std::fabs(with) * scale - gain_with_) * 0.005;
        gain_without_ += (std::fabs(without) * scale - gain_without_) * 0.005;
    }
}

void LightPredictor::learn(int32_t v) {
    const size_t at = 3 * static_cast<size_t>(v);
    for (size_t d = 0; d < 3; ++d) sizes_[at + d] = residual_sizes_[d];
    const double square = normal_[0] * normal_[0] + normal_[1] * normal_[1] + normal_[2] * normal_[2];
    if (!(square > 0)) return;
    double along = 0, energy = 0.1;
    for (size_t d = 0; d < 3; ++d) {
        const double r = static_cast<double>(value_[d]) - sum_[d] / n_;
        along += r * normal_[d];
        energy += r * r;
    }
    const double share = along * along / (square * energy);  // of the energy across the plane
    normal_energy_ += (share + 0.01 - normal_energy_) * 0.02;
    tangent_energy_ += ((1.0 - share) * 0.5 + 0.01 - tangent_energy_) * 0.02;
}

}  // namespace ebz::positions
