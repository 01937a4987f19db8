// Unit vectors near a guess: how errors across the sphere spread over components that are coded in turn.
//
// The second component is expected to follow the first by their covariance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "octahedron.hpp"

namespace ebz::attributes {

// How a unit vector varies in the plane that touches the sphere there.
struct Variation {
    Vector3 first{}, second{};  // axes of the plane
    double xx = 1, xy = 0, yy = 1;

    // Alike in all directions; zero axes where there is no normal.
    static Variation about(const Vector3& normal) {
        size_t least = 0;
        for (size_t d = 1; d < 3; ++d)
            if (std::abs(normal[d]) < std::abs(normal[least])) least = d;
        Vector3 axis{};
        axis[least] = 1;
        const Vector3 first = unit(cross(normal, axis));
        return {first, cross(normal, first)};
    }

    // What rounding to the integers of linear functions u and v adds.
    static Variation of_lattice(const Vector3& normal, const Vector3& u, const Vector3& v) {
        Variation result = about(normal);
        const double ux = dot(u, result.first), uy = dot(u, result.second), vx = dot(v, result.first), vy = dot(v, result.second);
        const double determinant = ux * vy - uy * vx, square = 12 * determinant * determinant;
        if (!(square > 0)) return result;
        result.xx = (vy * vy + uy * uy) / square;
        result.xy = -(vx * vy + ux * uy) / square;
        result.yy = (vx * vx + ux * ux) / square;
        return result;
    }

    // The covariance of two linear functions of the vector.
    double covariance(const Vector3& f, const Vector3& g) const {
        const double fx = dot(f, first), fy = dot(f, second), gx = dot(g, first), gy = dot(g, second);
        return xx * fx * gx + xy * (fx * gy + fy * gx) + yy * fy * gy;
    }
};

struct Direction {
    double slope = 0;  // of the second component's error over the first's
    std::array<double, 2> spread = {1, 1};  // of the first, and of the second given the first

    // Components of a vector of length `total`: the first two that are coded.
    static Direction of_vector(const Variation& v, size_t first, size_t second, double total) {
        Vector3 f{}, g{};
        f[first] = total;
        g[second] = total;
        return of_rows(v, f, g);
    }

    static Direction of_octahedron(const Variation& variation, const OctahedronRows& rows) {
        return of_rows(variation, rows.u, rows.v);
    }

private:
    static Direction of_rows(const Variation& variation, const Vector3& f, const Vector3& g) {
        const double ff = variation.covariance(f, f), gg = variation.covariance(g, g), fg = variation.covariance(f, g);
        if (!(ff + gg > 0)) return {};
        const double least = 1e-4 * (ff + gg), first = std::max(ff, least);
        const double rest = std::max(gg - fg * fg / first, least);
        return {fg / first, {std::sqrt(first), std::sqrt(rest)}};
    }
};

}  // namespace ebz::attributes
