// Spirale Reversi: the reverse word -> triangles glued along half-edges, in one pass.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "edgebreaker.hpp"
#include "../errors.hpp"

namespace ebz {

// An edge of a loop, and what is known of the vertex where it starts.  A vertex that lies on loops
// in several places counts as several until they are joined.
struct LoopEdge {
    Index next, previous;  // edges of the loop
    Index half_edge;
    Index vertex;    // provisional number
    uint8_t degree;  // edges at the vertex so far, 1 to max_degree
    uint8_t excess;  // of the vertices closed next to it: 8 + sum of (degree - 6, of polygons 4), within 0 to 15
};

inline constexpr uint8_t max_degree = 15;

// Builds the triangles from the last to the first.  Whatever the symbols are, indices stay in range
// and opposite stays an involution: what cannot be done throws Corrupt.
//
// Edges are recycled, so that those in use lie close together.
class Reverse {
public:
    Reverse(Index n_symbols, Index n_closed, Index n_single, PieceKind kind = PieceKind::triangles);

    // One symbol, at a position that falls by one from call to call; meets is that of SpecialS, none
    // for all others.  Returns the degree at the gate, which so need not be read again.  Excesses cost time
    // where nobody asks for them.
    template <bool has_excesses = true>
    uint8_t apply(Symbol symbol, int64_t meets);

    // The edge of the top loop's gate is a diagonal, which degrees do not count.
    void uncount_gate();

    size_t n_loops() const { return below_.size() + (gate_ != none); }

    // The gate of a loop, the top one if nothing lies above it; it must be there.
    Index gate(size_t below = 0) const { return below == 0 ? gate_ : below_[below_.size() - below].gate; }

    const LoopEdge& edge(Index e) const { return edges_[e]; }

    // What a special S meets that joins the edge some steps along the top loop from its gate.
    int64_t met_along_loop(int64_t n_steps, bool to_left) const;
    // The edge that a special S meets.
    Index edge_met(int64_t meets) const;

    // Adds the first triangles of the closed components; vertices are numbered by first corner.
    Connectivity finish();

private:
    struct Active {
        Index gate;
        Index front;  // the position of its latest symbol: in the end, of the component's first
    };

    // A gate, and the degree of the vertex where it starts.
    struct Gate {
        Index edge;
        uint8_t degree;
    };

    Gate end();
    Gate right();
    Gate left();
    template <bool has_excesses>
    Gate close();
    Gate split(int64_t meets);
    Gate splice(Index n, Index met);
    Index top() const;
    Index take();
    void release(Index e);
    Index new_vertex();
    void match(Index h, const LoopEdge& edge);
    void lie_on_loop(Index h, Index e) { opposite_[h] = ~e; }
    void set_corners(Index a, Index b, Index c);
    static uint8_t add_edge(LoopEdge& edge) {
        const uint8_t degree = edge.degree;
        return edge.degree = static_cast<uint8_t>(degree + (degree < max_degree));
    }
    static void add_edges(LoopEdge& edge, uint8_t n) {
        edge.degree = std::min<uint8_t>(edge.degree + n, max_degree);
    }
    static void add_excess(LoopEdge& edge, int excess) {
        edge.excess = static_cast<uint8_t>(std::clamp(edge.excess + excess, 0, 15));
    }
    Active active(Index next_triangle) const { return {gate_, next_triangle - n_closed_}; }
    std::vector<Index> move_closed_components();
    void shift(Index from, Index to, Index by);
    void add_first_triangle(Index at, const LoopEdge& a, Index by);
    std::vector<Index> united_vertices() const;
    Connectivity numbered(const std::vector<Index>& firsts);

