#include "corner_table.hpp"

namespace ebz {

namespace {

// Gives `vertex` to the corners reached from c by turning one way; false if the fan closed.
bool turn_to_boundary(std::span<const Index> opposite, std::vector<Index>& of, Index c, Index vertex) {
    const Index first = c;
    for (;;) {
        of[c] = vertex;
        const Index across = opposite[previous(c)];
        if (across == none) return true;
        c = across;
        if (c == first) return false;
    }
}

void turn_back(std::span<const Index> opposite, std::vector<Index>& of, Index c, Index vertex) {
    while (opposite[c] != none) {
        c = next(opposite[c]);
        of[c] = vertex;
    }
}

}  // namespace

Fans number_fans(std::span<const Index> opposite) {
    Fans fans;
    fans.vertex.assign(opposite.size(), none);
    for (Index c = 0; c < static_cast<Index>(opposite.size()); ++c) {
        if (fans.vertex[c] != none) continue;
        const Index vertex = fans.n_vertices++;
        if (turn_to_boundary(opposite, fans.vertex, c, vertex)) {
            turn_back(opposite, fans.vertex, c, vertex);
        }
    }
    return fans;
}

}  // namespace ebz
