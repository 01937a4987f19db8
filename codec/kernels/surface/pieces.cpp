#include "pieces.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "half_edge_groups.hpp"

namespace ebz {

namespace {

using Triple = std::array<Index, 3>;
using Polygon = std::vector<Index>;

Triple corners_of(const TriangleFaces& faces, Index triangle) {
    return {faces[3 * triangle], faces[3 * triangle + 1], faces[3 * triangle + 2]};
}

Polygon corners_of(const PolygonFaces& faces, Index face) {
    Polygon corners;
    for (Index c = faces.first(face); c < faces.first(face + 1); ++c) corners.push_back(faces[c]);
    return corners;
}

template <class Face>
Face rotated_to_smallest(Face face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

bool is_degenerate(const Triple& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool is_degenerate(Polygon polygon) {
    std::sort(polygon.begin(), polygon.end());
    return std::adjacent_find(polygon.begin(), polygon.end()) != polygon.end();
}

template <class Faces>
class Cutter {
public:
    Cutter(const Faces& faces, Index n_vertices)
        : faces_(faces), n_vertices_(n_vertices), isolated_(faces.n_faces()) {}

    Pieces cut() {
        for (Index f = 0; f < faces_.n_faces(); ++f) isolated_[f] = is_degenerate(corners_of(faces_, f));
        match();
        if (singular_.count() && isolate_repeats()) match();
        if (singular_.count()) {
            zip();
            pair_within_components();
            zip();
        }
        Pieces pieces{std::move(opposite_), {}};
        pieces.fans = number_fans(pieces.opposite, faces_);
        if (Faces::simple && singular_.count() && isolate_double_edges(pieces)) {
            pieces.fans = number_fans(pieces.opposite, faces_);
        }
        return pieces;
    }

private:
    void match() {
        opposite_.assign(faces_.n_corners(), none);
        singular_ = match_regular_edges(faces_, n_vertices_, isolated_, opposite_);
    }

    void join(Index h, Index g) {
        opposite_[h] = g;
        opposite_[g] = h;
    }

    // A face that repeats an earlier one, corner for corner, becomes a piece of its own.
    bool isolate_repeats() {
        std::vector<Index> faces;
        for (const Index h : singular_.half_edges) faces.push_back(faces_.face(h));
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        using Key = decltype(corners_of(faces_, 0));
        std::vector<std::pair<Key, Index>> keyed;
        for (const Index f : faces) keyed.emplace_back(rotated_to_smallest(corners_of(faces_, f)), f);
        std::sort(keyed.begin(), keyed.end());
        bool found = false;
        for (size_t i = 1; i < keyed.size(); ++i) {
            if (keyed[i].first != keyed[i - 1].first) continue;
            isolated_[keyed[i].second] = found = true;
        }
        return found;
    }

    bool same_edge_reversed(Index h, Index g) const {
        return faces_[h] == faces_[faces_.next(g)] && faces_[faces_.next(h)] == faces_[g];
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
        while (++n_steps_, opposite_[faces_.previous(h)] != none) h = opposite_[faces_.previous(h)];
        return faces_.previous(h);
    }

    Index fan_end_at_end(Index h) {
        while (++n_steps_, opposite_[faces_.next(h)] != none) h = opposite_[faces_.next(h)];
        return faces_.next(h);
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
        const size_t budget = 64 * static_cast<size_t>(faces_.n_corners());
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
                if (opposite_[h] == none) members.emplace_back(component[faces_.face(h)], h);
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
        const auto root = [&](Index f) {
            while (parent[f] != f) f = parent[f] = parent[parent[f]];
            return f;
        };
        for (Index h = 0; h < faces_.n_corners(); ++h) {
            if (opposite_[h] <= h) continue;
            const Index f = root(faces_.face(h)), g = root(faces_.face(opposite_[h]));
            parent[std::max(f, g)] = std::min(f, g);
        }
        for (Index& f : parent) f = parent[f];  // ascending: what it refers to is a root
        return parent;
    }

    // Frees every face at an edge whose two ends are also those of another edge of the pieces.
    // Only half-edges of one singular edge can collide, and freeing faces makes no new collision:
    // it splits vertices, and the edges that it opens had ends of their own.
    bool isolate_double_edges(Pieces& pieces) {
        std::vector<Index> doubled;
        std::vector<std::pair<std::pair<Index, Index>, Index>> ends;
        for (Index s = 0; s < singular_.count(); ++s) {
            ends.clear();
            for (const Index h : singular_.group(s)) {
                const Index a = pieces.fans.vertex[h], b = pieces.fans.vertex[faces_.next(h)];
                ends.push_back({std::minmax(a, b), h});
            }
            std::sort(ends.begin(), ends.end());
            for (size_t i = 0, j = 0; i < ends.size(); i = j) {
                while (j < ends.size() && ends[j].first == ends[i].first) ++j;
                const bool one_edge = j - i == 1 || (j - i == 2 && pieces.opposite[ends[i].second] ==
                                                                      ends[i + 1].second);
                for (size_t k = i; !one_edge && k < j; ++k) doubled.push_back(faces_.face(ends[k].second));
            }
        }
        for (const Index f : doubled) isolate(pieces.opposite, f);
        return !doubled.empty();
    }

    void isolate(std::vector<Index>& opposite, Index face) const {
        for (Index h = faces_.first(face); h < faces_.first(face + 1); ++h) {
            if (opposite[h] == none) continue;
            opposite[opposite[h]] = none;
            opposite[h] = none;
        }
    }

    const Faces& faces_;
    Index n_vertices_;
    std::vector<uint8_t> isolated_;
    std::vector<Index> opposite_;
    SingularEdges singular_;
    size_t n_steps_ = 0;
};

}  // namespace

template <class Faces>
Pieces cut_into_pieces(const Faces& faces, Index n_vertices) {
    return Cutter<Faces>(faces, n_vertices).cut();
}

template Pieces cut_into_pieces(const TriangleFaces&, Index);
template Pieces cut_into_pieces(const PolygonFaces&, Index);

}  // namespace ebz
