// Texture coordinates from geometry: triangles keep about their shape in the plane of the texture.
//
// Reference: M. Isenburg and J. Snoeyink, "Compressing texture coordinates with selective linear
// predictions", 2003; Draco predicts alike.  Here the triangles around are averaged, and the side comes
// from the triangle behind the edge, else from what was frequent before.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "attributes.hpp"
#include "neighbourhood.hpp"

namespace ebz::attributes {

class TextureMap {
public:
    struct Guess {
        std::array<double, 2> value{};
        bool is_there = false;
    };

    template <class Value>
    Guess predict(const Items& items, int32_t v, const Neighbourhood& around, std::span<const int64_t> values, Value value) const {
        Guess mean;
        int n = 0;
        for (size_t i = 0; i < around.n_triangles; ++i) {
            const Parallelogram& p = around.triangles[i];
            Shape s;
            if (!shape(items, v, p, s)) continue;
            const Vector a = pair(values, p.a, value), b = pair(values, p.b, value), d = {b[0] - a[0], b[1] - a[1]};
            double side = turns_ < 0 ? -1 : 1;
            if (p.across >= 0) {
                const double behind = area(a, b, pair(values, p.across, value));
                if (behind != 0) side = behind > 0 ? -1 : 1;
            }
            mean.value[0] += a[0] + s.along * d[0] - side * s.height * d[1];
            mean.value[1] += a[1] + s.along * d[1] + side * s.height * d[0];
            ++n;
        }
        if (n == 0) return mean;
        for (double& x : mean.value) x /= n;
        mean.is_there = std::abs(mean.value[0]) < 1e150 && std::abs(mean.value[1]) < 1e150;
        return mean;
    }

    template <class Value>
    void learn(const Items&, int32_t v, const Neighbourhood& around, std::span<const int64_t> values, Value value) {
        for (size_t i = 0; i < around.n_triangles; ++i) {
            const Parallelogram& p = around.triangles[i];
            const double side = area(pair(values, p.a, value), pair(values, p.b, value), pair(values, v, value));
            turns_ += side > 0 ? 1 : side < 0 ? -1 : 0;
            turns_ = turns_ > 100 ? 100 : turns_ < -100 ? -100 : turns_;
        }
    }

private:
    using Vector = std::array<double, 2>;
    struct Shape {
        double along, height;  // of the tip, in units of the edge from a to b
    };

    static bool shape(const Items& items, int32_t v, const Parallelogram& p, Shape& out) {
        const auto at = [&](int32_t item, size_t d) { return items.points[3 * static_cast<size_t>(item) + d]; };
        double ee = 0, et = 0, tt = 0;
        for (size_t d = 0; d < 3; ++d) {
            const double edge = at(p.b, d) - at(p.a, d), tip = at(v, d) - at(p.a, d);
            ee += edge * edge;
            et += edge * tip;
            tt += tip * tip;
        }
        if (!(ee > 1e-200 && ee < 1e200 && tt < 1e200)) return false;
        out.along = et / ee;
        const double square = tt / ee - out.along * out.along;
        out.height = square > 0 ? std::sqrt(square) : 0.0;
        return true;
    }

    template <class Value>
    static Vector pair(std::span<const int64_t> values, int32_t item, Value value) {
        return {value(values[2 * static_cast<size_t>(item)]), value(values[2 * static_cast<size_t>(item) + 1])};
    }

    static double area(const Vector& a, const Vector& b, const Vector& c) {
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }

    int turns_ = 0;  // how much more often the tip was left of the edge
};

}  // namespace ebz::attributes
