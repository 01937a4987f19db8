#include "pieces.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "half_edge_groups.hpp"

namespace ebz {

namespace {

using Triple = std::array<Index, 3>;

Triple rotated_to_smallest(std::span<const Index> faces, Index triangle) {
    Triple t{faces[3 * triangle], faces[3 * triangle + 1], faces[3 * triangle + 2]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

bool is_degenerate(std::span<const Index> faces, Index triangle) {
    const Index a = faces[3 * triangle], b = faces[3 * triangle + 1], c = faces[3 * triangle + 2];
    return a == b || b == c || c == a;
}

class Cutter {
public:
    Cutter(std::span<const Index> faces, Index n_vertices)
        : faces_(faces), n_vertices_(n_vertices), isolated_(faces.size() / 3) {}

    Pieces cut() {
        for (Index t = 0; t < n_triangles(); ++t) isolated_[t] = is_degenerate(faces_, t);
        match();
        if (singular_.count() && isolate_repeats()) match();
        if (singular_.count()) {
            zip();
            pair_within_components();
            zip();
        }
        Pieces pieces{std::move(opposite_), {}};
        pieces.fans = number_fans(pieces.opposite);
        if (singular_.count() && isolate_double_edges(pieces)) {
            pieces.fans = number_fans(pieces.opposite);
        }
        return pieces;
    }

private:
    Index n_triangles() const { return static_cast<Index>(isolated_.size()); }

    void match() {
        opposite_.assign(faces_.size(), none);
        singular_ = match_regular_edges(faces_, n_vertices_, isolated_, opposite_);
    }

    void join(Index h, Index g) {
        opposite_[h] = g;
        opposite_[g] = h;
    }

    // A face that repeats an earlier one, corner for corner, becomes a piece of its own.
    bool isolate_repeats() {
        std::vector<Index> triangles;
        for (const Index h : singular_.half_edges) triangles.push_back(h / 3);
        std::sort(triangles.begin(), triangles.end());
        triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
        std::vector<std::pair<Triple, Index>> keyed;
        for (const Index t : triangles) keyed.emplace_back(rotated_to_smallest(faces_, t), t);
        std::sort(keyed.begin(), keyed.end());
        bool found = false;
        for (size_t i = 1; i < keyed.size(); ++i) {
            if (keyed[i].first != keyed[i - 1].first) continue;
            isolated_[keyed[i].second] = found = true;
        }
        return found;
    }

    bool same_edge_reversed(Index h, Index g) const {
        return faces_[h] == faces_[next(g)] && faces_[next(h)] == faces_[g];
    }

    // The half-edges that h would be joined with to close its fan at either end.
    struct Proposal {
        Index at_start, at_end;
        bool only(Index g) const {
            return (at_start == none || at_start == g) && (at_end == none || at_end == g);
        }
    };

    Proposal propose(Index h) {
        const Index s = fan_end_at_start(h), e = fan_end_at_end(h);
        return {same_edge_reversed(h, s) ? s : none, same_edge_reversed(h, e) ? e : none};
    }

    // h is on a boundary, so both walks are along a path and end.
    Index fan_end_at_start(Index h) {
        while (++n_steps_, opposite_[previous(h)] != none) h = opposite_[previous(h)];
        return previous(h);
    }

    Index fan_end_at_end(Index h) {
        while (++n_steps_, opposite_[next(h)] != none) h = opposite_[next(h)];
        return next(h);
    }

    // Joins the two ends of a fan that lie on one edge, in rounds, so that a seam closes from its ends
    // inwards; where the two ends of an edge disagree, nothing is joined.
    void zip() {
        std::vector<Index> open;
        for (const Index h : singular_.half_edges) {
            if (opposite_[h] == none) open.push_back(h);
        }
        // A long seam takes many rounds; the budget keeps them linear, and being checked between rounds
        // it does not depend on the order of the faces.
        const size_t budget = 64 * faces_.size();
        n_steps_ = 0;
        for (std::vector<std::pair<Index, Index>> joins; n_steps_ < budget; joins.clear()) {
            for (const Index h : open) {
                const Proposal p = propose(h);
                const Index g = p.at_start != none ? p.at_start : p.at_end;
                if (g != none && h < g && p.only(g) && propose(g).only(h)) joins.emplace_back(h, g);
            }
            if (joins.empty()) return;
            for (const auto& [h, g] : joins) join(h, g);
            std::erase_if(open, [&](Index h) { return opposite_[h] != none; });
        }
    }

    // Joins the one pair that a component has at a singular edge: solids that touch along edges.
    void pair_within_components() {
        const std::vector<Index> component = components();
        std::vector<std::pair<Index, Index>> members;  // (component, half-edge)
        std::vector<std::pair<Index, Index>> joins;
        for (Index s = 0; s < singular_.count(); ++s) {
            members.clear();
            for (const Index h : singular_.group(s)) {
                if (opposite_[h] == none) members.emplace_back(component[h / 3], h);
            }
            std::sort(members.begin(), members.end());
            for (size_t i = 0, j = 0; i < members.size(); i = j) {
                while (j < members.size() && members[j].first == members[i].first) ++j;
                const Index h = members[i].second;
                if (j - i == 2 && same_edge_reversed(h, members[i + 1].second)) {
                    joins.emplace_back(h, members[i + 1].second);
                }
            }
        }
        for (const auto& [h, g] : joins) join(h, g);
    }

    std::vector<Index> components() const {
        std::vector<Index> parent(isolated_.size());
        std::iota(parent.begin(), parent.end(), 0);
        const auto root = [&](Index t) {
            while (parent[t] != t) t = parent[t] = parent[parent[t]];
            return t;
        };
        for (Index h = 0; h < static_cast<Index>(faces_.size()); ++h) {
            if (opposite_[h] > h) parent[root(h / 3)] = root(opposite_[h] / 3);
        }
        for (Index t = 0; t < n_triangles(); ++t) parent[t] = root(t);
        return parent;
    }

    // Frees every triangle at an edge whose two ends are also those of another edge of the pieces.
    // Only half-edges of one singular edge can collide, and freeing triangles makes no new collision:
    // it splits vertices, and the edges that it opens had ends of their own.
    bool isolate_double_edges(Pieces& pieces) {
        std::vector<Index> doubled;
        std::vector<std::pair<std::pair<Index, Index>, Index>> ends;
        for (Index s = 0; s < singular_.count(); ++s) {
            ends.clear();
            for (const Index h : singular_.group(s)) {
                const Index a = pieces.fans.vertex[h], b = pieces.fans.vertex[next(h)];
                ends.push_back({std::minmax(a, b), h});
            }
            std::sort(ends.begin(), ends.end());
            for (size_t i = 0, j = 0; i < ends.size(); i = j) {
                while (j < ends.size() && ends[j].first == ends[i].first) ++j;
                const bool one_edge = j - i == 1 || (j - i == 2 && pieces.opposite[ends[i].second] ==
                                                                      ends[i + 1].second);
                for (size_t k = i; !one_edge && k < j; ++k) doubled.push_back(ends[k].second / 3);
            }
        }
        for (const Index t : doubled) isolate(pieces.opposite, t);
        return !doubled.empty();
    }

    static void isolate(std::vector<Index>& opposite, Index triangle) {
        for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
            if (opposite[h] == none) continue;
            opposite[opposite[h]] = none;
            opposite[h] = none;
        }
    }

    std::span<const Index> faces_;
    Index n_vertices_;
    std::vector<bool> isolated_;
    std::vector<Index> opposite_;
    SingularEdges singular_;
    size_t n_steps_ = 0;
};

}  // namespace

Pieces cut_into_pieces(std::span<const Index> faces, Index n_vertices) {
    return Cutter(faces, n_vertices).cut();
}

}  // namespace ebz
