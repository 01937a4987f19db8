// An order of polygons across edges: those first of which most corners are known from others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../surface/faces.hpp"

namespace ebz::polygons {

class PolygonOrder {
public:
    PolygonOrder(const PolygonFaces& faces, std::span<const Index> across, Index n_vertices)
        : faces_(faces), across_(across), states_(static_cast<size_t>(faces.n_faces())),
          known_(static_cast<size_t>(n_vertices)) {}

    bool visited(Index face) const { return states_[static_cast<size_t>(face)] == is_visited; }
    bool known(Index corner) const { return known_[static_cast<size_t>(faces_[corner])]; }

    // visit(gate): for each polygon of three corners at least, before its corners become known.
    template <class Visit>
    void run(Visit visit) {
        for (Index f = 0; f < faces_.n_faces(); ++f) {
            if (visited(f) || faces_.size(f) < 3) continue;
            for (Index gate = faces_.first(f); gate != none; gate = next_gate()) {
                visit(gate);
                settle(gate);
            }
        }
    }

private:
    enum State : uint8_t { unmet, is_met, is_visited };

    // Each half-edge enters one of them, once.
    struct Queue {
        std::vector<Index> items;
        size_t begin = 0;
    };

    void settle(Index gate) {
        const Index face = faces_.face(gate);
        states_[static_cast<size_t>(face)] = is_visited;
        for (Index h = faces_.first(face); h < faces_.first(face + 1); ++h) known_[static_cast<size_t>(faces_[h])] = true;
        Index h = gate;
        do {
            cross(across_[static_cast<size_t>(h)]);
            h = faces_.next(h);
        } while (h != gate);
    }

    void cross(Index gate) {
        if (gate == none || visited(faces_.face(gate))) return;
        const Index face = faces_.face(gate);
        Index n_unknown = 0;
        for (Index h = faces_.first(face); h < faces_.first(face + 1); ++h) n_unknown += !known(h);
        if (n_unknown == 0) {
            complete_.push_back(gate);
        } else if (n_unknown < faces_.size(face) - 2 || states_[static_cast<size_t>(face)] == is_met) {
            near_.items.push_back(gate);
        } else {
            states_[static_cast<size_t>(face)] = is_met;
            far_.items.push_back(gate);
        }
    }

    Index next_gate() {
        while (!complete_.empty()) {
            const Index gate = complete_.back();
            complete_.pop_back();
            if (!visited(faces_.face(gate))) return gate;
        }
        for (Queue* queue : {&near_, &far_}) {
            while (queue->begin < queue->items.size()) {
                const Index gate = queue->items[queue->begin++];
                if (!visited(faces_.face(gate))) return gate;
            }
        }
        return none;
    }

    const PolygonFaces& faces_;
    std::span<const Index> across_;
    std::vector<uint8_t> states_;  // of polygons
    std::vector<bool> known_;      // vertices
    std::vector<Index> complete_;  // a stack of gates of polygons whose corners are known
    Queue near_, far_;             // of those met from several sides, and of those met from one
};

}  // namespace ebz::polygons
