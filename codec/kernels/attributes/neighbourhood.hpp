// In which order items are coded, and which known ones surround each.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "../positions/surface.hpp"
#include "../positions/traversal.hpp"
#include "attributes.hpp"
#include "face_edges.hpp"

namespace ebz::attributes {

struct Parallelogram {
    int32_t a, b, across;
};

// A triangle whose other two corners are known; across is -1 where nothing is known behind their edge.
struct Neighbourhood {
    static constexpr size_t max_neighbours = 8, max_triangles = 8;

    std::array<int32_t, max_neighbours> neighbours;  // the one coded last first
    std::array<Parallelogram, max_triangles> triangles;
    size_t n_neighbours = 0, n_triangles = 0;

    void clear() { n_neighbours = n_triangles = 0; }

    void add(int32_t u) {
        const auto end = neighbours.begin() + static_cast<ptrdiff_t>(n_neighbours);
        if (n_neighbours < max_neighbours && std::find(neighbours.begin(), end, u) == end) neighbours[n_neighbours++] = u;
    }
    void add(const Parallelogram& p) {
        if (n_triangles < max_triangles) triangles[n_triangles++] = p;
    }
};

// Items of a surface, in the order of most available parallelograms.
class SurfaceWalk {
public:
    explicit SurfaceWalk(const Items& items)
        : surface_{items.opposite, items.item, items.n}, corners_(surface_), traversal_(surface_, corners_) {}

    int32_t next() { return traversal_.next_vertex(); }

    const positions::CornersOfVertices* corners() const { return &corners_; }

    void surround(int32_t v, Neighbourhood& out) {
        out.clear();
        for (const int32_t c : corners_[v]) {
            const int32_t a = item(positions::next(c)), b = item(positions::previous(c));
            const bool knows_a = traversal_.known(a), knows_b = traversal_.known(b);
            if (knows_a) out.add(a);
            if (knows_b) out.add(b);
            if (knows_a && knows_b) out.add(Parallelogram{a, b, across(positions::next(c), a, b)});
            if (out.n_triangles == Neighbourhood::max_triangles) break;
        }
        const auto later = [&](int32_t x, int32_t y) { return traversal_.rank(x) > traversal_.rank(y); };
        std::sort(out.neighbours.begin(), out.neighbours.begin() + static_cast<ptrdiff_t>(out.n_neighbours), later);
    }

private:
    int32_t item(int32_t c) const { return surface_.vertex[static_cast<size_t>(c)]; }

    // The known item behind the edge from a to b, unless a seam is there.
    int32_t across(int32_t h, int32_t a, int32_t b) const {
        const int32_t o = surface_.opposite[static_cast<size_t>(h)];
        if (o < 0 || item(o) != b || item(positions::next(o)) != a) return -1;
        const int32_t tip = item(positions::previous(o));
        return traversal_.known(tip) ? tip : -1;
    }

    positions::Surface surface_;
    positions::CornersOfVertices corners_;
    positions::Traversal traversal_;
};

// Faces in their order: those across edges, then those across theirs.
class FaceWalk {
public:
    explicit FaceWalk(const Items& items) : n_(items.n), edges_(items) {}

    int32_t next() { return at_ + 1 < n_ ? ++at_ : -1; }

    const positions::CornersOfVertices* corners() const { return nullptr; }

    void surround(int32_t f, Neighbourhood& out) {
        out.clear();
        add_earlier(f, edges_.end(f), f, out);
        const auto begin = out.neighbours.begin();
        std::sort(begin, begin + static_cast<ptrdiff_t>(out.n_neighbours), std::greater<>());
        for (size_t k = 0, n = out.n_neighbours; k < n; ++k) {
            const int32_t g = out.neighbours[k];
            add_earlier(g, std::min(edges_.end(g), edges_.begin(g) + max_sides), f, out);
        }
    }

private:
    static constexpr int32_t max_sides = 16;  // of a neighbour: large ones may have many neighbours

    // What is across the half-edges of `face` below `end`, if before f.
    void add_earlier(int32_t face, int32_t end, int32_t f, Neighbourhood& out) const {
        for (int32_t h = edges_.begin(face); h < end; ++h) {
            const int32_t g = edges_.across(h);
            if (g >= 0 && g < f) out.add(g);
        }
    }

    int32_t n_;
    FaceEdges edges_;
    int32_t at_ = -1;
};

// Rows, one after another: those before, where they have places the nearest of them.
class RowWalk {
public:
    explicit RowWalk(const Items& items) : n_(items.n), points_(items.points) {}

    int32_t next() { return at_ + 1 < n_ ? ++at_ : -1; }

    const positions::CornersOfVertices* corners() const { return nullptr; }

    void surround(int32_t row, Neighbourhood& out) {
        out.clear();
        if (!points_.empty()) return add_nearest(row, out);
        for (int32_t k = 1; k <= 3 && k <= row; ++k) out.add(row - k);
        if (row >= 2) out.add(Parallelogram{row - 1, row - 1, row - 2});
    }

private:
    static constexpr int32_t n_before = 256;
    static constexpr double farthest = 1e300;

    // The nearest first, of those alike the latest.
    void add_nearest(int32_t row, Neighbourhood& out) const {
        std::array<double, Neighbourhood::max_neighbours> squares;
        for (int32_t other = row - 1; other >= 0 && other >= row - n_before; --other) {
            const double square = square_between(row, other);
            size_t i = out.n_neighbours;
            if (i == Neighbourhood::max_neighbours && !(square < squares[--i])) continue;
            for (; i > 0 && square < squares[i - 1]; --i) {
                squares[i] = squares[i - 1];
                out.neighbours[i] = out.neighbours[i - 1];
            }
            squares[i] = square;
            out.neighbours[i] = other;
            out.n_neighbours = std::min(out.n_neighbours + 1, Neighbourhood::max_neighbours);
        }
    }

    double square_between(int32_t a, int32_t b) const {
        double sum = 0;
        for (size_t d = 0; d < 3; ++d) {
            const double x = points_[3 * static_cast<size_t>(a) + d] - points_[3 * static_cast<size_t>(b) + d];
            sum += x * x;
        }
        return sum < farthest ? sum : farthest;
    }

    int32_t n_, at_ = -1;
    std::span<const double> points_;
};

}  // namespace ebz::attributes
