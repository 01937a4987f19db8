// Where a vertex is expected: the mean of its parallelograms, the last axis along the tangent plane.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surface.hpp"
#include "light_context.hpp"
#include "traversal.hpp"
#include "wrapping.hpp"

namespace ebz::positions {

class LightPredictor {
public:
    LightPredictor(const Surface& mesh, const CornersOfVertices& corners, const Traversal& traversal,
                   std::span<const int64_t> xyz)
        : mesh_(mesh), corners_(corners), traversal_(traversal), xyz_(xyz), sizes_(xyz.size(), unknown) {}

    // False if no neighbour is known.
    bool predict(int32_t v);

    size_t axis(size_t turn) const { return axes_[turn]; }
    int64_t base(size_t d) const { return wrapping_sum(origin_[d], base_[d]); }
    void expect(size_t turn, LightContext& x);
    void reveal(size_t turn, int64_t e);
    void learn(int32_t v);

private:
    using Point = std::array<double, 3>;
    using Offset = std::array<int64_t, 3>;  // from a known neighbour, so that differences stay small
    static constexpr int32_t unknown = -1, max_size = 1 << 28;
    static constexpr size_t max_neighbours = 8;

    int32_t vertex(int32_t c) const { return mesh_.vertex[static_cast<size_t>(c)]; }
    int32_t opposite(int32_t c) const { return mesh_.opposite[static_cast<size_t>(c)]; }
    Offset offset(int32_t v) const {
        const size_t at = 3 * static_cast<size_t>(v);
        return {wrapping_difference(xyz_[at], origin_[0]), wrapping_difference(xyz_[at + 1], origin_[1]),
                wrapping_difference(xyz_[at + 2], origin_[2])};
    }

    void visit(int32_t c);
    void add_neighbour(int32_t u);
    void order_axes();
    void slide(size_t turn, bool far);
    void expect_value(size_t turn, LightContext& x);

    const Surface& mesh_;
    const CornersOfVertices& corners_;
    const Traversal& traversal_;
    std::span<const int64_t> xyz_;
    std::vector<int32_t> sizes_;  // magnitudes of residuals

    // Of the vertex under way.
    Point sum_{}, spread_{}, last_tip_{}, mean_{}, normal_{};
    Offset origin_{}, base_{}, value_{}, size_{};
    std::array<Offset, max_neighbours> neighbours_{};
    std::array<int32_t, 3> residual_sizes_{};
    std::array<size_t, 3> axes_{};
    size_t n_neighbours_ = 0;
    int n_ = 0, n_sizes_ = 0;
    int64_t total_ = 0, slid_ = 0;
    bool slides_ = false;
    double tangent_energy_ = 4, normal_energy_ = 1, gain_with_ = 1, gain_without_ = 1;
};

}  // namespace ebz::positions
