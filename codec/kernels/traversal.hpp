// The order in which vertex positions are coded: always a vertex with most available parallelograms.
//
// Both sides derive it from connectivity alone.  Parallelogram prediction: C. Touma and C. Gotsman,
// "Triangle mesh compression", 1998.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "corner_table.hpp"

namespace ebz {

// Triangles by half-edge, with the vertices of the mesh: several fans may share one.
struct Surface {
    std::span<const Index> opposite;  // 3m
    std::span<const Index> vertex;    // 3m
    Index n_vertices;                 // the used ones come first, isolated ones have no corner
};

// The corners of each vertex.
class VertexCorners {
public:
    explicit VertexCorners(const Surface& surface) : start_(static_cast<size_t>(surface.n_vertices) + 1) {
        for (const Index v : surface.vertex) ++start_[v + 1];
        for (Index v = 0; v < surface.n_vertices; ++v) start_[v + 1] += start_[v];
        corners_.resize(surface.vertex.size());
        std::vector<Index> at(start_.begin(), start_.end() - 1);
        for (Index c = 0; c < static_cast<Index>(surface.vertex.size()); ++c) corners_[at[surface.vertex[c]]++] = c;
    }

    std::span<const Index> of(Index v) const {
        return std::span(corners_).subspan(start_[v], start_[v + 1] - start_[v]);
    }

private:
    std::vector<Index> start_, corners_;
};

// Yields every vertex once.
class Traversal {
public:
    Traversal(const Surface& surface, const VertexCorners& corners)
        : surface_(surface),
          corners_(corners),
          level_(surface.n_vertices, unreached),
          known_(surface.n_vertices) {}

    bool known(Index v) const { return known_[v]; }

    // The next vertex, none at the end; mark_known must follow.
    Index take() {
        for (int level = top_level; level >= 0; --level) {
            std::vector<Index>& bucket = buckets_[level];
            while (!bucket.empty()) {
                const Index v = bucket.back();
                bucket.pop_back();
                if (!known_[v]) return v;
            }
        }
        while (seed_ < surface_.n_vertices && known_[seed_]) ++seed_;
        return seed_ < surface_.n_vertices ? seed_ : none;
    }

    // Each edge at v is seen from one corner, so no parallelogram is counted twice.
    void mark_known(Index v) {
        known_[v] = true;
        for (const Index c : corners_.of(v)) {
            const Index a = surface_.vertex[next(c)], b = surface_.vertex[previous(c)];
            const Index beyond = tip_across(next(c)), beside = tip_across(c);
            reach(a, 0);
            reach(b, 0);
            if (!known_[a]) continue;
            if (known_[b]) {
                reach(beyond, 1);
                reach(beside, 1);
            } else if (beside != none && known_[beside]) {
                reach(b, 1);
            }
        }
    }

    // The vertex across half-edge h, none at a boundary.
    Index tip_across(Index h) const {
        const Index across = surface_.opposite[h];
        return across == none ? none : surface_.vertex[previous(across)];
    }

private:
    static constexpr int top_level = 4, unreached = -1;

    void reach(Index v, int gain) {
        if (v == none || known_[v]) return;
        const int level = std::min(std::max<int>(level_[v], 0) + gain, top_level);
        if (level == level_[v]) return;
        level_[v] = static_cast<int8_t>(level);
        buckets_[level].push_back(v);
    }

    const Surface& surface_;
    const VertexCorners& corners_;
    std::vector<int8_t> level_;  // available parallelograms, up to top_level
    std::vector<bool> known_;
    std::array<std::vector<Index>, top_level + 1> buckets_;  // a vertex may linger in lower ones
    Index seed_ = 0;
};

}  // namespace ebz
