#include "cut.hpp"

#include <array>

#include "polygon_order.hpp"

namespace ebz::polygons {

namespace {

// A quad's diagonal, by the places of the corners that it joins: 0 if even ones, else 1.
class Diagonals {
public:
    Diagonals(const PolygonFaces& faces, std::span<const Index> across, const PolygonOrder& order, Index n_vertices)
        : faces_(faces), across_(across), order_(order), diagonal_(static_cast<size_t>(faces.n_faces())),
          degree_(static_cast<size_t>(n_vertices)) {
        Index n_quads = 0, n_triangles = 0;
        for (Index f = 0; f < faces.n_faces(); ++f) {
            n_quads += faces.size(f) == 4;
            n_triangles += faces.size(f) == 3;
        }
        mostly_triangles_ = n_triangles > n_quads;
        for (Index h = 0; h < faces.n_corners(); ++h) ++degree(h);
    }

    bool of(Index face) const { return diagonal_[static_cast<size_t>(face)]; }

    void choose(Index gate, Cut way) {
        const Index face = faces_.face(gate), c = faces_.first(face);
        if (faces_.size(face) != 4) return;
        const bool diagonal = mostly_triangles_ ? by_degrees(c) : by_neighbours(gate, way);
        diagonal_[static_cast<size_t>(face)] = diagonal;
        for (const Index end : {c + diagonal, c + diagonal + 2}) ++degree(end);
    }

private:
    Index place(Index h) const { return h - faces_.first(faces_.face(h)); }
    Index& degree(Index h) { return degree_[static_cast<size_t>(faces_[h])]; }

    // Among triangles a quad is likely two of them.
    bool by_degrees(Index c) { return degree(c) + degree(c + 2) > degree(c + 1) + degree(c + 3); }

    // As most want it; as the first from the gate on where they differ.
    bool by_neighbours(Index gate, Cut way) const {
        std::array<int, 2> votes{};
        int n_unknown = 0, first = place(gate) & 1;
        Index unknown = none, h = gate;
        for (int side = 0; side < 4; ++side, h = faces_.next(h)) {
            if (!order_.known(h)) {
                unknown = h;
                ++n_unknown;
            }
            const Index neighbour = across_[static_cast<size_t>(h)];
            if (neighbour == none || !is_cut(faces_.face(neighbour))) continue;
            const int wanted = (place(h) + place(neighbour) + of(faces_.face(neighbour))) & 1;
            if (votes == std::array<int, 2>{}) first = wanted;
            ++votes[static_cast<size_t>(wanted)];
        }
        if (way == Cut::completing && n_unknown == 1) return ((place(unknown) + 1) & 1) != 0;
        return votes[0] == votes[1] ? first != 0 : votes[1] > votes[0];
    }

    bool is_cut(Index face) const { return faces_.size(face) == 4 && order_.visited(face); }

    const PolygonFaces& faces_;
    std::span<const Index> across_;
    const PolygonOrder& order_;
    std::vector<bool> diagonal_;
    std::vector<Index> degree_;  // polygons and diagonals at each vertex
    bool mostly_triangles_;
};

class Sheet {
public:
    Sheet(const PolygonFaces& faces, Triangles& triangles)
        : faces_(faces), triangles_(triangles), half_edge_(static_cast<size_t>(faces.n_corners()), none) {}

    // A strip whose triangles have their tips in turn on the left and on the right of the gate.
    void cut(Index gate, bool left) {
        Index a = gate, b = faces_.next(gate), rest = none;
        for (Index n = faces_.size(faces_.face(gate)) - 2; n > 0; --n, left = !left) {
            const Index tip = left ? faces_.previous(a) : faces_.next(b), t = add(a, b, tip);
            if (rest == none) half_edge(gate) = t;
            else join(rest, t);
            half_edge(left ? tip : b) = left ? t + 2 : t + 1;
            rest = left ? t + 1 : t + 2;
            (left ? a : b) = tip;
        }
        half_edge(b) = rest;
    }

    void glue(std::span<const Index> across) {
        for (Index h = 0; h < faces_.n_corners(); ++h) {
            const Index other = across[static_cast<size_t>(h)];
            if (other != none && half_edge(h) != none) triangles_.opposite[static_cast<size_t>(half_edge(h))] = half_edge(other);
        }
    }

private:
    Index& half_edge(Index h) { return half_edge_[static_cast<size_t>(h)]; }

    Index add(Index a, Index b, Index tip) {
        const auto first = static_cast<Index>(triangles_.corner.size());
        triangles_.corner.insert(triangles_.corner.end(), {a, b, tip});
        triangles_.opposite.insert(triangles_.opposite.end(), 3, none);
        return first;
    }

    void join(Index h, Index g) {
        triangles_.opposite[static_cast<size_t>(h)] = g;
        triangles_.opposite[static_cast<size_t>(g)] = h;
    }

    const PolygonFaces& faces_;
    Triangles& triangles_;
    std::vector<Index> half_edge_;  // that each half-edge of a polygon becomes
};

}  // namespace

Triangles cut(const PolygonFaces& faces, std::span<const Index> across, Index n_vertices, Cut way) {
    PolygonOrder order(faces, across, n_vertices);
    Diagonals diagonals(faces, across, order, n_vertices);
    std::vector<Index> gates;
    gates.reserve(static_cast<size_t>(faces.n_faces()));
    order.run([&](Index gate) {
        diagonals.choose(gate, way);
        gates.push_back(gate);
    });
    Triangles triangles;
    for (const bool other : {false, true}) {
        if (other && way != Cut::twice) break;
        Sheet sheet(faces, triangles);
        for (const Index gate : gates) {
            const Index face = faces.face(gate);
            const bool touches_gate = faces.size(face) == 4 && (((gate - faces.first(face)) & 1) != 0) == diagonals.of(face);
            sheet.cut(gate, touches_gate == other);
        }
        sheet.glue(across);
    }
    return triangles;
}

}  // namespace ebz::polygons
