// Where a vertex is expected, from its surroundings, and how far off neighbours were.
//
// The covariance is that of a Gaussian, wide along the tangent plane and narrow along the normal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "axis_order.hpp"
#include "least_squares.hpp"
#include "surroundings.hpp"

namespace ebz::positions {

// How the residual of a coded vertex came out.
struct Trace {
    std::array<float, 3> error;       // |position - plain prediction|
    std::array<float, 3> residual;    // position - refined prediction
    float size, refined_size;         // sums over axes
    float normal_size, tangent_size;  // of the plain prediction's error
    std::array<bool, 3> exact;        // the coded residual was zero
    bool coded;
};

struct Prediction {
    Point plain, weighted, neighbours, fitted, refined;  // relative to the surroundings' origin
    Point spread, error;
    Point normal;  // unit, or zero if unknown
    double size, refined_size, normal_size, tangent_size;
    std::array<int, 3> n_exact;  // neighbours whose coded residual was zero
    int n_traces;
    std::array<std::array<double, 3>, 3> covariance;
    std::array<size_t, 3> axes;  // in order of coding
};

inline Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point operator*(const Point& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

class Predictor {
public:
    Predictor(size_t n_vertices, AxisOrder order) : order_(order), traces_(n_vertices) {
        const Fit::Vector parallelogram{-1, 0, 0, 0, 0, 0};
        fits_.fill(Fit(parallelogram, 0.5, 6000));
        blends_.fill(Blend(Blend::Vector{0.7, 0, 0, 0}, 0.5, 6000));
    }

    const Trace& trace(int32_t v) const { return traces_[static_cast<size_t>(v)]; }

    void predict(const Surroundings& s, Prediction& p);
    void learn(int32_t v, const Surroundings& s, const Prediction& p, const Point& position,
               const std::array<int64_t, 3>& residual);

private:
    using Fit = LeastSquares<6>;
    using Blend = LeastSquares<4>;

    void average(const Surroundings& s, Prediction& p);
    void fit(const Surroundings& s, Prediction& p);
    void blend(const Surroundings& s, Prediction& p);
    void scales(const Surroundings& s, Prediction& p) const;
    void tangent_plane(Prediction& p) const;
    void order_axes(Prediction& p) const;
    Blend::Vector blend_inputs(const Prediction& p, size_t d) const;

    AxisOrder order_;
    std::vector<Trace> traces_;
    std::array<Fit, 16> fits_;  // by known wings
    std::array<Blend, 8> blends_;
    double recent_size_ = 8;
    uint32_t n_learnt_ = 0;
    // Inputs of the fits, kept from predict() for learn().
    std::array<std::array<Fit::Vector, 3>, Surroundings::max_parallelograms> inputs_;
    std::array<Point, Surroundings::max_parallelograms> midpoints_;
    Point drift_{};  // mean residual of the neighbours
};

}  // namespace ebz::positions
