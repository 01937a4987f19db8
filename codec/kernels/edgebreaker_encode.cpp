#include <algorithm>
#include <functional>

#include "edgebreaker.hpp"
#include "faces.hpp"
#include "touching_fans.hpp"

namespace ebz {

namespace {

class Encoder {
public:
    Encoder(const TriangleFaces& faces, Index n_vertices, std::span<const Index> opposite, const Fans& fans)
        : opposite_(opposite),
          vertex_(fans.vertex),
          touching_(faces, fans, n_vertices),
          position_of_(opposite.size() / 3, unvisited),
          marked_(fans.n_vertices),
          leaving_(fans.n_vertices, none) {
        for (Index h = 0; h < n_half_edges(); ++h) {
            if (opposite_[h] == none) leaving_[vertex_[h]] = h;
        }
        word_.symbols.reserve(position_of_.size());
        word_.gates.reserve(position_of_.size());
    }

    Word encode() {
        const auto on_boundary = [&](Index c) { return leaving_[vertex_[c]]; };
        each_component(on_boundary, [&](Index h) {
            if (opposite_[h] == none && !is_single(h / 3)) open_component(h);
        });
        each_component(std::identity(), [&](Index h) {
            if (!is_single(h / 3)) closed_component(h);
        });
        each_component(std::identity(), [&](Index h) { single_triangle(h); });
        const auto by_position = [](const SpecialS& a, const SpecialS& b) { return a.position < b.position; };
        std::sort(word_.specials.begin(), word_.specials.end(), by_position);
        return std::move(word_);
    }

private:
    static constexpr Index unvisited = -2, first_triangle = -1;

    struct Gate {
        Index half_edge;
        Index position;  // of the S that left it, none for a component's first gate
    };

    Index n_half_edges() const { return static_cast<Index>(opposite_.size()); }
    bool is_new(Index h) const { return position_of_[h / 3] == unvisited; }
    bool is_single(Index t) const {
        return opposite_[3 * t] == none && opposite_[3 * t + 1] == none && opposite_[3 * t + 2] == none;
    }

    // enter(h) codes the component of half-edge h if it is of the kind that is due; at(c) is where to enter
    // one that touches what is coded at corner c.
    template <class At, class Enter>
    void each_component(At at, Enter enter) {
        if (word_.gates.size() == position_of_.size()) return;
        touching_.each_half_edge(at, [&](Index h) {
            if (!is_new(h)) return;
            const size_t n_before = word_.gates.size();
            enter(h);
            if (touching_.any()) reach(n_before);
        });
    }

    void reach(size_t from) {
        for (size_t t = from; t < word_.gates.size(); ++t) {
            Index c = word_.gates[t];
            for (int side = 0; side < 3; ++side, c = next(c)) touching_.reach(c);
        }
    }

    void open_component(Index boundary) {
        mark_boundary(vertex_[boundary]);
        run(boundary);
    }

    void closed_component(Index corner) {
        const Index triangle = corner / 3;
        position_of_[triangle] = first_triangle;
        word_.gates.push_back(corner);
        ++word_.n_closed;
        for (Index c = 3 * triangle; c < 3 * triangle + 3; ++c) marked_[vertex_[c]] = true;
        run(opposite_[corner]);
    }

    void single_triangle(Index corner) {
        ++word_.n_single;
        emit(E, corner);
    }

    // Everything on the boundary loop through v counts as part of the active loop.
    void mark_boundary(Index v) {
        while (!marked_[v]) {
            marked_[v] = true;
            v = vertex_[next(leaving_[v])];
        }
    }

    void run(Index first_gate) {
        gates_.assign(1, {first_gate, none});
        while (!gates_.empty()) {
            const Gate gate = gates_.back();
            gates_.pop_back();
            if (is_new(gate.half_edge)) {
                region(gate.half_edge);
            } else {
                special(gate);
            }
        }
    }

    // The left loop of the S was reached from elsewhere: it was no loop of its own.
    void special(const Gate& gate) {
        const Index met = position_of_[gate.half_edge / 3];
        const Index side = (gate.half_edge + 3 - gate_of_triangle(gate.half_edge / 3)) % 3;
        word_.specials.push_back({gate.position, 2 * static_cast<int64_t>(met) + (side == 2)});
    }

    Index gate_of_triangle(Index t) const {
        // Closed components before this one have one triangle without a symbol each.
        return word_.gates[position_of_[t] + word_.n_closed];
    }

    // Removes triangles until an E; S leaves the left gate on the stack and goes on at the right.
    void region(Index gate) {
        for (;;) {
            const Index right = next(gate), left = previous(gate), tip = vertex_[left];
            if (!marked_[tip]) {
                const bool on_hole = leaving_[tip] != none;
                if (on_hole) {
                    mark_boundary(tip);
                    gates_.push_back({opposite_[left], position()});
                } else {
                    marked_[tip] = true;
                }
                emit(on_hole ? S : C, gate);
                gate = opposite_[right];
                continue;
            }
            const bool right_done = is_done(right), left_done = is_done(left);
            if (right_done && left_done) return emit(E, gate);
            if (!right_done && !left_done) gates_.push_back({opposite_[left], position()});
            emit(right_done ? R : left_done ? L : S, gate);
            gate = opposite_[right_done ? left : right];
        }
    }

    // Across h lies a boundary of the mesh, or a triangle already removed.
    bool is_done(Index h) const { return opposite_[h] == none || !is_new(opposite_[h]); }

    Index position() const { return static_cast<Index>(word_.symbols.size()); }

    void emit(Symbol symbol, Index gate) {
        position_of_[gate / 3] = position();
        word_.symbols.push_back(symbol);
        word_.gates.push_back(gate);
    }

    std::span<const Index> opposite_;
    std::span<const Index> vertex_;
    std::vector<Index> position_of_;  // of each triangle's symbol in the word
    std::vector<bool> marked_;        // vertices on a loop or behind it
    std::vector<Index> leaving_;      // the boundary half-edge that starts at a vertex
    std::vector<Gate> gates_;
    TouchingFans touching_;
    Word word_;
};

}  // namespace

Word encode_word(const TriangleFaces& faces, Index n_vertices, std::span<const Index> opposite, const Fans& fans) {
    return Encoder(faces, n_vertices, opposite, fans).encode();
}

}  // namespace ebz
