// Codes all vertices in order of traversal, from the mean of their parallelograms.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "surface.hpp"
#include "light_model.hpp"
#include "light_predictor.hpp"
#include "medium_model.hpp"
#include "seed_model.hpp"
#include "traversal.hpp"
#include "wrapping.hpp"

namespace ebz::positions {

template <class Model, class Seeds, class Coder>
void code_in_traversal(Coder& coder, const Surface& mesh, std::span<int64_t> xyz) {
    const CornersOfVertices corners(mesh);
    Traversal traversal(mesh, corners);
    LightPredictor predictor(mesh, corners, traversal, xyz);
    const auto model = std::make_unique<Model>();
    Seeds seeds;
    LightContext x;
    for (int32_t v; (v = traversal.next_vertex()) >= 0;) {
        const auto position = xyz.subspan(3 * static_cast<size_t>(v), 3);
        if (!predictor.predict(v)) {
            seeds.code(coder, position);
            continue;
        }
        for (size_t turn = 0; turn < 3; ++turn) {
            const size_t d = predictor.axis(turn);
            predictor.expect(turn, x);
            const int64_t base = predictor.base(d);
            const int64_t e = model->code(coder, x, wrapping_difference(position[d], base));
            position[d] = wrapping_sum(base, e);
            predictor.reveal(turn, e);
        }
        predictor.learn(v);
    }
}

template <class Coder>
void code_positions_light(Coder& coder, const Surface& mesh, std::span<int64_t> xyz) {
    code_in_traversal<LightModel, SeedModel>(coder, mesh, xyz);
}

template <class Coder>
void code_positions_medium(Coder& coder, const Surface& mesh, std::span<int64_t> xyz) {
    code_in_traversal<MediumModel, MediumSeeds>(coder, mesh, xyz);
}

}  // namespace ebz::positions
