// An order of vertices: across the edges of visited faces, to those vertices first that two faces predict.
//
// Reference: the idea is that of D. Cohen-Or, R. Cohen and R. Irony, "Multi-way geometry encoding", 2002.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "surface.hpp"

namespace ebz::positions {

// A vertex to be coded, and the vertices of the parallelograms that predict it.
struct PredictedVertex {
    int32_t vertex;
    int32_t a, b, o;  // across the edge from a to b from o
    int32_t c, d, p;  // the same of a second one, of the first again if there is none
    int32_t gate, second;  // the half-edges from a to b and from c to d; the same if there is no second one

    bool two() const { return gate != second; }
};

// A half-edge of a face that is not visited is a gate once the face across is; its tip is the face's third corner.
// Opposite half-edges have the same ends: a face is visited when all its corners are known.
class GateOrder {
public:
    explicit GateOrder(const Surface& mesh)
        : opposite_(mesh.opposite.data()), vertex_(mesh.vertex.data()), states_(static_cast<size_t>(mesh.n_vertices)),
          visited_(mesh.vertex.size() / 3), gate_(std::make_unique_for_overwrite<int32_t[]>(states_.size())),
          first_(mesh.vertex.size()), second_(mesh.vertex.size()), ready_(mesh.vertex.size()) {}

    bool known(int32_t v) const { return states_[static_cast<size_t>(v)] == is_known; }
    void learn(int32_t v) { states_[static_cast<size_t>(v)] = is_known; }
    bool visited(int32_t face) const { return visited_[static_cast<size_t>(face)] != 0; }

    // The first face of a component, whose corners are known.
    void enter(int32_t face) {
        cross(3 * face);
        visit_from(3 * face);
    }

    // Finds the next vertices, which are known from then on, as many as there is room for unless they are all.
    size_t next_vertices(std::span<PredictedVertex> found) {
        size_t n = 0;
        for (int32_t h; n < found.size() && (h = next_gate()) >= 0; ++n) {
            const int32_t v = vertex_[previous(h)], g = gate_[static_cast<size_t>(v)];
            found[n] = {v, vertex_[g], vertex_[next(g)], apex(g), vertex_[h], vertex_[next(h)], apex(h), g, h};
            learn(v);
            visit_from(h);
            visit_from(g);
        }
        return n;
    }

private:
    static constexpr uint8_t is_met = 1, is_known = 2;
    static constexpr size_t ahead = 8;  // gates that are prefetched

    // Each half-edge enters one of them, once.
    struct Queue {
        std::unique_ptr<int32_t[]> items;
        size_t begin = 0, end = 0;

        explicit Queue(size_t capacity) : items(std::make_unique_for_overwrite<int32_t[]>(capacity)) {}
        bool empty() const { return begin == end; }
        void push(int32_t h) { items[end++] = h; }
    };

    int32_t apex(int32_t gate) const { return vertex_[previous(opposite_[gate])]; }

    // A gate whose tip is unknown, -1 if there is none.
    int32_t next_gate() {
        while (true) {
            Queue& queue = second_.empty() ? first_ : second_;
            if (queue.empty()) return -1;
            const int32_t h = queue.items[queue.begin++];
            if (queue.begin + ahead < queue.end) {
                __builtin_prefetch(opposite_ + queue.items[queue.begin + ahead]);
                __builtin_prefetch(vertex_ + queue.items[queue.begin + ahead]);
            }
            if (visited(h / 3)) continue;
            if (!known(vertex_[previous(h)])) return h;
            visit_from(h);
        }
    }

    // A face whose corners are known, and those beyond its edges of which the same holds.
    void visit_from(int32_t h) {
        visit(h);
        while (ready_.end > 0) visit(ready_.items[--ready_.end]);
    }

    void visit(int32_t h) {
        uint8_t& mark = visited_[static_cast<size_t>(h / 3)];
        if (mark != 0) return;
        mark = 1;
        cross(next(h));
        cross(previous(h));
    }

    void cross(int32_t h) {
        const int32_t gate = opposite_[h];
        if (gate < 0 || visited(gate / 3)) return;
        const auto tip = static_cast<size_t>(vertex_[previous(gate)]);
        if (states_[tip] == is_known) return ready_.push(gate);
        if (states_[tip] == is_met) return second_.push(gate);
        states_[tip] = is_met;
        gate_[tip] = gate;
        first_.push(gate);
    }

    const int32_t *opposite_, *vertex_;
    std::vector<uint8_t> states_;   // of vertices
    std::vector<uint8_t> visited_;  // of faces
    std::unique_ptr<int32_t[]> gate_;  // the first one of each tip
    Queue first_, second_;  // the first gate of a tip, and the others
    Queue ready_;           // a stack of gates whose tip is known
};

}  // namespace ebz::positions
