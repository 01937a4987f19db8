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
std::vector<bool> on_seam(std::span<const Index> faces, Index n_vertices) {
    std::vector<Index> opposite(faces.size(), none);
    match_regular_edges(faces, n_vertices, std::vector<bool>(faces.size() / 3), opposite);
    std::vector<bool> seam(n_vertices);
    for (Index h = 0; h < static_cast<Index>(faces.size()); ++h) {
        if (opposite[h] == none) seam[faces[h]] = seam[faces[next(h)]] = true;
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
std::vector<bool> folding(std::span<const Index> faces, std::span<const Index> point) {
    std::vector<bool> folds(point.size());
    for (Index h = 0; h < static_cast<Index>(faces.size()); ++h) {
        const Index a = faces[h], b = faces[next(h)];
        if (a != b && point[a] == point[b]) folds[a] = folds[b] = true;
    }
    return folds;
}

}  // namespace

template <class Bits>
std::vector<Index> weld(std::span<const Index> faces, std::span<const Bits> positions) {
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

template std::vector<Index> weld(std::span<const Index>, std::span<const int32_t>);
template std::vector<Index> weld(std::span<const Index>, std::span<const int64_t>);

}  // namespace ebz
