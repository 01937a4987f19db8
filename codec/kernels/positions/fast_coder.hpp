// Codes vertices in order of first contact with the faces: the least work per vertex.
//
// Prediction is the mean of the parallelograms known around the vertex; each binary decision of a
// residual has one counted context, the size of residuals and the spread of parallelograms nearby.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "surface.hpp"
#include "fast_model.hpp"
#include "float_logistic.hpp"
#include "seed_model.hpp"
#include "wrapping.hpp"

namespace ebz::positions {

class FastPredictor {
public:
    FastPredictor(const Surface& mesh, std::span<const int64_t> xyz)
        : mesh_(mesh), xyz_(xyz), known_(xyz.size() / 3, 0), sizes_(xyz.size(), 0) {}

    bool known(int32_t v) const { return known_[static_cast<size_t>(v)] != 0; }

    // For the vertex of corner c; false if no neighbour in the faces around it is known.
    bool predict(int32_t c) {
        n_ = n_neighbours_ = 0;
        sum_ = spread_ = {};
        size_ = {};
        before_ = 0;
        visit(c);
        walk(c);
        if (n_neighbours_ == 0) return false;
        const double share = n_ > 0 ? 1.0 / n_ : 0;  // without parallelograms: the first neighbour
        for (size_t d = 0; d < 3; ++d) base_[d] = wrapping_sum(origin_[d], rounded(sum_[d] * share));
        return true;
    }

    int64_t base(size_t d) const { return base_[d]; }

    // Half-octaves of the expected size of the residual, and whether it is a guess.
    int level(size_t d) const {
        const float size = static_cast<float>(size_[d]) / static_cast<float>(n_neighbours_);
        const float spread = n_ > 1 ? static_cast<float>(std::min(spread_[d], 1e15)) / static_cast<float>(n_ - 1) : size;
        return std::clamp(static_cast<int>(log2_approx(0.6f * size + 0.4f * spread + 0.125f) * 2.0f + 6.0f), 0, 90);
    }
    // How large the residuals on earlier axes came out: 0 zero, 1 small, 2 large; + 3 without parallelograms.
    size_t confidence(size_t d) const {
        const int64_t limit = size_[d] / n_neighbours_;
        return (before_ == 0 && d > 0 ? 0 : before_ <= limit ? 1 : 2) + (n_ > 1 ? 0 : 3);
    }

    void learn(int32_t v, size_t d, int64_t e) {
        const int64_t size = std::clamp<int64_t>(e, -max_size, max_size);
        sizes_[3 * static_cast<size_t>(v) + d] = static_cast<int32_t>(size < 0 ? -size : size);
        before_ = std::max<int64_t>(before_, size < 0 ? -size : size);
    }

    void settle(int32_t v) { known_[static_cast<size_t>(v)] = 1; }

private:
    static constexpr int64_t max_size = 1 << 28;
    static constexpr int max_steps = 8;  // around a vertex

    int32_t vertex(int32_t c) const { return mesh_.vertex[static_cast<size_t>(c)]; }
    int32_t opposite(int32_t c) const { return mesh_.opposite[static_cast<size_t>(c)]; }

    // The other corners of the same vertex, to both sides.
    void walk(int32_t c) {
        int steps = 0;
        for (int32_t at = opposite(previous(c)); at >= 0 && at != c && steps < max_steps; ++steps) {
            visit(at);
            at = opposite(previous(at));
        }
        for (int32_t across = opposite(c); across >= 0 && steps < max_steps; ++steps) {
            const int32_t at = next(across);
            if (at == c) break;
            visit(at);
            across = opposite(at);
        }
    }

    void visit(int32_t c) {
        const int32_t a = vertex(next(c)), b = vertex(previous(c));
        if (known(a)) add_neighbour(a);
        if (!known(a) || !known(b)) {
            if (known(b) && n_neighbours_ == 0) add_neighbour(b);
            return;
        }
        const int32_t across = opposite(next(c));
        if (across < 0 || !known(vertex(previous(across)))) return;
        const size_t ia = 3 * static_cast<size_t>(a), ib = 3 * static_cast<size_t>(b),
                     io = 3 * static_cast<size_t>(vertex(previous(across)));
        for (size_t d = 0; d < 3; ++d) {
            const uint64_t corner = static_cast<uint64_t>(xyz_[ia + d]) + static_cast<uint64_t>(xyz_[ib + d]) -
                                    static_cast<uint64_t>(xyz_[io + d]) - static_cast<uint64_t>(origin_[d]);
            const auto tip = static_cast<double>(static_cast<int64_t>(corner));
            if (n_ > 0) spread_[d] += tip > last_tip_[d] ? tip - last_tip_[d] : last_tip_[d] - tip;
            last_tip_[d] = tip;
            sum_[d] += tip;
        }
        ++n_;
    }

    void add_neighbour(int32_t u) {
        const size_t at = 3 * static_cast<size_t>(u);
        for (size_t d = 0; d < 3; ++d) {
            if (n_neighbours_ == 0) origin_[d] = xyz_[at + d];
            size_[d] += sizes_[at + d];
        }
        ++n_neighbours_;
    }

    const Surface& mesh_;
    std::span<const int64_t> xyz_;
    std::vector<uint8_t> known_;
    std::vector<int32_t> sizes_;  // magnitudes of residuals
    std::array<double, 3> sum_{}, spread_{}, last_tip_{};
    std::array<int64_t, 3> origin_{}, base_{}, size_{};
    int n_ = 0, n_neighbours_ = 0;
    int64_t before_ = 0;
};

template <class Coder>
void code_positions_fast(Coder& coder, const Surface& mesh, std::span<int64_t> xyz) {
    FastPredictor predictor(mesh, xyz);
    const auto model = std::make_unique<FastModel>();
    SeedModel seeds;
    const auto code_vertex = [&](int32_t v, bool predicted) {
        const auto position = xyz.subspan(3 * static_cast<size_t>(v), 3);
        if (!predicted) seeds.code(coder, position);
        for (size_t d = 0; predicted && d < 3; ++d) {
            const int64_t base = predictor.base(d);
            const int64_t e = model->code(coder, d, predictor.confidence(d), predictor.level(d),
                                          wrapping_difference(position[d], base));
            position[d] = wrapping_sum(base, e);
            predictor.learn(v, d, e);
        }
        predictor.settle(v);
    };
    for (size_t c = 0; c < mesh.vertex.size(); ++c) {
        const int32_t v = mesh.vertex[c];
        if (!predictor.known(v)) code_vertex(v, predictor.predict(static_cast<int32_t>(c)));
    }
    for (int32_t v = 0; v < mesh.n_vertices; ++v)
        if (!predictor.known(v)) code_vertex(v, false);
}

}  // namespace ebz::positions
