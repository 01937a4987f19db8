// What is known around a vertex before its position is coded by the light method.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gate_order.hpp"
#include "lanes.hpp"
#include "surface.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// x, y, z and a lane that does not matter.  Sums of coordinates are exact in doubles.
using Axes4 = double __attribute__((vector_size(32)));
using AxisInts = int64_t __attribute__((vector_size(32)));

inline Axes4 magnitudes(Axes4 x) {
    constexpr int64_t all = INT64_MAX;
    return reinterpret_cast<Axes4>(reinterpret_cast<AxisInts>(x) & AxisInts{all, all, all, all});
}
inline Axes4 rotated(Axes4 x) { return __builtin_shufflevector(x, x, 1, 2, 0, 3); }
inline Axes4 cross(Axes4 u, Axes4 w) { return rotated(u * rotated(w) - rotated(u) * w); }
inline double dot(Axes4 u, Axes4 w) {
    const Axes4 x = u * w;
    return x[0] + x[1] + x[2];
}

// What coding a vertex left behind for its neighbours; all 0 for a seed.
struct LightTrace {
    Lanes size{};           // magnitudes of the residuals, and 1
    Lanes residual{};       // from the plain prediction
    uint32_t exact = 0;     // a byte per axis: 1 if the value was expected exactly
    uint32_t residuals = 0; // a byte per axis, clamped
};

// In arrays, so that they are aligned whatever the instruction set.
struct alignas(32) LightPoint {
    LightPoint() : at{} {}  // GCC fails on an implicit one without optimisation
    Axes4 at;
};

struct LightSurroundings {
    static constexpr size_t max_neighbours = 8, max_tips = 4, max_codes = 2;

    Axes4 tips_sum, spread, normal, ahead, behind, beside, neighbours_sum;
    Lanes size, drift;
    std::array<Axes4, max_neighbours> neighbours;
    std::array<Axes4, max_tips> tips;
    std::array<uint32_t, max_codes> codes;
    uint32_t exact;  // neighbours whose value was expected exactly, a byte per axis
    int n_neighbours, n_parallelograms, n_behind, n_beside;

    size_t n_kept() const { return std::min<size_t>(static_cast<size_t>(n_neighbours), max_neighbours); }
    size_t n_tips() const { return std::min<size_t>(static_cast<size_t>(n_parallelograms), max_tips); }
};

class LightSurveyor {
public:
    explicit LightSurveyor(const Surface& mesh)
        : mesh_(mesh), corners_(mesh), known_(static_cast<size_t>(mesh.n_vertices)), points_(known_.size()), traces_(known_.size()) {}

    // Whether it has been settled.
    bool known(int32_t v) const { return known_[static_cast<size_t>(v)] != 0; }

    void survey(int32_t v, LightSurroundings& s) const {
        s.tips_sum = s.spread = s.normal = s.ahead = s.behind = s.beside = s.neighbours_sum = Axes4{};
        s.size = s.drift = Lanes{};
        s.codes.fill(0xffffffff);
        s.exact = 0;
        s.n_neighbours = s.n_parallelograms = s.n_behind = s.n_beside = 0;
        for (int32_t c : corners_[v]) {
            const int32_t a = vertex(next(c)), b = vertex(previous(c));
            const bool knows_a = known(a), knows_b = known(b);
            if (knows_a) add_neighbour(s, a);
            if (knows_b && opposite(previous(c)) < 0) add_neighbour(s, b);
            if (knows_a && knows_b) add_parallelogram(s, c, a, b);
        }
    }

    void prefetch(const PredictedVertex& v) const {
        for (const int32_t u : {v.vertex, v.a, v.b, v.o, v.c, v.d, v.p}) {
            __builtin_prefetch(&points_[static_cast<size_t>(u)]);
            __builtin_prefetch(&traces_[static_cast<size_t>(u)]);
        }
    }

    void settle(int32_t v, const int64_t* position, const LightTrace& trace) {
        Axes4& point = points_[static_cast<size_t>(v)].at;
        for (size_t d = 0; d < 3; ++d) point[d] = static_cast<double>(std::clamp(position[d], -farthest, farthest));
        traces_[static_cast<size_t>(v)] = trace;
        known_[static_cast<size_t>(v)] = 1;
    }

private:
    // Valid coordinates are far less; so sums of a few fit 64 bits.
    static constexpr int64_t farthest = int64_t{1} << 58;

    int32_t vertex(int32_t c) const { return mesh_.vertex[static_cast<size_t>(c)]; }
    int32_t opposite(int32_t c) const { return mesh_.opposite[static_cast<size_t>(c)]; }
    const Axes4& point(int32_t v) const { return points_[static_cast<size_t>(v)].at; }

    void add_neighbour(LightSurroundings& s, int32_t u) const {
        const auto i = static_cast<size_t>(s.n_neighbours++);
        const LightTrace& trace = traces_[static_cast<size_t>(u)];
        s.size += trace.size;
        s.neighbours_sum += point(u);
        s.drift += trace.residual;
        if (i >= s.max_neighbours) return;
        s.neighbours[i] = point(u);
        s.exact += trace.exact;
        if (i < s.max_codes) s.codes[i] = trace.residuals;
    }

    void add_parallelogram(LightSurroundings& s, int32_t c, int32_t a, int32_t b) const {
        const int32_t across = opposite(next(c));
        if (across < 0) return;
        const int32_t apex = vertex(previous(across));
        if (!known(apex)) return;
        const Axes4 pa = point(a), pb = point(b), o = point(apex), tip = pa + pb - o;
        const auto i = static_cast<size_t>(s.n_parallelograms++);
        if (i > 0) s.spread += magnitudes(tip - s.tips[(i - 1) % s.max_tips]);
        s.tips[i % s.max_tips] = tip;
        s.tips_sum += tip;
        s.normal += cross(pa - o, pb - o);
        const Axes4 middle = (pa + pb) * 0.5;
        s.ahead += middle - o;
        add_wing(next(across), middle, s.behind, s.n_behind);
        add_wing(previous(across), middle, s.behind, s.n_behind);
        add_wing(c, middle, s.beside, s.n_beside);
        add_wing(previous(c), middle, s.beside, s.n_beside);
    }

    void add_wing(int32_t edge, Axes4 middle, Axes4& sum, int& n) const {
        const int32_t across = opposite(edge);
        if (across < 0) return;
        const int32_t u = vertex(previous(across));
        if (!known(u)) return;
        sum += point(u) - middle;
        ++n;
    }

    const Surface& mesh_;
    const CornersOfVertices corners_;
    std::vector<uint8_t> known_;
    std::vector<LightPoint> points_;
    std::vector<LightTrace> traces_;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
