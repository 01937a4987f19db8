#include "weld.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "half_edge_groups.hpp"

namespace ebz {

namespace {

// Finds the first vertex at each position, in an open-addressing table.
template <class Bits>
class Positions {
public:
    explicit Positions(std::span<const Bits> positions)
        : positions_(positions), slots_(std::bit_ceil(positions.size() / 3 * 2 + 2), none) {}

    // Of each vertex; empty if no two are at one position.
    std::vector<Index> first_of_each() {
        std::vector<Index> first(positions_.size() / 3);
        std::array<size_t, n_ahead> ahead{};
        bool any = false;
        for (size_t v = 0; v < first.size() + n_ahead; ++v) {
            size_t& slot = ahead[v % n_ahead];
            if (v >= n_ahead) {
                const auto behind = static_cast<Index>(v - n_ahead);
                first[v - n_ahead] = take(behind, slot);
                any |= first[v - n_ahead] != behind;
            }
            if (v >= first.size()) continue;
            slot = hash(v) & mask();
            __builtin_prefetch(&slots_[slot]);
        }
        if (!any) first.clear();
        return first;
    }

private:
    static constexpr size_t n_ahead = 16;  // slots on their way from memory

    Index take(Index v, size_t slot) {
        for (;; slot = (slot + 1) & mask()) {
            if (slots_[slot] == none) slots_[slot] = v;
            if (same(slots_[slot], v)) return slots_[slot];
        }
    }

    size_t mask() const { return slots_.size() - 1; }

    bool same(Index a, Index b) const {
        const Bits *p = &positions_[3 * static_cast<size_t>(a)], *q = &positions_[3 * static_cast<size_t>(b)];
        return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    }

    uint64_t hash(size_t v) const {
        uint64_t h = 0;
        for (size_t axis = 0; axis < 3; ++axis) {
            h = (h ^ static_cast<uint64_t>(positions_[3 * v + axis])) * 0x9E3779B97F4A7C15u;
            h ^= h >> 32;
        }
        return h;
    }

    std::span<const Bits> positions_;
    std::vector<Index> slots_;
};

// Of the vertices at one position with others, those at an edge that is not shared by two faces of agreeing
// orientation.  first: the first vertex at the position of each.
template <class Faces>
class SeamVertices {
public:
    SeamVertices(const Faces& faces, std::span<const Index> first)
        : faces_(faces), is_on_seam_(first.size()), is_asked_(first.size()) {
        for (size_t v = 0; v < first.size(); ++v) {
            if (first[v] != static_cast<Index>(v)) is_asked_[v] = is_asked_[first[v]] = true;
        }
        // The edges at a single corner are in one face.
        std::vector<uint8_t> n_corners(first.size());  // 2 for more
        for (Index c = 0; c < faces.n_corners(); ++c) {
            if (const Index v = faces[c]; is_asked_[v]) n_corners[v] = n_corners[v] == 0 ? 1 : 2;
        }
        bool any = false;
        for (size_t v = 0; v < first.size(); ++v) {
            is_on_seam_[v] = n_corners[v] == 1;
            any |= is_asked_[v] = n_corners[v] == 2;
        }
        if (any) find_edges();
    }

    bool operator[](Index v) const { return is_on_seam_[v]; }

private:
    void find_edges() {
        std::vector<uint8_t> is_aside(faces_.n_faces());
        for (Index f = 0; f < faces_.n_faces(); ++f) is_aside[f] = !asks(f);
        std::vector<Index> opposite(faces_.n_corners(), none);
        match_regular_edges(faces_, static_cast<Index>(is_asked_.size()), is_aside, opposite);
        for (Index f = 0; f < faces_.n_faces(); ++f) {
            if (is_aside[f]) continue;
            for (Index h = faces_.first(f); h < faces_.first(f) + faces_.size(f); ++h) {
                if (opposite[h] == none) is_on_seam_[faces_[h]] = is_on_seam_[faces_[faces_.next(h)]] = true;
            }
        }
    }

    bool asks(Index f) const {
        bool any = false;
        for (Index h = faces_.first(f); h < faces_.first(f) + faces_.size(f); ++h) any |= is_asked_[faces_[h]];
        return any;
    }

    const Faces& faces_;
    std::vector<uint8_t> is_on_seam_, is_asked_;
};

// The vertices of faces that would lose a corner.
template <class Faces>
std::vector<bool> folding(const Faces& faces, std::span<const Index> point) {
    std::vector<bool> folds(point.size());
    std::vector<Index> latest(point.size(), none);  // the first corner at a point, of the latest face there
    for (Index f = 0; f < faces.n_faces(); ++f) {
        const Index first = faces.first(f), end = first + faces.size(f);
        bool is_welded = false;
        for (Index c = first; c < end; ++c) is_welded |= point[faces[c]] != faces[c];
        if (!is_welded) continue;
        for (Index c = first; c < end; ++c) {
            const Index a = faces[c];
            Index& at = latest[point[a]];
            if (at < first) at = c;
            else if (faces[at] != a) folds[a] = folds[faces[at]] = true;
        }
    }
    return folds;
}

}  // namespace

template <class Faces, class Bits>
std::vector<Index> weld(const Faces& faces, std::span<const Bits> positions) {
    const std::vector<Index> first = Positions<Bits>(positions).first_of_each();
    if (first.empty()) return {};
    const SeamVertices<Faces> seam(faces, first);
    std::vector<Index> point(first.size());
    std::vector<bool> excluded(first.size());
    const auto weld_others = [&] {
        std::vector<Index> latest(first.size(), none);  // the first to be welded at each position
        bool any = false;
        for (Index v = 0; v < static_cast<Index>(first.size()); ++v) {
            point[v] = v;
            if (!seam[v] || excluded[v]) continue;
            Index& other = latest[first[v]];
            if (other == none) other = v;
            point[v] = other;
            any |= other != v;
        }
        return any;
    };
    if (!weld_others()) return {};
    excluded = folding(faces, point);
    if (std::find(excluded.begin(), excluded.end(), true) == excluded.end()) return point;
    return weld_others() ? point : std::vector<Index>{};
}

template std::vector<Index> weld(const TriangleFaces&, std::span<const int32_t>);
template std::vector<Index> weld(const TriangleFaces&, std::span<const int64_t>);
template std::vector<Index> weld(const PolygonFaces&, std::span<const int32_t>);
template std::vector<Index> weld(const PolygonFaces&, std::span<const int64_t>);

}  // namespace ebz
