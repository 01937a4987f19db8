// Vertices that correspond to ones before, as those of a mirrored half or of a repeated part do.
//
// Where the ends of an edge have twins, so has the third corner of the face beyond it: along the connectivity, which is
// known, from the edge between the twins.  A first twin is found by coordinates or differences that are the same.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surface.hpp"
#include "vertex_recall.hpp"
#include "wrapping.hpp"

namespace ebz::positions {

// A face beyond the edge from a to b, of which the third corner is wanted; o: that of the face before.
struct Gate {
    int32_t a, b, o;
};

class Twins {
public:
    using Position = std::array<int64_t, 3>;

    // last: the axis along which the others tell of a twin.
    Twins(const Surface& mesh, size_t last)
        : opposite_(mesh.opposite.data()), vertex_(mesh.vertex.data()), last_(last),
          twin_(static_cast<size_t>(mesh.n_vertices), -1), corner_(twin_.size(), -1),
          places_(twin_.size(), log2_entries(twin_.size())), shapes_(twin_.size(), log2_entries(twin_.size())) {}

    // sites.known(u), sites.at(u): whether a vertex is known, and where it is then.
    template <class Sites>
    void start(int32_t v, std::span<const Gate> gates, const Sites& sites) {
        found_ = -1;
        n_agree_ = 0;
        is_denied_ = false;
        for (const Gate& gate : gates) {
            const Counterpart other = across(gate);
            if (other.vertex < 0 || other.vertex == v || !sites.known(other.vertex)) continue;
            found_ = other.vertex;
            const int32_t ta = of(gate.a), tb = of(gate.b);
            strength_ = ta == gate.a && tb == gate.b ? 0 : 1 + std::min<size_t>(run_, 2);
            const Position a = sites.at(gate.a), b = sites.at(gate.b), like_a = sites.at(ta), like_b = sites.at(tb), like = sites.at(found_);
            for (size_t d = 0; d < 3; ++d) {
                const bool mirrored = is_mirrored(wrapping_difference(b[d], a[d]), wrapping_difference(like_b[d], like_a[d]), other.flipped && d == last_);
                const int64_t off = wrapping_difference(like[d], like_a[d]);
                value_[d] = mirrored ? wrapping_difference(a[d], off) : wrapping_sum(a[d], off);
            }
            return;
        }
    }

    // A twin that was right on two axes is no more one where not all of it was to be right.
    bool exists() const { return found_ >= 0 && !(is_denied_ && n_agree_ == 2); }
    int64_t value(size_t d) const { return value_[d]; }

    // 0 for a twin of which little is to be expected, at most 3.
    size_t strength() const { return strength_; }
    bool is_strong() const { return exists() && strength_ == 3; }
    // Axes so far on which the value was right.
    size_t n_agree() const { return n_agree_; }

    // Whether a vertex has all coordinates of a strong twin, where that is likely.  bit(b, p): codes b, of probability p / 2^15.
    template <class Bit>
    bool tell(const Position& position, Bit bit) {
        if (!is_strong() || same_[recent_] < least_same) return false;
        const bool same = bit(position == value_, uint32_t{same_[recent_]});
        is_denied_ = !same;
        n_agree_ = same ? 3 : 0;
        return same;
    }

    int32_t vertex() const { return found_; }

    void reveal(size_t d, int64_t value) { n_agree_ += found_ >= 0 && value == value_[d] ? 1 : 0; }

    // corner: of the vertex, beyond an edge from a to b.
    void learn(int32_t v, int32_t corner, const Position& position, const Position& a, const Position& b) {
        const bool right = found_ >= 0 && n_agree_ >= 2;
        if (found_ >= 0 && strength_ == 3) learn_same(n_agree_ == 3);
        if (found_ >= 0) run_ = right ? run_ + 1 : 0;
        corner_[static_cast<size_t>(v)] = corner;
        if (latest_.vertex >= 0) pair(latest_);
        latest_ = {v, shape_of(position, a, b), place_of(position)};
        if (right) twin_[static_cast<size_t>(v)] = found_;
        shapes_.prefetch(latest_.shape);
        places_.prefetch(latest_.place);
    }

private:
    static constexpr int most_turns = 12;
    static constexpr uint16_t least_same = 8192;

    // A vertex whose twin may still have to come from memory, -1 for none.
    struct Unpaired {
        int32_t vertex;
        uint32_t shape, place;
    };

