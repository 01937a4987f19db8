// Unit vectors on the unfolded octahedron, as codec/attributes/octahedral.py has them.
#pragma once

#include <array>
#include <cmath>

namespace ebz::attributes {

using Vector3 = std::array<double, 3>;

inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Vector3 scaled(const Vector3& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }

inline Vector3 sum(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

inline Vector3 difference(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// Zero where there is no direction.
inline Vector3 unit(const Vector3& a) {
    const double square = dot(a, a);
    return square > 1e-200 && square < 1e200 ? scaled(a, 1 / std::sqrt(square)) : Vector3{};
}

// The square has the sides 2 half; the point may be anywhere on it.
inline Vector3 from_octahedron(double u, double v, double half) {
    double x = u / half - 1, y = v / half - 1;
    const double z = 1 - std::abs(x) - std::abs(y), below = z < 0 ? -z : 0;
    x = x < 0 ? x + below : x - below;
    y = y < 0 ? y + below : y - below;
    return unit({x, y, z});
}

inline std::array<double, 2> to_octahedron(const Vector3& a, double half) {
    const double size = std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]);
    if (!(size > 0)) return {half, half};
    const double x = a[0] / size, y = a[1] / size;
    if (a[2] >= 0) return {(x + 1) * half, (y + 1) * half};
    const double u = x >= 0 ? 1 - std::abs(y) : std::abs(y) - 1, v = y >= 0 ? 1 - std::abs(x) : std::abs(x) - 1;
    return {(u + 1) * half, (v + 1) * half};
}

// How a point of the square moves with the unit vector: the derivatives of u and v.
struct OctahedronRows {
    Vector3 u{}, v{};

    OctahedronRows(const std::array<double, 2>& at, double half) {
        double x = at[0] / half - 1, y = at[1] / half - 1;
        const double z = 1 - std::abs(x) - std::abs(y);
        const bool below = z < 0;
        const double sx = x < 0 ? -1 : 1, sy = y < 0 ? -1 : 1, sz = below ? -1 : 1;
        if (below) {
            x += sx * z;
            y += sy * z;
        }
        const double size = half * std::sqrt(x * x + y * y + z * z);
        const Vector3 of_x = scaled({1 - x * sx, -x * sy, -x * sz}, size), of_y = scaled({-y * sx, 1 - y * sy, -y * sz}, size);
        // Below, u falls where y grows outwards, and v where x does.
        const double sign = -sx * sy;
        u = below ? scaled(of_y, sign) : of_x;
        v = below ? scaled(of_x, sign) : of_y;
    }
};

}  // namespace ebz::attributes