    PieceKind kind_;
    Index n_closed_, n_single_;
    Index n_triangles_;
    Index triangle_;  // the one being added; triangles are built n_closed_ places too far back or less
    std::vector<Index> opposite_;  // ~e for the half-edge of an edge of a loop
    std::vector<Index> vertex_;    // of each corner, provisional
    std::unique_ptr<LoopEdge[]> edges_;   // three per triangle are enough
    std::vector<std::pair<Index, Index>> same_;  // provisional vertices that are one
    Index n_edges_ = 0, n_vertices_ = 0;
    Index free_ = none;  // edges to be used again, linked by next
    Index gate_ = none;  // of the top loop
    std::vector<Active> below_;  // the loops below it; in the end it is among them
};

// Once per triangle: inline.
template <bool has_excesses>
[[gnu::always_inline]] inline uint8_t Reverse::apply(Symbol symbol, int64_t meets) {
    --triangle_;
    Gate gate;
    switch (symbol) {
        case C: gate = close<has_excesses>(); break;
        case L: gate = left(); break;
        case R: gate = right(); break;
        case S: gate = split(meets); break;
        default: gate = end();
    }
    gate_ = gate.edge;
    return gate.degree;
}

inline Index Reverse::top() const {
    if (gate_ == none) throw Corrupt("the word needs a loop where there is none");
    return gate_;
}

inline Index Reverse::take() {
    if (free_ == none) return n_edges_++;
    const Index e = free_;
    free_ = edges_[e].next;
    return e;
}

inline void Reverse::release(Index e) {
    edges_[e].next = free_;
    free_ = e;
}

inline Index Reverse::new_vertex() { return n_vertices_++; }

inline void Reverse::match(Index h, const LoopEdge& edge) {
    Index* const opposite = opposite_.data();  // in a register whatever is written
    const Index across = edge.half_edge;
    opposite[h] = across;
    opposite[across] = h;
}

inline void Reverse::set_corners(Index a, Index b, Index c) {
    Index* const corners = &vertex_[3 * triangle_];
    corners[0] = a;
    corners[1] = b;
    corners[2] = c;
}

inline Reverse::Gate Reverse::end() {
    const Index g = take(), r = take(), l = take(), h = 3 * triangle_;
    const Index a = new_vertex(), b = new_vertex(), c = new_vertex();
    edges_[g] = {r, l, h, a, 2, 8};
    edges_[r] = {l, g, h + 1, b, 2, 8};
    edges_[l] = {g, r, h + 2, c, 2, 8};
    lie_on_loop(h, g);
    lie_on_loop(h + 1, r);
    lie_on_loop(h + 2, l);
    set_corners(a, b, c);
    if (gate_ != none) below_.push_back(active(triangle_ + 1));
    return {g, 2};
}

[[gnu::always_inline]] inline Reverse::Gate Reverse::right() {
    const Index n = top(), r = take(), h = 3 * triangle_;
    LoopEdge& gate = edges_[n];
    LoopEdge& after = edges_[gate.next];
    const Index tip = new_vertex();
    set_corners(gate.vertex, tip, after.vertex);
    match(h + 2, gate);
    edges_[r] = {gate.next, n, h + 1, tip, 2, 8};
    gate.half_edge = h;
    gate.next = after.previous = r;
    const uint8_t degree = add_edge(gate);
    add_edge(after);
    lie_on_loop(h, n);
    lie_on_loop(h + 1, r);
    return {n, degree};
}

[[gnu::always_inline]] inline Reverse::Gate Reverse::left() {
    const Index n = top(), g = take(), h = 3 * triangle_;
    LoopEdge& gate = edges_[n];  // becomes the left edge
    LoopEdge& after = edges_[gate.next];
    const Index tip = new_vertex();
    set_corners(tip, after.vertex, gate.vertex);
    match(h + 1, gate);
    edges_[g] = {gate.next, n, h, tip, 2, 8};
    gate.half_edge = h + 2;
    gate.next = after.previous = g;
    add_edge(gate);
    add_edge(after);
    lie_on_loop(h + 2, n);
    lie_on_loop(h, g);
    return {g, 2};
}

template <bool has_excesses>
[[gnu::always_inline]] inline Reverse::Gate Reverse::close() {
    const Index n = top(), h = 3 * triangle_;
    const LoopEdge& gate = edges_[n];
    const Index m = gate.previous;
    LoopEdge& met = edges_[m];  // becomes the gate
    LoopEdge& after = edges_[gate.next];
    const bool is_triangle = kind_ == PieceKind::triangles && met.previous == gate.next;
    if (met.previous == n || is_triangle) throw Corrupt("the word closes a loop that is too short");
    set_corners(met.vertex, after.vertex, gate.vertex);
    match(h + 1, gate);
    match(h + 2, met);
    const uint8_t degree = add_edge(met);
    add_edge(after);
    if constexpr (has_excesses) {
        const int excess = gate.degree - (kind_ == PieceKind::triangles ? 6 : 4);
        add_excess(met, excess);
        add_excess(after, excess);
    }
    met.half_edge = h;
    met.next = gate.next;
    after.previous = m;
    lie_on_loop(h, m);
    release(n);
    return {m, degree};
}

}  // namespace ebz
