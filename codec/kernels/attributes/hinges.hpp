// How values go on along the surface by where items are: nearer neighbours tell more, and triangles unfold.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "neighbourhood.hpp"

namespace ebz::attributes {

class Hinges {
public:
    // points: 3 per item, or none.
    explicit Hinges(std::span<const double> points) : points_(points) {}

    // The item under way.
    void begin(int32_t v, const Neighbourhood& around) {
        n_hinges_ = 0;
        total_ = 0;
        n_neighbours_ = static_cast<double>(around.n_neighbours);
        away_ = {};
        if (points_.empty()) return;
        for (size_t d = 0; d < 3; ++d) {
            for (size_t i = 0; i < around.n_neighbours; ++i) away_[d] += at(v, d) - at(around.neighbours[i], d);
            away_[d] /= std::max(n_neighbours_, 1.0);
        }
        for (size_t i = 0; i < around.n_neighbours; ++i) {
            nearness_[i] = 1 / (square(v, around.neighbours[i]) + 1e-200);
            total_ += nearness_[i];
        }
        for (size_t i = 0; i < around.n_triangles; ++i) add(v, around.triangles[i]);
    }

    // Whether the neighbours lie apart, and in how many ways triangles unfold.
    bool has_mean() const { return total_ > 0 && total_ < 1e150; }
    bool has_hinges() const { return n_hinges_ > 0; }

    // The square root of a mean distance; 1 where there is none.
    double extent() const { return has_mean() ? std::sqrt(std::sqrt(n_neighbours_ / total_ + 1e-100)) : 1.0; }

    // Of the item from the mean of its neighbours.
    const std::array<double, 3>& away() const { return away_; }

    // By the inverse squares of distances.
    template <class Value>
    double mean(const Neighbourhood& around, Value value) const {
        double sum = 0;
        for (size_t i = 0; i < around.n_neighbours; ++i) sum += nearness_[i] * value(around.neighbours[i]);
        return sum / total_;
    }

    // Along the triangles behind the edges, each as flat as the triangle of the item.
    template <class Value>
    double unfolded(Value value) const {
        double sum = 0, weights = 0;
        for (size_t i = 0; i < n_hinges_; ++i) {
            const Hinge& h = hinges_[i];
            const double a = value(h.triangle.a), b = value(h.triangle.b), c = value(h.triangle.across);
            const double edge = b - a, weight = 1 / (1 + h.ratio);
            sum += weight * (a + edge * h.along - h.ratio * (c - a - edge * h.across));
            weights += weight;
        }
        return sum / weights;
    }

private:
    // Where the item and the one behind the edge are along it, and how much farther from it the item is.
    struct Hinge {
        Parallelogram triangle;
        double along, across, ratio;
    };
    static constexpr double most = 4;  // farther than that is a guess no more

    double at(int32_t item, size_t d) const { return points_[3 * static_cast<size_t>(item) + d]; }

    double square(int32_t a, int32_t b) const {
        double sum = 0;
        for (size_t d = 0; d < 3; ++d) sum += (at(b, d) - at(a, d)) * (at(b, d) - at(a, d));
        return sum;
    }

    void add(int32_t v, const Parallelogram& p) {
        if (p.across < 0) return;
        double ee = 0, ev = 0, ec = 0;
        for (size_t d = 0; d < 3; ++d) {
            const double edge = at(p.b, d) - at(p.a, d);
            ee += edge * edge;
            ev += edge * (at(v, d) - at(p.a, d));
            ec += edge * (at(p.across, d) - at(p.a, d));
        }
        if (!(ee > 1e-200 && ee < 1e200)) return;
        const double along = ev / ee, across = ec / ee;
        const double height = square(p.a, v) / ee - along * along, behind = square(p.a, p.across) / ee - across * across;
        if (!(behind > 1e-9 && height < most * most * behind && std::abs(along) < most && std::abs(across) < most)) return;
        hinges_[n_hinges_++] = {p, along, across, height > 0 ? std::sqrt(height / behind) : 0.0};
    }

    std::span<const double> points_;
    std::array<double, 3> away_{};
    std::array<double, Neighbourhood::max_neighbours> nearness_{};
    std::array<Hinge, Neighbourhood::max_triangles> hinges_{};
    size_t n_hinges_ = 0;
    double total_ = 0, n_neighbours_ = 0;
};

}  // namespace ebz::attributes