    struct Counterpart {
        int32_t vertex;  // -1 if there is none
        bool flipped;    // in orientation
    };

    // Without a twin that was right or is recalled a vertex is its own, as on a plane of symmetry.
    void pair(const Unpaired& u) {
        const int32_t alike = shapes_.find(u.shape), aligned = places_.find(u.place);
        int32_t& twin = twin_[static_cast<size_t>(u.vertex)];
        if (twin < 0) twin = alike >= 0 ? alike : aligned >= 0 ? aligned : u.vertex;
        shapes_.learn(u.shape, u.vertex);
        places_.learn(u.place, u.vertex);
    }

    int32_t of(int32_t v) const { return twin_[static_cast<size_t>(v)]; }

    // Both faces at the edge between the twins; not the one beyond which the twin of o is.
    Counterpart across(const Gate& gate) const {
        const int32_t a = of(gate.a), b = of(gate.b), o = of(gate.o);
        if (a < 0 || b < 0) return {-1, false};
        if (a == gate.a && b == gate.b) return {o != gate.o ? gate.o : -1, true};
        if (corner_[static_cast<size_t>(a)] < 0) return {-1, false};
        int32_t same = -1, flipped = -1;
        const auto look = [&](int32_t c) {
            const int32_t after = vertex_[next(c)], before = vertex_[previous(c)];
            if (after == b) same = before;
            if (before == b) flipped = after;
        };
        const int32_t first = corner_[static_cast<size_t>(a)];
        int32_t c = first;
        for (int i = 0; c >= 0 && i < most_turns; ++i) {
            look(c);
            c = opposite_[previous(c)];
            if (c == first) break;
        }
        // From a boundary the other way.
        if (c < 0)
            for (int32_t i = 0, back = first; i < most_turns && opposite_[back] >= 0; ++i) look(back = next(opposite_[back]));
        if (flipped >= 0 && flipped != o) return {flipped, true};
        return {same != o ? same : -1, false};
    }

    // By the edge and its twin's, as differences may be one off.
    static bool is_mirrored(int64_t edge, int64_t other, bool otherwise) {
        const uint64_t same = magnitude(wrapping_difference(edge, other)), opposed = magnitude(wrapping_sum(edge, other));
        return same == opposed ? otherwise : opposed < same;
    }

    // The other axes.
    uint32_t place_of(const Position& position) const {
        const size_t i = last_ == 0 ? 1 : 0, j = last_ == 2 ? 1 : 2;
        return mixed(mixed(0, position[i]), position[j]);
    }

    void learn_same(bool same) {
        uint16_t& p = same_[recent_];
        p = static_cast<uint16_t>(p + (((same ? 32768 - 15 : 15) - p) >> 4));
        recent_ = (2 * recent_ + (same ? 1 : 0)) % same_.size();
    }

    // Up to mirror images.
    static uint32_t shape_of(const Position& position, const Position& a, const Position& b) {
        uint32_t h = 0;
        for (size_t d = 0; d < 3; ++d) {
            h = mixed(h, static_cast<int64_t>(magnitude(wrapping_difference(position[d], a[d]))));
            h = mixed(h, static_cast<int64_t>(magnitude(wrapping_difference(b[d], a[d]))));
        }
        return h;
    }

    static uint32_t mixed(uint32_t h, int64_t x) {
        h = (h ^ static_cast<uint32_t>(x)) * 0x85EBCA6Bu;
        return (h ^ h >> 15) * 0xC2B2AE35u;
    }

    static int log2_entries(size_t n) { return std::clamp(static_cast<int>(std::bit_width(n)) + 1, 8, 18); }

    const int32_t *opposite_, *vertex_;
    size_t last_;
    std::vector<int32_t> twin_, corner_;
    VertexRecall places_, shapes_;
    Unpaired latest_{-1, 0, 0};
    std::array<uint16_t, 4> same_ = {16384, 16384, 16384, 16384};  // of 2^15, by the latest two answers
    size_t recent_ = 0;
    size_t run_ = 0;  // sites in a row whose twin was right

    // Of the vertex under way.
    int32_t found_ = -1;
    Position value_{};
    size_t strength_ = 0, n_agree_ = 0;
    bool is_denied_ = false;  // that all of it is right
};

}  // namespace ebz::positions
