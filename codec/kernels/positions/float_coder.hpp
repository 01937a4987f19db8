// Floats that lie on no lattice: predicted in floating point, residuals in units of the last place.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "../entropy/integers.hpp"
#include "spaces.hpp"
#include "traversal.hpp"

namespace ebz::positions {

// What is known around a vertex before its position is coded.
template <class Space>
struct Neighbourhood {
    std::array<typename Space::Sum, 3> sum{};
    int n = 0;
    uint64_t residual = 0;  // magnitudes at the known neighbours, saturated
    int n_residuals = 0;
    bool on_parallelograms = false;
};

// One path for both sides: an encoder codes the values that are there, a decoder fills them in.
template <class Space, class Coder>
class FloatCoder {
public:
    FloatCoder(const Surface& surface, std::span<int64_t> values, Coder& coder)
        : surface_(surface),
          corners_(surface),
          traversal_(surface, corners_),
          values_(values),
          magnitude_(surface.n_vertices),
          coder_(coder) {}

    void run() {
        for (Index v = traversal_.next_vertex(); v != none; v = traversal_.next_vertex()) {
            code(v);
            previous_ = v;
        }
    }

private:
    using Sum = typename Space::Sum;
    static constexpr int max_terms = 64, n_scales = 34;

    void code(Index v) {
        const Neighbourhood<Space> around = look_around(v);
        const int scale = around.n_residuals
            ? std::min(n_scales - 1, static_cast<int>(std::bit_width(around.residual / around.n_residuals)) + 1)
            : 0;
        uint64_t total = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int64_t predicted = Space::mean(around.sum[axis], around.n);
            total += code_residual(values_[3 * v + axis], predicted, axis, scale, around.on_parallelograms);
        }
        magnitude_[v] = static_cast<uint32_t>(std::min<uint64_t>(total, UINT32_MAX));
    }

    uint64_t code_residual(int64_t& value, int64_t predicted, int axis, int scale, bool on_parallelograms) {
        IntegerModel& model = models_[on_parallelograms][axis][scale];
        const uint64_t residual = static_cast<uint64_t>(value) - static_cast<uint64_t>(predicted);
        const uint64_t coded = model.code(coder_, zigzag(static_cast<int64_t>(residual)));
        value = static_cast<int64_t>(static_cast<uint64_t>(predicted) + static_cast<uint64_t>(unzigzag(coded)));
        return std::min<uint64_t>(coded >> 1, UINT32_MAX);
    }

    Neighbourhood<Space> look_around(Index v) const {
        Neighbourhood<Space> around;
        for (const Index c : corners_[v]) {
            if (around.n < max_terms) add_parallelogram(around, v, c);
        }
        around.on_parallelograms = around.n > 0;
        for (const Index c : corners_[v]) {
            add_neighbour(around, surface_.vertex[next(c)]);
            add_neighbour(around, surface_.vertex[previous(c)]);
        }
        if (around.n == 0) add_last(around);
        return around;
    }

    // a + b - tip, over the edge ab across from v.
    void add_parallelogram(Neighbourhood<Space>& around, Index v, Index c) const {
        const Index a = surface_.vertex[next(c)], b = surface_.vertex[previous(c)];
        const Index tip = tip_across(next(c));
        if (tip == none || tip == v || !known(a) || !known(b) || !known(tip)) return;
        for (int axis = 0; axis < 3; ++axis) {
            around.sum[axis] += at(a, axis) + at(b, axis) - at(tip, axis);
        }
        ++around.n;
    }

    void add_neighbour(Neighbourhood<Space>& around, Index u) const {
        if (!known(u) || around.n_residuals == max_terms) return;
        around.residual += magnitude_[u];
        ++around.n_residuals;
        if (around.on_parallelograms) return;
        for (int axis = 0; axis < 3; ++axis) around.sum[axis] += at(u, axis);
        ++around.n;
    }

    void add_last(Neighbourhood<Space>& around) const {
        around.n = 1;
        if (previous_ == none) return;
        for (int axis = 0; axis < 3; ++axis) around.sum[axis] = at(previous_, axis);
    }

    // The vertex across half-edge h, none at a boundary.
    Index tip_across(Index h) const {
        const Index across = surface_.opposite[h];
        return across == none ? none : surface_.vertex[previous(across)];
    }

    bool known(Index v) const { return traversal_.known(v); }
    Sum at(Index v, int axis) const { return Space::value(values_[3 * v + axis]); }

    const Surface& surface_;
    CornersOfVertices corners_;
    Traversal traversal_;
    std::span<int64_t> values_;
    std::vector<uint32_t> magnitude_;  // of the residuals, summed over the axes
    Coder& coder_;
    Index previous_ = none;
    std::vector<std::array<std::array<IntegerModel, n_scales>, 3>> models_{2};
};

}  // namespace ebz::positions
