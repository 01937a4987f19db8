// Spirale Reversi: the reverse word -> triangles glued along half-edges, in one pass.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "edgebreaker.hpp"

namespace ebz {

// A half-edge on a loop, and what is known of the vertex where it starts.  A vertex that lies on loops
// in several places counts as several until they are joined.
struct LoopEdge {
    Index next, previous;
    uint8_t degree;  // edges at the vertex so far, at most max_degree
    uint8_t excess;  // of the vertices closed next to it: 8 + sum of (degree - 6), within 0 to 15
};

inline constexpr uint8_t max_degree = 15;

// Builds the triangles from the last to the first.  Whatever the symbols are, indices stay in range
// and opposite stays an involution: what cannot be done throws Corrupt.
class Reverse {
public:
    Reverse(Index n_symbols, Index n_closed, Index n_single);

    // One symbol, at a position that falls by one from call to call; meets is that of SpecialS, none
    // for all others.
    void apply(Symbol symbol, int64_t meets);

    bool has_loop() const { return !stack_.empty(); }
    size_t n_loops() const { return stack_.size(); }

    // The gate of a loop, the top one if nothing lies above it; it must be there.
    Index gate(size_t below = 0) const { return stack_[stack_.size() - 1 - below].gate; }

    // The half-edge some steps along the top loop from its gate, as in SpecialS.
    int64_t met_along_loop(int64_t n_steps, bool to_left) const;
    Index half_edge_met(int64_t meets) const;

    // A half-edge on a loop.
    const LoopEdge& edge(Index h) const { return loops_[h]; }

    // Adds the first triangles of the closed components; the opposite of each half-edge in output order.
    std::vector<Index> finish();

    Index n_closed() const { return n_closed_; }

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
    Index top() const;
    void match(Index h, Index g);
    void link(Index h, Index g);
    Index next_of(Index h) const { return loops_[h].next; }
    Index previous_of(Index h) const { return loops_[h].previous; }
    void start(Index h, LoopEdge vertex, uint8_t n_new_edges);
    void add_edge(Index h) { loops_[h].degree = std::min<uint8_t>(loops_[h].degree + 1, max_degree); }
    void add_excess(Index h, int excess);
    void move_closed_components();
    void add_first_triangle(Index at, Index gate);

    Index n_closed_, n_single_;
    Index n_triangles_;
    Index triangle_;  // the one being added; triangles are built n_closed_ places too far back or less
    std::vector<Index> opposite_;
    std::vector<LoopEdge> loops_;  // for half-edges without an opposite
    std::vector<Active> stack_;
};

}  // namespace ebz
