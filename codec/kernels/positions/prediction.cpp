#include "prediction.hpp"

namespace ebz::positions {

void Predictor::predict(const Surroundings& s, Prediction& p) {
    average(s, p);
    scales(s, p);
    fit(s, p);
    blend(s, p);
    tangent_plane(p);
}

void Predictor::average(const Surroundings& s, Prediction& p) {
    p.neighbours = {};
    for (int i = 0; i < s.n_neighbours; ++i)
        p.neighbours = p.neighbours + Surveyor::to_point(s.neighbour_offset[static_cast<size_t>(i)]);
    p.neighbours = p.neighbours * (1.0 / s.n_neighbours);
    p.plain = p.weighted = p.fitted = p.neighbours;
    p.normal = p.spread = {};
    if (s.n_parallelograms == 0) return;

    const std::span all(s.parallelograms.data(), static_cast<size_t>(s.n_parallelograms));
    Point sum{}, weighted{}, normal{};
    double weights = 0;
    for (const auto& q : all) {
        const Point tip = q.a + q.b - q.apex, u = q.a - q.apex, w = q.b - q.apex;
        const double weight = 1.0 / (1.0 + dot(u, u) + dot(w, w));
        sum = sum + tip;
        weighted = weighted + tip * weight;
        weights += weight;
        normal = normal + cross(u, w);
    }
    const double share = 1.0 / s.n_parallelograms;
    p.plain = sum * share;
    p.weighted = weighted * (1.0 / weights);
    for (const auto& q : all)
        for (size_t d = 0; d < 3; ++d) p.spread[d] += std::fabs(q.a[d] + q.b[d] - q.apex[d] - p.plain[d]);
    p.spread = p.spread * share;
    const double length = std::sqrt(dot(normal, normal));
    if (length > 0) p.normal = normal * (1.0 / length);
}

void Predictor::fit(const Surroundings& s, Prediction& p) {
    if (s.n_parallelograms == 0) return;
    p.fitted = {};
    for (size_t i = 0; i < static_cast<size_t>(s.n_parallelograms); ++i) {
        const auto& q = s.parallelograms[i];
        midpoints_[i] = (q.a + q.b) * 0.5;
        for (size_t d = 0; d < 3; ++d) {
            auto& x = inputs_[i][d];
            x[0] = q.apex[d] - midpoints_[i][d];
            x[1] = q.a[d] - q.b[d];
            for (size_t k = 0; k < 4; ++k) x[2 + k] = (q.wings >> k & 1) != 0 ? q.wing[k][d] - midpoints_[i][d] : 0;
            p.fitted[d] += midpoints_[i][d] + fits_[q.wings].predict(x);
        }
    }
    p.fitted = p.fitted * (1.0 / s.n_parallelograms);
}

Predictor::Blend::Vector Predictor::blend_inputs(const Prediction& p, size_t d) const {
    return {p.fitted[d] - p.plain[d], p.weighted[d] - p.plain[d], p.neighbours[d] - p.plain[d], drift_[d]};
}

void Predictor::blend(const Surroundings& s, Prediction& p) {
    drift_ = {};
    int n = 0;
    for (int i = 0; i < s.n_neighbours; ++i) {
        const Trace& t = trace(s.neighbours[static_cast<size_t>(i)]);
        if (!t.coded) continue;
        for (size_t d = 0; d < 3; ++d) drift_[d] += static_cast<double>(t.residual[d]);
        ++n;
    }
    if (n > 1) drift_ = drift_ * (1.0 / n);
    const Blend& blend = blends_[static_cast<size_t>(s.n_parallelograms)];
    for (size_t d = 0; d < 3; ++d) {
        p.refined[d] = p.plain[d] + blend.predict(blend_inputs(p, d));
    }
}

void Predictor::scales(const Surroundings& s, Prediction& p) const {
    p.size = p.refined_size = p.normal_size = p.tangent_size = 0;
    p.error = {};
    p.n_exact = {};
    p.n_traces = 0;
    for (int i = 0; i < s.n_neighbours; ++i) {
        const Trace& t = trace(s.neighbours[static_cast<size_t>(i)]);
        if (!t.coded) continue;
        ++p.n_traces;
        p.size += static_cast<double>(t.size);
        p.refined_size += static_cast<double>(t.refined_size);
        p.normal_size += static_cast<double>(t.normal_size);
        p.tangent_size += static_cast<double>(t.tangent_size);
        for (size_t d = 0; d < 3; ++d) {
            p.error[d] += static_cast<double>(t.error[d]);
            p.n_exact[d] += t.exact[d] ? 1 : 0;
        }
    }
    if (p.n_traces == 0) {
        const double r = recent_size_;
        p.size = p.refined_size = r;
        p.normal_size = 0.3 * r;
        p.tangent_size = 0.5 * r;
        p.error = {r / 3, r / 3, r / 3};
    } else {
        const double share = 1.0 / p.n_traces;
        p.size *= share;
        p.refined_size *= share;
        p.normal_size *= share;
        p.tangent_size *= share;
        p.error = p.error * share;
    }
}

void Predictor::tangent_plane(Prediction& p) const {
    const bool known = dot(p.normal, p.normal) > 0;
    const double tangent = p.tangent_size * 1.25 + 0.3, across = p.normal_size * 1.25 + 0.3;
    const double vt = tangent * tangent / 1.6, vn = known ? across * across : vt;
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j)
            p.covariance[i][j] = (i == j ? vt + 0.08 : 0) + (vn - vt) * p.normal[i] * p.normal[j];
    order_axes(p);
}

