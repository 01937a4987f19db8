// The order in which vertices are coded: those with most available parallelograms first.
//
// Reference: the idea is that of D. Cohen-Or, R. Cohen and R. Irony, "Multi-way geometry encoding",
// 2002, and of Draco's constrained multi-parallelogram order.  It depends on connectivity only.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "surface.hpp"

namespace ebz::positions {

class Traversal {
public:
    Traversal(const Surface& mesh, const CornersOfVertices& corners)
        : mesh_(mesh),
          corners_(corners),
          rank_(static_cast<size_t>(mesh.n_vertices), 0),
          n_parallelograms_(rank_.size(), 0),
          n_gates_(rank_.size(), 0),
          n_known_(mesh.vertex.size() / 3, 0) {}

    // The next vertex, or -1 after the last.  The one before becomes known.
    int32_t next_vertex() {
        if (current_ >= 0) settle(current_);
        current_ = pop();
        while (current_ < 0 && seed_ < mesh_.n_vertices) {
            if (!known(seed_)) current_ = seed_;
            ++seed_;
        }
        return current_;
    }

    bool known(int32_t v) const { return rank(v) != 0; }

    // 1, 2, ... in order of coding, 0 if not yet known.
    int32_t rank(int32_t v) const { return rank_[static_cast<size_t>(v)]; }

private:
    static constexpr int max_parallelograms = 7, max_gates = 7;
    static constexpr int n_buckets = (max_parallelograms + 1) * (max_gates + 1);
    static_assert(n_buckets <= 64, "one bit of occupied_ per bucket");

    int32_t vertex(int32_t c) const { return mesh_.vertex[static_cast<size_t>(c)]; }
    int32_t opposite(int32_t c) const { return mesh_.opposite[static_cast<size_t>(c)]; }
    int n_known_of_face(int32_t c) const { return n_known_[static_cast<size_t>(c / 3)]; }

    int priority(int32_t v) const {
        const auto at = static_cast<size_t>(v);
        return n_parallelograms_[at] * (max_gates + 1) + n_gates_[at];
    }

    void raise(std::vector<uint8_t>& counts, int32_t v, int limit) {
        uint8_t& count = counts[static_cast<size_t>(v)];
        if (known(v) || count >= limit) return;
        ++count;
        push(v);
    }

    void push(int32_t v) {
        const int p = priority(v);
        buckets_[static_cast<size_t>(p)].push_back(v);
        occupied_ |= uint64_t{1} << p;
    }

    void settle(int32_t v) {
        rank_[static_cast<size_t>(v)] = ++n_settled_;
        for (int32_t c : corners_[v]) {
            const int n = ++n_known_[static_cast<size_t>(c / 3)];
            if (n == 1 && priority(vertex(next(c))) == 0) push(vertex(next(c)));
            if (n == 2) open_gate(c);
            if (n == 3) offer_apex(c);
        }
    }

    // Two corners of the face are known: its third can be predicted across the edge between them.
    void open_gate(int32_t c) {
        const int32_t tip = known(vertex(next(c))) ? previous(c) : next(c);
        raise(n_gates_, vertex(tip), max_gates);
        const int32_t across = opposite(next(tip));
        if (across >= 0 && n_known_of_face(across) == 3) raise(n_parallelograms_, vertex(tip), max_parallelograms);
    }

    // The face is complete: it predicts the tips beyond its edges.
    void offer_apex(int32_t c) {
        for (int32_t edge : {c, next(c), previous(c)}) {
            const int32_t across = opposite(edge);
            if (across >= 0 && n_known_of_face(across) == 2)
                raise(n_parallelograms_, vertex(previous(across)), max_parallelograms);
        }
    }

    // Entries whose vertex has risen or become known since are stale and dropped.
    int32_t pop() {
        while (occupied_ != 0) {
            const int p = 63 - std::countl_zero(occupied_);
            auto& bucket = buckets_[static_cast<size_t>(p)];
            size_t& front = front_[static_cast<size_t>(p)];
            if (front == bucket.size()) {
                bucket.clear();
                front = 0;
                occupied_ &= ~(uint64_t{1} << p);
                continue;
            }
            const int32_t v = bucket[front++];
            if (!known(v) && priority(v) == p) return v;
        }
        return -1;
    }

    const Surface& mesh_;
    const CornersOfVertices& corners_;
    std::vector<int32_t> rank_;
    std::vector<uint8_t> n_parallelograms_, n_gates_;
    std::vector<uint8_t> n_known_;  // per face
    std::array<std::vector<int32_t>, n_buckets> buckets_;
    std::array<size_t, n_buckets> front_{};
    uint64_t occupied_ = 0;
    int32_t seed_ = 0, current_ = -1, n_settled_ = 0;
};

}  // namespace ebz::positions
