#include "../errors.hpp"
#include "polygons.hpp"

namespace ebz::polygons {

namespace {

// The gate of a closed component's first triangle is met by the next triangle, all others by earlier ones.
bool is_first_of_closed(std::span<const Index> opposite, Index triangle) {
    return opposite[3 * triangle] > 3 * triangle;
}

// From the order of the stream to that of the output.
std::vector<uint8_t> by_triangle(std::span<const Index> opposite, std::span<const uint8_t> marks) {
    const Index n = static_cast<Index>(marks.size());
    std::vector<bool> is_first(n);
    Index n_first = 0;
    for (Index t = 0; t < n; ++t) n_first += is_first[t] = is_first_of_closed(opposite, t);
    std::vector<uint8_t> output(n);
    for (Index t = 0, in_word = 0, first = n - n_first; t < n; ++t) {
        output[t] = marks[is_first[t] ? first++ : in_word++];
    }
    return output;
}

// Where what is left of a polygon after its first triangle lies: 0 across the gate, 1 across the right edge.
Index side_of_rest(std::span<const Index> opposite, Index triangle) {
    return is_first_of_closed(opposite, triangle) ? 0 : 1;
}

Index end_of_polygon(std::span<const Index> opposite, std::span<const uint8_t> marks, Index triangle) {
    for (; marks[triangle] == goes_on; ++triangle) {
        const Index across = 3 * (triangle + 1);
        const bool is_there = across < static_cast<Index>(opposite.size());
        if (!is_there || opposite[3 * triangle + side_of_rest(opposite, triangle)] != across) {
            throw Corrupt("a polygon goes on in a triangle that is not across its edge");
        }
    }
    return triangle + 1;
}

}  // namespace

Corners corners_of_polygons(std::span<const Index> opposite, std::span<const uint8_t> marks) {
    const std::vector<uint8_t> mark = by_triangle(opposite, marks);
    Corners corners{{0}, {}};
    for (Index from = 0, to; from < static_cast<Index>(mark.size()); from = to) {
        to = end_of_polygon(opposite, mark, from);
        const Index n_own = mark[from] == two_corners ? 2 : mark[from] == one_corner ? 1 : 3;
        for (Index side = 0; side < n_own; ++side) {
            if (to - from == 1 || side != side_of_rest(opposite, from)) {
                corners.corner.push_back(3 * from + side);
                continue;
            }
            // The right edge of the last triangle, then the left edges, to that of the second.
            corners.corner.push_back(3 * (to - 1) + 1);
            for (Index t = to - 1; t > from; --t) corners.corner.push_back(3 * t + 2);
        }
        corners.offsets.push_back(static_cast<Index>(corners.corner.size()));
    }
    return corners;
}

}  // namespace ebz::polygons
