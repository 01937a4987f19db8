// Online weighted least squares with forgetting, a prior, and solutions at growing intervals.
#pragma once

#include <array>
#include <cstddef>

namespace ebz::positions {

// The w that minimises sum weight (y - w x)^2 + ridge |w - prior|^2, by Cholesky's L D L' factorisation.
// a: sums of weight x[i] x[j] for j <= i; b: of weight x[i] y.
template <size_t D>
std::array<double, D> ridge_solution(const std::array<std::array<double, D>, D>& a, const std::array<double, D>& b,
                                     const std::array<double, D>& prior, double ridge) {
    std::array<std::array<double, D>, D> l;
    std::array<double, D> d, w;
    for (size_t i = 0; i < D; ++i) {
        w[i] = b[i] + ridge * prior[i];
        for (size_t j = 0; j <= i; ++j) {
            double sum = a[i][j] + (i == j ? ridge : 0.0);
            for (size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k] * d[k];
            if (i == j) d[i] = sum > 0.5 * ridge ? sum : 0.5 * ridge;  // positive up to rounding
            else l[i][j] = sum / d[j];
        }
        for (size_t k = 0; k < i; ++k) w[i] -= l[i][k] * w[k];
    }
    for (size_t i = 0; i < D; ++i) w[i] /= d[i];
    for (size_t i = D; i-- > 0;)
        for (size_t k = i + 1; k < D; ++k) w[i] -= l[k][i] * w[k];
    return w;
}

// After n observations, until they are solved for again.
inline int least_squares_interval(int n) { return n < 4 ? 1 : n < 128 ? n / 4 : 32; }

template <size_t D>
class LeastSquares {
public:
    using Vector = std::array<double, D>;

    LeastSquares() = default;
    LeastSquares(const Vector& prior, double ridge, int window) : w_(prior), prior_(prior), ridge_(ridge), window_(window) {}

    double predict(const Vector& x) const {
        double sum = 0;
        for (size_t i = 0; i < D; ++i) sum += w_[i] * x[i];
        return sum;
    }

    bool seasoned() const { return n_ > 1000; }

    void add(const Vector& x, double y, double weight) { add(std::array<Vector, 1>{x}, std::array{y}, weight); }

    // Several observations of one weight; sums are in their order.
    template <size_t n>
    void add(const std::array<Vector, n>& x, const std::array<double, n>& y, double weight) {
        for (size_t i = 0; i < D; ++i) {
            std::array<double, n> wx;
            for (size_t k = 0; k < n; ++k) wx[k] = weight * x[k][i];
            for (size_t j = 0; j <= i; ++j)
                for (size_t k = 0; k < n; ++k) a_[i][j] += wx[k] * x[k][j];
            for (size_t k = 0; k < n; ++k) b_[i] += wx[k] * y[k];
        }
    }

    // To be called once per observed vertex; solves after 1, 2, 3, 4, 6, 8, 12, ... of them.
    void tick() {
        if (++n_ < due_) return;
        w_ = ridge_solution(a_, b_, prior_, ridge_);
        due_ = n_ + least_squares_interval(n_);
        if (n_ >= 128) {
            const double keep = 1.0 - 32.0 / window_;
            for (auto& row : a_)
                for (double& x : row) x *= keep;
            for (double& x : b_) x *= keep;
        }
    }

private:
    std::array<Vector, D> a_{};
    Vector b_{}, w_{}, prior_{};
    double ridge_ = 1;
    int window_ = 2000, n_ = 0, due_ = 1;
};

}  // namespace ebz::positions
