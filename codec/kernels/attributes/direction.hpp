// Unit vectors near a guess: how errors across the sphere spread over components that are coded in turn.
//
// An error perpendicular to the guess n, alike in all directions, has the covariance I - n n^T; the second
// component is expected to follow the first by their covariance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ebz::attributes {

struct Direction {
    double slope = 0;  // of the second component's error over the first's
    std::array<double, 2> spread = {1, 1};  // of the first, and of the second given the first

    // Components of a vector by turns.
    static Direction of_vector(const std::array<double, 3>& guess) {
        const double square = guess[0] * guess[0] + guess[1] * guess[1] + guess[2] * guess[2];
        if (!(square > 1e-200 && square < 1e200)) return {};
        const double length = std::sqrt(square), a = guess[0] / length, b = guess[1] / length;
        return of_rows({1 - a * a, 1 - b * b, -a * b});
    }

    // Points of the unfolded octahedron, in units of `half`, its centre.
    static Direction of_octahedron(double u, double v, double half) {
        double x = u / half - 1, y = v / half - 1;
        const double z = 1 - std::abs(x) - std::abs(y);
        const bool below = z < 0;
        const double sx = x < 0 ? -1 : 1, sy = y < 0 ? -1 : 1, sz = below ? -1 : 1;
        if (below) {
            x += sx * z;
            y += sy * z;
        }
        // Rows of the derivative of x and y of the point where a vector meets the octahedron.
        const std::array<double, 3> to_x = {1 - x * sx, -x * sy, -x * sz}, to_y = {-y * sx, 1 - y * sy, -y * sz};
        const double square = x * x + y * y + z * z;
        const double xx = dot(to_x, to_x), yy = dot(to_y, to_y), xy = dot(to_x, to_y);
        // Below, u follows y and v follows x.
        return of_rows(below ? Covariance{square * yy, square * xx, square * xy}
                             : Covariance{square * xx, square * yy, square * xy});
    }

private:
    struct Covariance {
        double first, second, both;
    };

    static double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    static Direction of_rows(const Covariance& c) {
        constexpr double least = 1e-4;
        const double first = std::max(c.first, least);
        const double rest = std::max(c.second - c.both * c.both / first, least);
        return {c.both / first, {std::sqrt(first), std::sqrt(rest)}};
    }
};

}  // namespace ebz::attributes
