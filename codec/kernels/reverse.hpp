// Spirale Reversi: the reverse word -> triangles glued along half-edges, in one pass.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edgebreaker.hpp"

namespace ebz {

// Builds the triangles from the last to the first.  Whatever the symbols are, indices stay in range
// and opposite stays an involution: what cannot be done throws Corrupt.
class Reverse {
public:
    Reverse(Index n_symbols, Index n_closed, Index n_single);

    // One symbol, at a position that falls by one from call to call; meets is that of SpecialS, none
    // for all others.
    void apply(Symbol symbol, int64_t meets);

    // Adds the first triangles of the closed components; the opposite of each half-edge in output order.
    std::vector<Index> finish();

private:
    struct Active {
        Index gate;
        Index front;  // the position of the latest symbol: in the end, of the component's first
    };

    void end();
    void right();
    void left();
    void close();
    void split(Index met);
    void splice(Index g, Index met);
    Index half_edge_met(int64_t meets) const;
    Index top() const;
    void match(Index h, Index g);
    void link(Index h, Index g);
    void move_closed_components();
    void add_first_triangle(Index at, Index gate);

    Index n_closed_, n_single_;
    Index n_triangles_;
    Index triangle_;  // the one being added; triangles are built n_closed_ places too far back or less
    std::vector<Index> opposite_;
    std::vector<Index> next_, previous_;  // along the loops, for half-edges without an opposite
    std::vector<Active> stack_;
};

}  // namespace ebz
