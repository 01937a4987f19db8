#include <algorithm>
#include <functional>

#include "edgebreaker.hpp"
#include "../surface/faces.hpp"
#include "regions.hpp"
#include "../surface/touching_fans.hpp"

namespace ebz {

namespace {

class Encoder {
public:
    Encoder(const TriangleFaces& faces, Index n_vertices, std::span<const Index> opposite, const Fans& fans)
        : opposite_(opposite),
          vertex_(fans.vertex),
          position_of_(opposite.size() / 3, unvisited),
          regions_(faces, opposite, fans.vertex, fans.n_vertices),
          touching_(faces, fans, n_vertices) {
        word_.symbols.reserve(position_of_.size());
        word_.gates.reserve(position_of_.size());
    }

    Word encode() {
        const auto on_boundary = [&](Index c) { return regions_.leaving(vertex_[c]); };
        const auto starts_open = [&](Index h) { return opposite_[h] == none && is_new(h) && !is_single(h / 3); };
        each_component(on_boundary, starts_open, [&](Index h) { open_component(h); });
        const auto starts_closed = [&](Index h) { return is_new(h) && !is_single(h / 3); };
        each_component(std::identity(), starts_closed, [&](Index h) { closed_component(h); });
        each_component(std::identity(), [&](Index h) { return is_new(h); }, [&](Index h) { single_triangle(h); });
        const auto by_position = [](const SpecialS& a, const SpecialS& b) { return a.position < b.position; };
        std::sort(word_.specials.begin(), word_.specials.end(), by_position);
        return std::move(word_);
    }

private:
    static constexpr Index unvisited = -2, first_triangle = -1;

    bool is_new(Index h) const { return position_of_[h / 3] == unvisited; }
    bool is_single(Index t) const {
        return opposite_[3 * t] == none && opposite_[3 * t + 1] == none && opposite_[3 * t + 2] == none;
    }

    // Calls code(h) for the components that start with h; at(c) is where to enter one that touches what is coded
    // at corner c.
    template <class At, class Starts, class Code>
    void each_component(At at, Starts starts, Code code) {
        if (has_all()) return;
        touching_.each_half_edge(at, [&](Index h) {
            if (!starts(h)) return true;
            const size_t n_before = word_.gates.size();
            code(h);
            if (touching_.any()) reach(n_before);
            return !has_all();
        });
    }

    bool has_all() const { return word_.gates.size() == position_of_.size(); }

    void reach(size_t from) {
        for (size_t t = from; t < word_.gates.size(); ++t) {
            Index c = word_.gates[t];
            for (int side = 0; side < 3; ++side, c = next(c)) touching_.reach(c);
        }
    }

    void open_component(Index boundary) {
        regions_.mark_boundary(vertex_[boundary]);
        run(boundary);
    }

    void closed_component(Index corner) {
        const Index triangle = corner / 3;
        position_of_[triangle] = first_triangle;
        word_.gates.push_back(corner);
        ++word_.n_closed;
        for (Index c = 3 * triangle; c < 3 * triangle + 3; ++c) regions_.mark(vertex_[c]);
        run(opposite_[corner]);
    }

    void single_triangle(Index corner) {
        ++word_.n_single;
        emit(E, corner);
    }

    void run(Index first_gate) {
        regions_.leave(first_gate, none);
        regions_.run([&](Index gate) { return is_new(gate); }, [&](Index gate) { region(gate); },
                     [&](Index gate, Index position) { special(gate, position); });
    }

    void special(Index gate, Index left_at) {
        const Index met = position_of_[gate / 3], side = (gate + 3 - gate_of_triangle(gate / 3)) % 3;
        word_.specials.push_back({left_at, 2 * static_cast<int64_t>(met) + (side == 2)});
    }

    Index gate_of_triangle(Index t) const {
        // Closed components before this one have one triangle without a symbol each.
        return word_.gates[position_of_[t] + word_.n_closed];
    }

    // Removes triangles until an E; S leaves the left gate on the stack and goes on at the right.
    void region(Index gate) {
        for (;;) {
            const Index right = next(gate), left = previous(gate), tip = vertex_[left];
            if (!regions_.is_marked(tip)) {
                const bool on_hole = regions_.leaving(tip) != none;
                if (on_hole) {
                    regions_.mark_boundary(tip);
                    regions_.leave(opposite_[left], position());
                } else {
                    regions_.mark(tip);
                }
                emit(on_hole ? S : C, gate);
                gate = opposite_[right];
                continue;
            }
            const bool right_done = is_done(right), left_done = is_done(left);
            if (right_done && left_done) return emit(E, gate);
            if (!right_done && !left_done) regions_.leave(opposite_[left], position());
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
    Regions<TriangleFaces> regions_;
    TouchingFans touching_;
    Word word_;
};

}  // namespace

Word encode_word(const TriangleFaces& faces, Index n_vertices, std::span<const Index> opposite, const Fans& fans) {
    return Encoder(faces, n_vertices, opposite, fans).encode();
}

}  // namespace ebz
