// What lies where around a cell and its children, as tables of places.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "cells.hpp"

namespace ebz::points {

// The bit of a child, or of an offset, on an axis: child 4 x + 2 y + z.
constexpr int bit_on(int child, int axis) { return child >> (2 - axis) & 1; }
constexpr std::array<int, 3> axes_of(int place) { return {place / 9, place / 3 % 3, place % 3}; }

// The six places that share a face with the centre.
inline constexpr std::array<int, 6> face_places{4, 10, 12, 14, 16, 22};

// The places below or above on an axis, of those on the side that is known on the axes before it.
inline constexpr auto side_masks = [] {
    std::array<std::array<std::array<uint32_t, 2>, 4>, 3> masks{};
    for (int axis = 0; axis < 3; ++axis) {
        for (int known = 0; known < 1 << axis; ++known) {
            for (int place = 0; place < n_around; ++place) {
                const auto at = axes_of(place);
                bool on_side = at[axis] != 1;
                for (int a = 0; a < axis; ++a) on_side &= at[a] == 1 || at[a] == 2 * (known >> (axis - 1 - a) & 1);
                if (on_side) masks[axis][known][at[axis] / 2] |= 1u << place;
            }
        }
    }
    return masks;
}();

// A cell of a child's size: the place that it is in, and which child it is there.
struct Beside {
    uint8_t place, child;
};

// The seven cells of a child's size that touch it from below, by offset less 1.
inline constexpr auto before_child = [] {
    std::array<std::array<Beside, 7>, 8> table{};
    for (int child = 0; child < 8; ++child) {
        for (int offset = 1; offset < 8; ++offset) {
            int place = 0, other = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int at = bit_on(child, axis) - bit_on(offset, axis);
                place = 3 * place + (at < 0 ? 0 : 1);
                other = 2 * other + (at & 1);
            }
            table[child][offset - 1] = {static_cast<uint8_t>(place), static_cast<uint8_t>(other)};
        }
    }
    return table;
}();

// The seven places that touch the outer corner of a child, by offset less 1.
inline constexpr auto beside_corner = [] {
    std::array<std::array<uint8_t, 7>, 8> table{};
    for (int child = 0; child < 8; ++child) {
        for (int offset = 1; offset < 8; ++offset) {
            int place = 0;
            for (int axis = 0; axis < 3; ++axis) {
                place = 3 * place + (bit_on(offset, axis) ? 2 * bit_on(child, axis) : 1);
            }
            table[child][offset - 1] = static_cast<uint8_t>(place);
        }
    }
    return table;
}();

inline int faces(const Surroundings& beside) {
    int mask = 0;
    for (size_t i = 0; i < face_places.size(); ++i) mask |= beside.has(face_places[i]) << i;
    return mask;
}

// How many cells are below and above on an axis.
inline std::array<int, 2> sides(const Surroundings& beside, int axis, int known) {
    const auto& masks = side_masks[axis][known];
    return {std::popcount(beside.present & masks[0]), std::popcount(beside.present & masks[1])};
}

// Which of the four children that touch the cell from below on an axis there are.
inline int touching(const Surroundings& beside, int axis) {
    static constexpr std::array<int, 3> below{4, 10, 12};
    const uint8_t children = beside.children[below[axis]];
    int mask = 0, n = 0;
    for (int child = 0; child < 8; ++child) {
        if (bit_on(child, axis)) mask |= (children >> child & 1) << n++;
    }
    return mask;
}

// coded: the children of the cell itself so far.
inline int before_mask(const Surroundings& beside, int child, uint32_t coded) {
    int mask = 0;
    for (int i = 0; i < 7; ++i) {
        const auto [place, other] = before_child[child][i];
        const uint32_t children = place == centre ? coded : beside.children[place];
        mask |= static_cast<int>(children >> other & 1) << i;
    }
    return mask;
}

inline int corner_mask(const Surroundings& beside, int child) {
    int mask = 0;
    for (int i = 0; i < 7; ++i) mask |= beside.has(beside_corner[child][i]) << i;
    return mask;
}

// Of the seven, those at a single axis.
constexpr int on_axes(int mask) { return (mask & 1) | (mask >> 1 & 1) << 1 | (mask >> 3 & 1) << 2; }

}  // namespace ebz::points
