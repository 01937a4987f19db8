// Normals of a surface are off because its vertices are: rounded, they lie a little above or below where
// they were.  How far each is off is learnt from the normals that are known.
//
// Reference: R. E. Kalman, "A new approach to linear filtering and prediction problems", 1960; the
// covariance of heights is kept diagonal, so that a vertex takes time in proportion to its faces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../positions/surface.hpp"
#include "attributes.hpp"
#include "direction.hpp"

namespace ebz::attributes {

class NormalErrors {
public:
    NormalErrors(const Items& items, bool by_area, const positions::CornersOfVertices& corners)
        : items_(items), by_area_(by_area), corners_(corners), heights_(n_places(items)) {}

    // What must be added to the guess of an item.  grain: how the lattice of normals is felt there.
    Vector3 change(int32_t v, const Vector3& guess, const Variation& grain) {
        variation_ = grain_ = grain;
        mean_ = {};
        n_around_ = 0;
        shape_ = 0;
        if (gather(v)) weigh(guess);
        if (merit_ <= 0) return {};
        return sum(scaled(variation_.first, mean_[0]), scaled(variation_.second, mean_[1]));
    }

    // How the normal varies about that.
    const Variation& variation() const { return variation_; }

    // actual: the normal at the item expected last.
    void learn(const Vector3& guess, const Vector3& actual) {
        const Vector3 off = difference(actual, guess);
        const double whole_x = dot(off, variation_.first), whole_y = dot(off, variation_.second);
        const double x = whole_x - mean_[0], y = whole_y - mean_[1];
        const double without = whole_x * whole_x + whole_y * whole_y, with = x * x + y * y;
        if (!(with < 4)) return;
        merit_ += ((without - with) / (without + with + grain_.xx + grain_.yy) - merit_) * 0.01;
        correct(x, y);
        learn_scale(std::min(with, farthest * (variation_.xx + variation_.yy)));
    }

private:
    static constexpr size_t max_around = 32;
    static constexpr double least_variance = 0.05, farthest = 16, usual = 6;

    void weigh(const Vector3& guess) {
        double xx = 0, xy = 0, yy = 0;
        for (size_t i = 0; i < n_around_; ++i) {
            Around& at = around_[i];
            const Vector3 moved = scaled(cross(guess, at.edges), 1 / length_);
            at.x = dot(moved, variation_.first);
            at.y = dot(moved, variation_.second);
            const Height& h = heights_[at.place];
            mean_[0] += h.mean * at.x;
            mean_[1] += h.mean * at.y;
            xx += h.variance * at.x * at.x;
            xy += h.variance * at.x * at.y;
            yy += h.variance * at.y * at.y;
        }
        shape_ = xx + yy;
        variation_.xx += scale_ * xx;
        variation_.xy += scale_ * xy;
        variation_.yy += scale_ * yy;
    }

    // Of a vertex above the surface; the variance in units of scale_.
    struct Height {
        double mean = 0, variance = 1;
    };
    // How the normal depends on the height of one of the vertices around.
    struct Around {
        size_t place;
        Vector3 edges;
        double x, y;
    };

    static size_t n_places(const Items& items) {
        int32_t n = items.n;
        for (const int32_t s : items.site) n = std::max(n, s + 1);
        return static_cast<size_t>(n);
    }

    size_t place(int32_t item) const {
        const auto at = static_cast<size_t>(item);
        return items_.site.empty() ? at : static_cast<size_t>(items_.site[at]);
    }

    Vector3 point(int32_t item) const {
        const size_t at = 3 * static_cast<size_t>(item);
        return {items_.points[at], items_.points[at + 1], items_.points[at + 2]};
    }

    // The edges whose products with heights move the normal, by vertex.
    bool gather(int32_t v) {
        Vector3 normal{};
        for (const int32_t c : corners_[v]) {
            const int32_t a = items_.item[static_cast<size_t>(positions::next(c))];
            const int32_t b = items_.item[static_cast<size_t>(positions::previous(c))];
            const Vector3 p = point(v), to_a = difference(point(a), p), to_b = difference(point(b), p);
            const Vector3 product = cross(to_a, to_b);
            const double square = dot(product, product);
            if (!(square > 1e-200 && square < 1e200)) continue;
            const double weight = by_area_ ? 1.0 : 1 / std::sqrt(square);
            normal = sum(normal, scaled(product, weight));
            add(place(a), scaled(to_b, weight));
            add(place(b), scaled(to_a, -weight));
            if (!by_area_) add(place(v), scaled(difference(to_a, to_b), weight));
        }
        const double square = dot(normal, normal);
        length_ = square > 1e-200 && square < 1e200 ? std::sqrt(square) : 0;
        if (length_ == 0) n_around_ = 0;
        return n_around_ > 0;
    }

    void add(size_t place, const Vector3& edges) {
        size_t i = 0;
        while (i < n_around_ && around_[i].place != place) ++i;
        if (i == max_around) return;
        if (i == n_around_) around_[n_around_++] = {place, {}, 0, 0};
        around_[i].edges = sum(around_[i].edges, edges);
    }

    void correct(double x, double y) {
        const double determinant = variation_.xx * variation_.yy - variation_.xy * variation_.xy;
        if (!(determinant > 1e-300)) return;
        const double to_x = (variation_.yy * x - variation_.xy * y) / determinant;
        const double to_y = (variation_.xx * y - variation_.xy * x) / determinant;
        // What is far off has another reason.
        const double weight = std::min((usual + 2) / (usual + to_x * x + to_y * y), 1.0);
        for (size_t i = 0; i < n_around_; ++i) {
            const Around& at = around_[i];
            Height& h = heights_[at.place];
            const double gain = weight * scale_ * h.variance;
            h.mean += gain * (at.x * to_x + at.y * to_y);
            const double told = variation_.yy * at.x * at.x - 2 * variation_.xy * at.x * at.y + variation_.xx * at.y * at.y;
            h.variance = std::max(h.variance * (1 - gain * told / determinant), least_variance);
        }
    }

    // The variance of heights, from how far off normals were.
    void learn_scale(double square) {
        squares_ += square - grain_.xx - grain_.yy;
        shapes_ += shape_;
        if (shapes_ > 0) scale_ = std::max(squares_ / shapes_, 0.0);
    }

    const Items& items_;
    bool by_area_;
    const positions::CornersOfVertices& corners_;
    std::vector<Height> heights_;
    double scale_ = 0, squares_ = 0, shapes_ = 0;
    double merit_ = 0;  // of corrections: from -1, they spoil all guesses, to 1

    // The item under way.
    std::array<Around, max_around> around_;
    size_t n_around_ = 0;
    double length_ = 0, shape_ = 0;
    std::array<double, 2> mean_{};
    Variation grain_, variation_;
};

}  // namespace ebz::attributes
