#include "normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "octahedron.hpp"

namespace ebz::attributes {

namespace {

// Zeros where there is no direction.
Vector3 direction(const Vector3& v) {
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(std::isfinite(length) && length > 0)) return {};
    return {v[0] / length, v[1] / length, v[2] / length};
}

// Between two unit vectors, by the tangent of half of it; opposite directions make almost half a turn.
double angle(const Vector3& u, const Vector3& v) {
    constexpr int n_halvings = 3, n_terms = 12;  // the argument of the series is below 0.2
    const Vector3 w = cross(u, v);
    const double sine = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double cosine = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    double half = sine / std::max(1 + cosine, 1e-12);
    for (int i = 0; i < n_halvings; ++i) half = half / (1 + std::sqrt(1 + half * half));
    const double square = half * half;
    double arc = 0;
    for (int term = n_terms - 1; term >= 0; --term) arc = 1.0 / (2 * term + 1) - square * arc;
    return 16 * half * arc;
}

class Normals {
public:
    Normals(const CornersInSpace& corners, NormalWeights weights)
        : corners_(corners), weights_(weights), sums_(3 * static_cast<size_t>(corners.n)) {}

    std::vector<double> of_faces() {
        for (int32_t f = 0; f < n_faces(); ++f) set(f, of_face(f));
        return std::move(sums_);
    }

    std::vector<double> of_corners() {
        for (int32_t f = 0; f < n_faces(); ++f) add(f, of_face(f));
        if (!weights_.as_sums)
            for (int32_t i = 0; i < corners_.n; ++i) set(i, direction({sums_[at(i)], sums_[at(i) + 1], sums_[at(i) + 2]}));
        return std::move(sums_);
    }

private:
    static size_t at(int32_t i) { return 3 * static_cast<size_t>(i); }

    int32_t n_faces() const {
        return static_cast<int32_t>(corners_.offsets.empty() ? corners_.vertex.size() / 3 : corners_.offsets.size() - 1);
    }
    int32_t first(int32_t f) const { return corners_.offsets.empty() ? 3 * f : corners_.offsets[static_cast<size_t>(f)]; }

    Vector3 point(int32_t c) const {
        const size_t p = at(corners_.vertex[static_cast<size_t>(c)]);
        return {corners_.points[p], corners_.points[p + 1], corners_.points[p + 2]};
    }

    // The sum over the triangles of a fan around the first corner.
    Vector3 of_face(int32_t f) const {
        const int32_t begin = first(f), end = first(f + 1);
        if (end - begin < 3) return {};
        const Vector3 o = point(begin);
        Vector3 edge = difference(point(begin + 1), o), result{};
        for (int32_t c = begin + 2; c < end; ++c) {
            const Vector3 next = difference(point(c), o), product = cross(edge, next);
            result = c == begin + 2 ? product : sum(result, product);
            edge = next;
        }
        return weighted(result);
    }

    Vector3 weighted(const Vector3& product) const { return weights_.by_area ? product : direction(product); }

    void set(int32_t i, const Vector3& v) { std::copy(v.begin(), v.end(), sums_.begin() + static_cast<ptrdiff_t>(at(i))); }

    void add(int32_t f, const Vector3& normal) {
        const int32_t begin = first(f), end = first(f + 1);
        for (int32_t c = begin; c < end; ++c) {
            const auto [to_after, to_before] = edges_at(c, begin, end);
            const double weight = weights_.by_angle ? angle(direction(to_after), direction(to_before)) : 1.0;
            const Vector3 here = weights_.by_corner ? weighted(cross(to_after, to_before)) : normal;
            const size_t i = at(corners_.item[static_cast<size_t>(c)]);
            for (size_t d = 0; d < 3; ++d) {
                const double x = here[d] * weight;
                sums_[i + d] += std::isfinite(x) ? x : 0.0;
            }
        }
    }

    // To the next corner of the face, and to the previous.
    std::array<Vector3, 2> edges_at(int32_t c, int32_t begin, int32_t end) const {
        const int32_t after = c + 1 < end ? c + 1 : begin, before = (c > begin ? c : end) - 1;
        const Vector3 o = point(c);
        return {difference(point(after), o), difference(point(before), o)};
    }

    const CornersInSpace& corners_;
    NormalWeights weights_;
    std::vector<double> sums_;
};

}  // namespace

std::vector<double> normals(const CornersInSpace& corners, NormalWeights weights) {
    Normals of(corners, weights);
    return corners.item.empty() ? of.of_faces() : of.of_corners();
}

}  // namespace ebz::attributes
