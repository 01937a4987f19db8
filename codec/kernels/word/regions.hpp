// What is left to encode: the vertices on its boundary loops, and the gates behind which regions lie.
#pragma once

#include <span>
#include <vector>

#include "../surface/corner_table.hpp"

namespace ebz {

template <class Faces>
class Regions {
public:
    Regions(const Faces& faces, std::span<const Index> opposite, std::span<const Index> vertex, Index n_vertices)
        : faces_(faces), vertex_(vertex), marked_(n_vertices), leaving_(n_vertices, none) {
        for (Index h = 0; h < static_cast<Index>(opposite.size()); ++h) {
            if (opposite[h] == none) leaving_[vertex_[h]] = h;
        }
    }

    // Vertices on a loop or behind it.
    bool is_marked(Index v) const { return marked_[v]; }
    void mark(Index v) { marked_[v] = true; }

    // The boundary half-edge that starts at a vertex.
    Index leaving(Index v) const { return leaving_[v]; }

    // Everything on the boundary loop through v counts as part of the active loop.
    void mark_boundary(Index v) {
        while (!marked_[v]) {
            marked_[v] = true;
            v = vertex_[faces_.next(leaving_[v])];
        }
    }

    // position: of the S that leaves the gate, none for a component's first gate.
    void leave(Index gate, Index position) { gates_.push_back({gate, position}); }

    // Those left last first: remove(gate) where its face is there, else meet(gate, position): the left loop
    // of the S was reached from elsewhere, it was no loop of its own.
    template <class IsNew, class Remove, class Meet>
    void run(IsNew is_new, Remove remove, Meet meet) {
        while (!gates_.empty()) {
            const Gate gate = gates_.back();
            gates_.pop_back();
            if (is_new(gate.half_edge)) remove(gate.half_edge);
            else meet(gate.half_edge, gate.position);
        }
    }

private:
    struct Gate {
        Index half_edge, position;
    };

    const Faces& faces_;
    std::span<const Index> vertex_;
    std::vector<uint8_t> marked_;
    std::vector<Index> leaving_;
    std::vector<Gate> gates_;
};

}  // namespace ebz
