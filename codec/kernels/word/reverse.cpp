#include "reverse.hpp"

#include <numeric>

namespace ebz {

Reverse::Reverse(Index n_symbols, Index n_closed, Index n_single, PieceKind kind)
    : kind_(kind),
      n_closed_(n_closed),
      n_single_(n_single),
      n_triangles_(n_symbols + n_closed),
      triangle_(n_triangles_),
      opposite_(static_cast<size_t>(n_triangles_) * 3),
      vertex_(opposite_.size()),
      edges_(std::make_unique_for_overwrite<LoopEdge[]>(opposite_.size())) {}

void Reverse::uncount_gate() {
    LoopEdge& gate = edges_[top()];
    // Not so where they were cut off at max_degree.
    gate.degree -= gate.degree > 1;
    edges_[gate.next].degree -= edges_[gate.next].degree > 1;
}

Reverse::Gate Reverse::split(int64_t meets) {
    const Index n = top();
    if (meets != none) return splice(n, edge_met(meets));
    if (below_.empty()) throw Corrupt("the word has an S that lacks its left loop");
    const Index m = below_.back().gate;
    below_.pop_back();
    return splice(n, m);
}

// Joins two loops, or splits one in two, depending on where the two edges are.
Reverse::Gate Reverse::splice(Index n, Index m) {
    LoopEdge& gate = edges_[n];
    LoopEdge& met = edges_[m];  // becomes the gate
    // A loop keeps two edges at least.
    if (m == n || m == gate.next || m == gate.previous || met.next == m) {
        throw Corrupt("the word folds an edge onto its neighbour");
    }
    const Index h = 3 * triangle_, first = gate.next, last = gate.previous, beyond = met.next;
    set_corners(met.vertex, edges_[first].vertex, gate.vertex);
    match(h + 1, gate);
    match(h + 2, met);
    add_edge(met);
    add_edge(edges_[first]);
    add_edges(edges_[beyond], gate.degree);
    add_excess(edges_[beyond], gate.excess - 8);
    same_.emplace_back(edges_[beyond].vertex, gate.vertex);
    met.half_edge = h;
    met.next = first;
    edges_[first].previous = m;
    edges_[last].next = beyond;
    edges_[beyond].previous = last;
    lie_on_loop(h, m);
    release(n);
    return {m, met.degree};
}

Index Reverse::edge_met(int64_t meets) const {
    // Everything built since the loop below was last touched belongs to the component of the top loop.
    if (gate_ == none) throw Corrupt("the word needs a loop where there is none");
    const int64_t end = below_.empty() ? n_triangles_ - n_closed_ : below_.back().front;
    if (meets / 2 <= triangle_ - n_closed_ || meets / 2 >= end) {
        throw Corrupt("a special S meets a triangle out of range");
    }
    const int64_t triangle = meets / 2 + n_closed_;
    const Index across = opposite_[static_cast<size_t>(3 * triangle + 1 + meets % 2)];
    if (across >= 0) throw Corrupt("a special S meets an edge that is taken");
    return ~across;
}

int64_t Reverse::met_along_loop(int64_t n_steps, bool to_left) const {
    Index e = top();
    for (; n_steps > 0; --n_steps) e = to_left ? edges_[e].previous : edges_[e].next;
    const Index h = edges_[e].half_edge;
    if (h % 3 == 0) throw Corrupt("a special S meets a gate");
    return 2 * (static_cast<int64_t>(h / 3) - n_closed_) + (h % 3 == 2);
}

Connectivity Reverse::finish() {
    if (gate_ != none) below_.push_back(active(triangle_));
    if (below_.size() < static_cast<size_t>(n_closed_) + n_single_) {
        throw Corrupt("the word leaves fewer loops than there are components");
    }
    return numbered(move_closed_components());
}

// Word and closed components are in one array, where a closed component's own first triangle must come
// before its symbols: each moves towards the front by the number of closed components after it.  Returns the
// first triangle of each component.
std::vector<Index> Reverse::move_closed_components() {
    const size_t n_open = below_.size() - n_closed_ - n_single_;
    // From the top of the stack down: the components in the order of the word.
    const auto component = [&](size_t i) -> const Active& { return below_[below_.size() - 1 - i]; };
    const auto front = [&](size_t i) {
        return i < below_.size() ? component(i).front : n_triangles_ - n_closed_;
    };
    std::vector<Index> firsts;
    firsts.reserve(below_.size());
    for (size_t i = 0; i < n_open; ++i) firsts.push_back(front(i));
    if (n_open > 0) shift(0, front(n_open), n_closed_);
    for (Index j = 0; j < n_closed_; ++j) {
        const size_t i = n_open + j;
        const Index by = n_closed_ - 1 - j;
        const Active& active = component(i);
        const LoopEdge& a = edges_[active.gate];
        if (edges_[a.next].next != a.previous || a.previous == a.next) {
            throw Corrupt("a closed component ends in a loop of other than three edges");
        }
        shift(front(i), front(i + 1), by);
        add_first_triangle(active.front + j, a, by);
        firsts.push_back(active.front + j);
    }
    for (size_t i = n_open + n_closed_; i < below_.size(); ++i) firsts.push_back(front(i) + n_closed_);
    return firsts;
}

void Reverse::shift(Index from, Index to, Index by) {
    if (by == 0) return;
    for (Index h = 3 * (from + n_closed_); h < 3 * (to + n_closed_); ++h) {
        opposite_[h - 3 * by] = opposite_[h] < 0 ? none : opposite_[h] - 3 * by;
        vertex_[h - 3 * by] = vertex_[h];
    }
}

void Reverse::add_first_triangle(Index at, const LoopEdge& a, Index by) {
    const LoopEdge &b = edges_[a.previous], &c = edges_[a.next];
    Index h = 3 * at;
    for (const LoopEdge* across : {&a, &b, &c}) {
        opposite_[h] = across->half_edge - 3 * by;
        opposite_[across->half_edge - 3 * by] = h;
        ++h;
    }
    vertex_[3 * at] = c.vertex;
    vertex_[3 * at + 1] = a.vertex;
    vertex_[3 * at + 2] = b.vertex;
}

// Of each provisional vertex: itself, or the first that is the same.
std::vector<Index> Reverse::united_vertices() const {
    std::vector<Index> first(static_cast<size_t>(n_vertices_));
    std::iota(first.begin(), first.end(), 0);
    const auto root = [&](Index v) {
        while (first[v] != v) v = first[v] = first[first[v]];
        return v;
    };
    for (const auto& [v, w] : same_) {
        const Index a = root(v), b = root(w);
        first[std::max(a, b)] = std::min(a, b);
    }
    for (const auto& [v, w] : same_) first[v] = first[w] = root(v);
    return first;
}

// A triangle that is not the first of its component has its gate in common with an earlier one: only its
// third corner may be the first of a vertex.
Connectivity Reverse::numbered(const std::vector<Index>& firsts) {
    const std::vector<Index> same_as = united_vertices();
    std::vector<Index> number(same_as.size(), none);
    Index n = 0;
    // Without a branch: which are new is as good as random.
    const auto meet = [&](Index corner) {
        Index& known = number[same_as[vertex_[corner]]];
        const Index is_new = known >> 31;
        known = (known & ~is_new) | (n & is_new);
        n -= is_new;
    };
    for (size_t i = 0; i < firsts.size(); ++i) {
        const Index end = i + 1 < firsts.size() ? firsts[i + 1] : n_triangles_;
        meet(3 * firsts[i]);
        meet(3 * firsts[i] + 1);
        for (Index t = firsts[i]; t < end; ++t) meet(3 * t + 2);
    }
    for (const auto& [v, w] : same_) number[v] = number[w] = number[same_as[v]];
    Index all = 0;
    for (Index& v : vertex_) all |= v = number[v];
    if (all < 0) throw Corrupt("the word joins components");
    // Closed components have no loop left.
    if (firsts.size() > static_cast<size_t>(n_closed_))
        for (Index& h : opposite_) h = std::max(h, none);
    return {std::move(opposite_), {std::move(vertex_), n}};
}

}  // namespace ebz
