// Codes all vertices in order of traversal, axis by axis, with every model there is.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "../entropy/range_coder.hpp"
#include "axes.hpp"
#include "axis_order.hpp"
#include "prediction.hpp"
#include "residual_model.hpp"
#include "seed_model.hpp"
#include "strong.hpp"
#include "surroundings.hpp"
#include "traversal.hpp"
#include "twins.hpp"
#include "wrapping.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// What twins are to know.
struct StrongSites {
    const Traversal& traversal;
    std::span<const int64_t> xyz;

    bool known(int32_t v) const { return traversal.known(v); }
    Twins::Position at(int32_t v) const {
        const auto i = 3 * static_cast<size_t>(v);
        return {xyz[i], xyz[i + 1], xyz[i + 2]};
    }
};

template <class Coder>
void code_strong(Coder& coder, const Surface& mesh, AxisOrder order, std::span<int64_t> xyz) {
    const auto n = static_cast<size_t>(mesh.n_vertices);
    const CornersOfVertices corners(mesh);
    Traversal traversal(mesh, corners);
    const Surveyor surveyor(mesh, corners, traversal, xyz);
    Predictor predictor(n, order);
    Axes axes;
    const auto model = std::make_unique<ResidualModel<Coder>>(coder, n);
    SeedModel seeds;
    const std::unique_ptr<Twins> twins = order.is_fixed() ? std::make_unique<Twins>(mesh, order.last) : nullptr;
    const StrongSites sites{traversal, xyz};
    Surroundings s;
    Prediction p;
    Expectation x;
    for (int32_t v; (v = traversal.next_vertex()) >= 0;) {
        const auto position = xyz.subspan(3 * static_cast<size_t>(v), 3);
        surveyor.survey(v, s);
        if (s.n_neighbours == 0) {
            seeds.code(coder, position);
            continue;
        }
        predictor.predict(s, p);
        if (twins) twins->start(v, {s.gates.data(), std::min<size_t>(static_cast<size_t>(s.n_parallelograms), 2)}, sites);
        axes.begin(s, p, twins.get());
        for (size_t turn = 0; turn < 3; ++turn) {
            const size_t d = p.axes[turn];
            const int64_t base = axes.base(d);
            axes.find_contexts(turn, x);
            model->find(x);  // while the rest is worked out
            axes.expect(turn, x);
            const int64_t e = model->code(x, wrapping_difference(position[d], base));
            position[d] = wrapping_sum(base, e);
            axes.reveal(turn, e);
            if (twins) twins->reveal(d, position[d]);
        }
        if (twins && s.n_parallelograms > 0) twins->learn(v, s.corner, sites.at(v), sites.at(s.gates[0].a), sites.at(s.gates[0].b));
        predictor.learn(v, s, p, surveyor.point(s, v), axes.residuals());
    }
}

template void code_strong(RangeEncoder&, const Surface&, AxisOrder, std::span<int64_t>);
template void code_strong(RangeDecoder&, const Surface&, AxisOrder, std::span<int64_t>);

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
