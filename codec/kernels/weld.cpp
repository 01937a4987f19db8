#include "weld.hpp"

#include <bit>
#include <numeric>

#include "half_edge_groups.hpp"

namespace ebz {

namespace {

// Finds the first vertex at each position, in an open-addressing table.
template <class Bits>
class Positions {
public:
    explicit Positions(std::span<const Bits> positions)
        : positions_(positions), slots_(std::bit_ceil(positions.size() / 3 * 2 + 2), none) {}

    Index first(Index v) {
        for (size_t slot = hash(v) & mask();; slot = (slot + 1) & mask()) {
            if (slots_[slot] == none) slots_[slot] = v;
            if (same(slots_[slot], v)) return slots_[slot];
        }
    }

private:
    size_t mask() const { return slots_.size() - 1; }

    bool same(Index a, Index b) const {
        const Bits *p = &positions_[3 * static_cast<size_t>(a)], *q = &positions_[3 * static_cast<size_t>(b)];
        return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    }

    uint64_t hash(Index v) const {
        uint64_t h = 0;
        for (size_t axis = 0; axis < 3; ++axis) {
            h = (h ^ static_cast<uint64_t>(positions_[3 * static_cast<size_t>(v) + axis])) * 0x9E3779B97F4A7C15u;
            h ^= h >> 32;
        }
        return h;
    }

    std::span<const Bits> positions_;
    std::vector<Index> slots_;
};

// The vertices at an edge that is not shared by two faces of agreeing orientation.
template <class Faces>
std::vector<bool> on_seam(const Faces& faces, Index n_vertices) {
    std::vector<Index> opposite(faces.n_corners(), none);
    match_regular_edges(faces, n_vertices, std::vector<bool>(faces.n_faces()), opposite);
    std::vector<bool> seam(n_vertices);
    for (Index h = 0; h < faces.n_corners(); ++h) {
        if (opposite[h] == none) seam[faces[h]] = seam[faces[faces.next(h)]] = true;
    }
    return seam;
}

template <class Bits>
bool any_equal(std::span<const Bits> positions) {
    Positions<Bits> table(positions);
    for (Index v = 0; v < static_cast<Index>(positions.size() / 3); ++v) {
        if (table.first(v) != v) return true;
    }
    return false;
}

// The vertices of faces that would lose a corner.
template <class Faces>
std::vector<bool> folding(const Faces& faces, std::span<const Index> point) {
    std::vector<bool> folds(point.size());
    std::vector<Index> latest(point.size(), none);  // the first corner at a point, of the latest face there
    for (Index c = 0; c < faces.n_corners(); ++c) {
        const Index a = faces[c], at = latest[point[a]];
        if (at == none || faces.face(at) != faces.face(c)) {
            latest[point[a]] = c;
        } else if (faces[at] != a) {
            folds[a] = folds[faces[at]] = true;
        }
    }
    return folds;
}

}  // namespace

template <class Faces, class Bits>
std::vector<Index> weld(const Faces& faces, std::span<const Bits> positions) {
    if (!any_equal(positions)) return {};
    const Index n_vertices = static_cast<Index>(positions.size() / 3);
    const std::vector<bool> seam = on_seam(faces, n_vertices);
    std::vector<Index> point(n_vertices);
    std::iota(point.begin(), point.end(), 0);
    std::vector<bool> excluded(n_vertices);
    const auto weld_others = [&] {
        Positions<Bits> table(positions);
        bool any = false;
        for (Index v = 0; v < n_vertices; ++v) {
            point[v] = seam[v] && !excluded[v] ? table.first(v) : v;
            any = any || point[v] != v;
        }
        return any;
    };
    if (!weld_others()) return {};
    excluded = folding(faces, point);
    return weld_others() ? point : std::vector<Index>{};
}

template std::vector<Index> weld(const TriangleFaces&, std::span<const int32_t>);
template std::vector<Index> weld(const TriangleFaces&, std::span<const int64_t>);
template std::vector<Index> weld(const PolygonFaces&, std::span<const int32_t>);
template std::vector<Index> weld(const PolygonFaces&, std::span<const int64_t>);

}  // namespace ebz
