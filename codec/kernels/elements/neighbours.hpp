// The vertices that edges of the mesh join to each, and which of them are likely to be told next.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "links.hpp"

namespace ebz::elements {

class Neighbours {
public:
    static constexpr size_t max_candidates = 64;

    explicit Neighbours(const Mesh& mesh) : points_(mesh.points), first_(static_cast<size_t>(mesh.n_vertices) + 1) {
        each_edge(mesh, [&](int32_t a, int32_t) { ++first_[static_cast<size_t>(a)]; });
        size_t sum = 0;
        for (size_t& first : first_) first = sum += first;
        vertex_.resize(sum);
        each_edge(mesh, [&](int32_t a, int32_t b) { vertex_[--first_[static_cast<size_t>(a)]] = b; });
        unite();
        is_told_.resize(vertex_.size());
    }

    // Fills `candidates` with neighbours of p, those first that were not told together with it, then those
    // straight on from `before` over p, unless that is -1.  Returns how many.
    size_t rank(int32_t p, int32_t before, std::array<int32_t, max_candidates>& candidates) const {
        const size_t begin = first(p), n = std::min(first(p + 1) - begin, max_candidates);
        std::array<Item, max_candidates> items;
        for (size_t i = 0; i < n; ++i) {
            const int32_t u = vertex_[begin + i];
            items[i] = {u, is_told_[begin + i], before < 0 ? 0.0 : ahead(before, p, u)};
        }
        std::stable_sort(items.begin(), items.begin() + static_cast<ptrdiff_t>(n), [](const Item& a, const Item& b) {
            return a.is_told != b.is_told ? b.is_told : a.ahead > b.ahead;
        });
        for (size_t i = 0; i < n; ++i) candidates[i] = items[i].vertex;
        return n;
    }

    void tell(int32_t a, int32_t b) {
        is_told_[place(a, b)] = true;
        is_told_[place(b, a)] = true;
    }

private:
    struct Item {
        int32_t vertex;
        bool is_told;
        double ahead;
    };

    template <class Edge>
    static void each_edge(const Mesh& mesh, Edge edge) {
        for (size_t f = 0; f + 1 < mesh.offsets.size(); ++f) {
            const auto begin = static_cast<size_t>(mesh.offsets[f]), end = static_cast<size_t>(mesh.offsets[f + 1]);
            for (size_t c = begin; c < end; ++c) {
                const int32_t a = mesh.vertex[c], b = mesh.vertex[c + 1 < end ? c + 1 : begin];
                if (a == b) continue;
                edge(a, b);
                edge(b, a);
            }
        }
    }

    // Neighbours ascend, each once.
    void unite() {
        size_t n = 0;
        for (size_t v = 0; v + 1 < first_.size(); ++v) {
            const auto begin = vertex_.begin() + static_cast<ptrdiff_t>(first_[v]), end = vertex_.begin() + static_cast<ptrdiff_t>(first_[v + 1]);
            std::sort(begin, end);
            const auto last = std::unique(begin, end);
            first_[v] = n;
            n = static_cast<size_t>(std::copy(begin, last, vertex_.begin() + static_cast<ptrdiff_t>(n)) - vertex_.begin());
        }
        first_.back() = n;
        vertex_.resize(n);
    }

    size_t first(int32_t v) const { return first_[static_cast<size_t>(v)]; }

    size_t place(int32_t a, int32_t b) const {
        const auto begin = vertex_.begin() + static_cast<ptrdiff_t>(first(a)), end = vertex_.begin() + static_cast<ptrdiff_t>(first(a + 1));
        return static_cast<size_t>(std::lower_bound(begin, end, b) - vertex_.begin());
    }

    // The part of the step from q to p that a step of length 1 from p to u goes on with; 0 where it is not finite.
    double ahead(int32_t q, int32_t p, int32_t u) const {
        double along = 0, square = 0;
        for (size_t d = 0; d < 3; ++d) {
            const double at = point(p, d), step = point(u, d) - at;
            along += (at - point(q, d)) * step;
            square += step * step;
        }
        const double result = along / std::sqrt(square);
        return std::isfinite(result) ? result : 0.0;
    }

    double point(int32_t v, size_t d) const { return points_[3 * static_cast<size_t>(v) + d]; }

    std::span<const double> points_;
    std::vector<size_t> first_;  // of each vertex in vertex_
    std::vector<int32_t> vertex_;
    std::vector<bool> is_told_;
};

}  // namespace ebz::elements
