#include "reverse.hpp"

#include "errors.hpp"

namespace ebz {

Reverse::Reverse(Index n_symbols, Index n_closed, Index n_single)
    : n_closed_(n_closed),
      n_single_(n_single),
      n_triangles_(n_symbols + n_closed),
      triangle_(n_triangles_),
      opposite_(static_cast<size_t>(n_triangles_) * 3, none),
      loops_(opposite_.size()) {}

void Reverse::split(Index met) {
    const Index g = top();
    if (met == none) {
        if (stack_.size() < 2) throw Corrupt("the word has an S that lacks its left loop");
        stack_.pop_back();
        met = stack_.back().gate;
    }
    splice(g, met);
}

// Joins two loops, or splits one in two, depending on where the two half-edges are.
void Reverse::splice(Index g, Index met) {
    const Index gate = 3 * triangle_;
    // A loop keeps two edges at least, and none of its links is to an edge that was matched.
    if (met == g || met == next_of(g) || met == previous_of(g) || next_of(met) == met) {
        throw Corrupt("the word folds an edge onto its neighbour");
    }
    const Index before = previous_of(met), after = next_of(met);
    start(gate, loops_[met], 1);
    add_edge(next_of(g));
    start(after, loops_[after], loops_[g].degree);
    add_excess(after, loops_[g].excess - new_vertex.excess);
    link(previous_of(g), after);
    link(gate, next_of(g));
    link(before, gate);
    match(gate + 1, g);
    match(gate + 2, met);
}

Index Reverse::half_edge_met(int64_t meets) const {
    // Everything built since the loop below was last touched belongs to the component of the top loop.
    if (stack_.empty()) throw Corrupt("the word needs a loop where there is none");
    const int64_t end = stack_.size() > 1 ? stack_[stack_.size() - 2].front : n_triangles_ - n_closed_;
    if (meets / 2 <= triangle_ - n_closed_ || meets / 2 >= end) {
        throw Corrupt("a special S meets a triangle out of range");
    }
    const int64_t triangle = meets / 2 + n_closed_;
    const Index met = static_cast<Index>(3 * triangle + 1 + meets % 2);
    if (opposite_[met] != none) throw Corrupt("a special S meets an edge that is taken");
    return met;
}

int64_t Reverse::met_along_loop(int64_t n_steps, bool to_left) const {
    Index h = top();
    for (; n_steps > 0; --n_steps) h = to_left ? previous_of(h) : next_of(h);
    if (h % 3 == 0) throw Corrupt("a special S meets a gate");
    return 2 * (static_cast<int64_t>(h / 3) - n_closed_) + (h % 3 == 2);
}

std::vector<Index> Reverse::finish() {
    if (stack_.size() < static_cast<size_t>(n_closed_) + n_single_) {
        throw Corrupt("the word leaves fewer loops than there are components");
    }
    move_closed_components();
    return std::move(opposite_);
}

// Word and closed components are in one array, where a closed component's own first triangle must come
// before its symbols: each moves towards the front by the number of closed components after it.
void Reverse::move_closed_components() {
    const size_t n_open = stack_.size() - n_closed_ - n_single_;
    // From the top of the stack down: the components in the order of the word.
    const auto component = [&](size_t i) -> const Active& { return stack_[stack_.size() - 1 - i]; };
    const auto shift_symbols = [&](Index from, Index to, Index by) {
        for (Index t = from; by != 0 && t < to; ++t) {
            for (int side = 0; side < 3; ++side) {
                const Index across = opposite_[3 * (t + n_closed_) + side];
                opposite_[3 * (t + n_closed_ - by) + side] = across == none ? none : across - 3 * by;
            }
        }
    };
    const auto front = [&](size_t i) {
        return i < stack_.size() ? component(i).front : n_triangles_ - n_closed_;
    };
    if (n_open > 0) shift_symbols(0, front(n_open), n_closed_);
    for (Index j = 0; j < n_closed_; ++j) {
        const size_t i = n_open + j;
        const Index by = n_closed_ - 1 - j;
        const Active& active = component(i);
        const Index a = active.gate, b = previous_of(a), c = next_of(a);
        if (next_of(c) != b || b == c) throw Corrupt("a closed component ends in a loop of other than three edges");
        shift_symbols(front(i), front(i + 1), by);
        add_first_triangle(active.front + j, a - 3 * by);
        match(3 * (active.front + j) + 1, b - 3 * by);
        match(3 * (active.front + j) + 2, c - 3 * by);
    }
}

void Reverse::add_first_triangle(Index at, Index gate) {
    opposite_[3 * at] = none;
    match(3 * at, gate);
}

}  // namespace ebz
