// Where pieces touch: vertices of the mesh around which there are several fans.
//
// Components that touch what is coded already are entered there, in the order in which these vertices were
// reached: what they are glued to is then told in small steps (gluing.hpp).
#pragma once

#include <span>
#include <vector>

#include "corner_table.hpp"

namespace ebz {

class TouchingFans {
public:
    // faces: the vertex of each corner in the mesh, that of a fan's first corner stands for the fan.
    template <class Faces>
    TouchingFans(const Faces& faces, const Fans& fans, Index n_vertices) : point_(fans.n_vertices, none), fan_(fans.vertex) {
        std::vector<Index> n_fans(static_cast<size_t>(n_vertices) + 1);
        for (const Index c : fans.first) ++n_fans[faces[c]];
        Index n_touching = 0;
        for (Index& n : n_fans) {
            const Index number = n > 1 ? n : 0;
            n = n_touching;
            n_touching += number;
        }
        starts_ = std::move(n_fans);
        corners_.resize(static_cast<size_t>(n_touching));
        if (corners_.empty()) return;
        is_reached_.resize(static_cast<size_t>(n_vertices));
        std::vector<Index> at(starts_.begin(), starts_.end());
        for (const Index c : fans.first) {
            const Index vertex = faces[c];
            if (starts_[vertex] == starts_[vertex + 1]) continue;
            point_[fan_[c]] = vertex;
            corners_[at[vertex]++] = c;
        }
    }

    bool any() const { return !corners_.empty(); }

    // The corner's face has been coded.
    void reach(Index c) {
        const Index vertex = point_[fan_[c]];
        if (vertex == none || is_reached_[vertex]) return;
        is_reached_[vertex] = true;
        reached_.push_back(vertex);
    }

    // Calls enter(h) for all half-edges until it returns false, but first for those where reached fans touch: at(c)
    // is the one around corner c, or none.  What enter() reaches is seen to before the next half-edge.
    template <class At, class Enter>
    void each_half_edge(At at, Enter enter) {
        size_t n_seen = 0;
        const auto enter_touching = [&] {
            for (; n_seen < reached_.size(); ++n_seen) {
                const Index vertex = reached_[n_seen];
                for (Index i = starts_[vertex]; i < starts_[vertex + 1]; ++i) {
                    if (const Index h = at(corners_[i]); h != none && !enter(h)) return false;
                }
            }
            return true;
        };
        if (!enter_touching()) return;
        for (Index h = 0; h < static_cast<Index>(fan_.size()); ++h) {
            if (!enter(h) || !enter_touching()) return;
        }
    }

private:
    std::vector<Index> point_;          // the vertex of each fan that touches another
    std::vector<Index> starts_;         // in corners_, of each vertex
    std::vector<Index> corners_;        // the first of each such fan, ascending around each vertex
    std::vector<bool> is_reached_;      // vertices
    std::vector<Index> reached_;
    std::span<const Index> fan_;        // of each corner, numbered by first corner
};

}  // namespace ebz