void Predictor::order_axes(Prediction& p) const {
    p.axes = AxisOrder::ending_with(order_.is_fixed() ? order_.last : 2);
    if (order_.is_fixed()) return;
    const auto swap_if = [&](size_t i, size_t j) {
        if (std::fabs(p.normal[p.axes[i]]) > std::fabs(p.normal[p.axes[j]])) std::swap(p.axes[i], p.axes[j]);
    };
    swap_if(0, 1);
    swap_if(1, 2);
    swap_if(0, 1);
}

void Predictor::learn(int32_t v, const Surroundings& s, const Prediction& p, const Point& position,
                      const std::array<int64_t, 3>& residual) {
    for (size_t i = 0; i < static_cast<size_t>(s.n_parallelograms); ++i) {
        Fit& fit = fits_[s.parallelograms[i].wings];
        if (fit.seasoned() && ((++n_learnt_) & 3) != 0) continue;  // three of four for speed
        double energy = 1;
        for (const auto& x : inputs_[i])
            for (double y : x) energy += y * y;
        fit.add(inputs_[i], position - midpoints_[i], 9.0 / energy);
        fit.tick();
    }
    Blend& blend = blends_[static_cast<size_t>(s.n_parallelograms)];
    const double weight = 1.0 / (1.0 + p.size * p.size);
    blend.add(std::array{blend_inputs(p, 0), blend_inputs(p, 1), blend_inputs(p, 2)}, position - p.plain, weight);
    blend.tick();

    Trace& t = traces_[static_cast<size_t>(v)];
    const Point r = position - p.plain;
    t.size = t.refined_size = 0;
    for (size_t d = 0; d < 3; ++d) {
        t.error[d] = static_cast<float>(std::fabs(r[d]));
        t.residual[d] = static_cast<float>(position[d] - p.refined[d]);
        t.size += t.error[d];
        t.refined_size += std::fabs(t.residual[d]);
        t.exact[d] = residual[d] == 0;
    }
    recent_size_ = 0.9 * recent_size_ + 0.1 * static_cast<double>(t.size);
    const double along = dot(r, p.normal), total = dot(r, r);
    const double normal_size = dot(p.normal, p.normal) > 0 ? std::fabs(along) : 0.4 * static_cast<double>(t.size);
    t.normal_size = static_cast<float>(normal_size);
    t.tangent_size = static_cast<float>(std::sqrt(std::max(0.0, total - normal_size * normal_size)));
    t.coded = true;
}

}  // namespace ebz::positions
