// What is known around a vertex that is to be coded: neighbours and parallelograms.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "surface.hpp"
#include "traversal.hpp"
#include "twins.hpp"

namespace ebz::positions {

using Point = std::array<double, 3>;
using Offset = std::array<int64_t, 3>;  // from the surroundings' origin

// One parallelogram a + b - apex, and up to four more points around it for a finer prediction.
struct Parallelogram {
    Point a, b, apex;
    Offset tip;                 // a + b - apex
    std::array<Point, 4> wing;  // beyond apex's two edges, and beyond the target's two edges
    unsigned wings;             // bit i: wing[i] is known
};

struct Surroundings {
    static constexpr int max_parallelograms = 6, max_neighbours = 16;  // further ones are ignored

    std::array<Parallelogram, max_parallelograms> parallelograms;
    std::array<Gate, max_parallelograms> gates;  // of the parallelograms
    std::array<int32_t, max_neighbours> neighbours;
    std::array<Offset, max_neighbours> neighbour_offset;
    Offset origin;  // of all points: a known neighbour, so that differences stay small
    int32_t corner;  // of the vertex, in the face of the first gate
    int n_parallelograms, n_neighbours;
};

class Surveyor {
public:
    Surveyor(const Surface& mesh, const CornersOfVertices& corners, const Traversal& known,
             std::span<const int64_t> xyz)
        : mesh_(mesh), corners_(corners), known_(known), xyz_(xyz) {}

    void survey(int32_t v, Surroundings& s) const {
        s.n_parallelograms = s.n_neighbours = 0;
        // Oldest first, so that the order says something whatever the numbering of faces.
        Ranked neighbours, gates;
        for (int32_t c : corners_[v]) {
            const int32_t a = vertex(next(c)), b = vertex(previous(c));
            neighbours.insert(a, known_.rank(a));
            if (opposite(previous(c)) < 0) neighbours.insert(b, known_.rank(b));
            if (known_.known(a) && known_.known(b)) gates.insert(c, apex_rank(c));
        }
        if (neighbours.n == 0) return;
        s.n_neighbours = neighbours.n;
        for (size_t d = 0; d < 3; ++d) s.origin[d] = xyz_[3 * static_cast<size_t>(neighbours.items[0].id) + d];
        for (size_t i = 0; i < static_cast<size_t>(neighbours.n); ++i) {
            s.neighbours[i] = neighbours.items[i].id;
            s.neighbour_offset[i] = offset(s, neighbours.items[i].id);
        }
        s.n_parallelograms = std::min(gates.n, Surroundings::max_parallelograms);
        for (size_t i = 0; i < static_cast<size_t>(s.n_parallelograms); ++i)
            build(s, i, gates.items[i].id);
        s.corner = gates.n > 0 ? gates.items[0].id : -1;
    }

    // Corrupt streams may hold anything, hence unsigned arithmetic.
    Offset offset(const Surroundings& s, int32_t v) const {
        const size_t at = 3 * static_cast<size_t>(v);
        Offset o;
        for (size_t d = 0; d < 3; ++d)
            o[d] = static_cast<int64_t>(static_cast<uint64_t>(xyz_[at + d]) - static_cast<uint64_t>(s.origin[d]));
        return o;
    }

    Point point(const Surroundings& s, int32_t v) const { return to_point(offset(s, v)); }

    static Point to_point(const Offset& o) {
        return {static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])};
    }

private:
    int32_t vertex(int32_t c) const { return mesh_.vertex[static_cast<size_t>(c)]; }
    int32_t opposite(int32_t c) const { return mesh_.opposite[static_cast<size_t>(c)]; }

    // The first items by rank; those of rank 0 are not known.
    struct Ranked {
        struct Item {
            int32_t id, rank;
        };
        std::array<Item, Surroundings::max_neighbours> items;
        int n = 0;

        void insert(int32_t id, int32_t rank) {
            if (rank == 0 || n == Surroundings::max_neighbours) return;
            auto at = static_cast<size_t>(n++);
            for (; at > 0 && items[at - 1].rank > rank; --at) items[at] = items[at - 1];
            items[at] = {id, rank};
        }
    };

    // Of the vertex across the far edge of corner c, whose other two vertices are known.
    int32_t apex_rank(int32_t c) const {
        const int32_t across = opposite(next(c));
        return across < 0 ? 0 : known_.rank(vertex(previous(across)));
    }

    void build(Surroundings& s, size_t i, int32_t c) const {
        const int32_t across = opposite(next(c));
        const Gate gate = s.gates[i] = {vertex(next(c)), vertex(previous(c)), vertex(previous(across))};
        const Offset a = offset(s, gate.a), b = offset(s, gate.b), o = offset(s, gate.o);
        Parallelogram& p = s.parallelograms[i];
        for (size_t d = 0; d < 3; ++d)
            p.tip[d] = static_cast<int64_t>(static_cast<uint64_t>(a[d]) + static_cast<uint64_t>(b[d]) - static_cast<uint64_t>(o[d]));
        p.a = to_point(a);
        p.b = to_point(b);
        p.apex = to_point(o);
        p.wings = 0;
        add_wing(s, p, 0, next(across));
        add_wing(s, p, 1, previous(across));
        add_wing(s, p, 2, c);
        add_wing(s, p, 3, previous(c));
    }

    void add_wing(const Surroundings& s, Parallelogram& p, size_t i, int32_t edge) const {
        const int32_t across = opposite(edge);
        if (across < 0) return;
        const int32_t u = vertex(previous(across));
        if (!known_.known(u)) return;  // so it is not the target itself
        p.wings |= 1u << i;
        p.wing[i] = point(s, u);
    }

    const Surface& mesh_;
    const CornersOfVertices& corners_;
    const Traversal& known_;
    std::span<const int64_t> xyz_;
};

}  // namespace ebz::positions
