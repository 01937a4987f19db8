// Spirale Reversi: the reverse word -> triangles glued along half-edges, in one pass.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "edgebreaker.hpp"
#include "errors.hpp"

namespace ebz {

// A half-edge on a loop, and what is known of the vertex where it starts.  A vertex that lies on loops
// in several places counts as several until they are joined.
struct LoopEdge {
    Index next, previous;
    uint8_t degree;  // edges at the vertex so far, at most max_degree
    uint8_t excess;  // of the vertices closed next to it: 8 + sum of (degree - 6), within 0 to 15
};

inline constexpr uint8_t max_degree = 15;
inline constexpr LoopEdge new_vertex{none, none, 2, 8};

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

// Once per triangle: inline.
inline void Reverse::apply(Symbol symbol, int64_t meets) {
    --triangle_;
    switch (symbol) {
        case C: close(); break;
        case L: left(); break;
        case R: right(); break;
        case S: split(meets == none ? none : half_edge_met(meets)); break;
        default: end();
    }
    stack_.back() = {3 * triangle_, triangle_ - n_closed_};
}

inline Index Reverse::top() const {
    if (stack_.empty()) throw Corrupt("the word needs a loop where there is none");
    return stack_.back().gate;
}

inline void Reverse::match(Index h, Index g) {
    opposite_[h] = g;
    opposite_[g] = h;
}

inline void Reverse::link(Index h, Index g) {
    loops_[h].next = g;
    loops_[g].previous = h;
}

// h starts at a vertex that is known from another half-edge, and that gets new edges.
inline void Reverse::start(Index h, LoopEdge vertex, uint8_t n_new_edges) {
    loops_[h].degree = std::min<uint8_t>(vertex.degree + n_new_edges, max_degree);
    loops_[h].excess = vertex.excess;
}

inline void Reverse::add_excess(Index h, int excess) {
    loops_[h].excess = static_cast<uint8_t>(std::clamp(loops_[h].excess + excess, 0, 15));
}

inline void Reverse::end() {
    const Index gate = 3 * triangle_;
    for (Index h = gate; h < gate + 3; ++h) {
        link(h, next(h));
        start(h, new_vertex, 0);
    }
    stack_.push_back({});
}

inline void Reverse::right() {
    const Index g = top(), gate = 3 * triangle_;
    start(gate, loops_[g], 1);
    start(gate + 1, new_vertex, 0);
    add_edge(next_of(g));
    link(previous_of(g), gate);
    link(gate, gate + 1);
    link(gate + 1, next_of(g));
    match(gate + 2, g);
}

inline void Reverse::left() {
    const Index g = top(), gate = 3 * triangle_;
    start(gate + 2, loops_[g], 1);
    start(gate, new_vertex, 0);
    add_edge(next_of(g));
    link(previous_of(g), gate + 2);
    link(gate + 2, gate);
    link(gate, next_of(g));
    match(gate + 1, g);
}

inline void Reverse::close() {
    const Index g = top(), gate = 3 * triangle_;
    const Index met = previous_of(g), before = previous_of(met);
    if (before == g || previous_of(before) == g) throw Corrupt("the word closes a loop of three edges");
    const int excess = loops_[g].degree - 6;
    start(gate, loops_[met], 1);
    add_edge(next_of(g));
    add_excess(gate, excess);
    add_excess(next_of(g), excess);
    link(before, gate);
    link(gate, next_of(g));
    match(gate + 1, g);
    match(gate + 2, met);
}

}  // namespace ebz
