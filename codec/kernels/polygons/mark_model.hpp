// Whether a triangle adds to the polygon of the latest one: by the sizes of polygons around and before.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "../entropy/context_mixing.hpp"
#include "../word/word_contexts.hpp"

namespace ebz::polygons {

// The sizes, as numbers of triangles, of the polygons built so far; the latest may still grow.
class Sizes {
public:
    explicit Sizes(Index n_triangles) : polygon_of_(n_triangles) {}

    void add(Index triangle, bool in_polygon) {
        if (!in_polygon) sizes_.push_back(0);
        sizes_.back() = static_cast<uint8_t>(std::min(sizes_.back() + 1, max_size));
        polygon_of_[triangle] = static_cast<Index>(sizes_.size()) - 1;
    }

    uint32_t at(const LoopEdge& edge) const { return sizes_[polygon_of_[edge.half_edge / 3]]; }

    // 0 the latest; 0 where there is none.
    uint32_t latest(size_t before) const { return before < sizes_.size() ? sizes_[sizes_.size() - 1 - before] : 0; }

private:
    static constexpr int max_size = 15;

    std::vector<Index> polygon_of_;  // of each triangle
    std::vector<uint8_t> sizes_;
};

class MarkModel {
public:
    explicit MarkModel(Index n_triangles) : sizes_(n_triangles), mixer_(16 * 16), tables_(n, 12) {
        std::array<int16_t, n> equal;
        equal.fill(1024 / 3);
        for (size_t set = 0; set < 16 * 16; ++set) mixer_.start(set, equal);
    }

    // The top loop is there, and its gate is that of the latest triangle.
    template <class Coder>
    bool code(Coder& coder, const Reverse& reverse, bool in_polygon) {
        find(reverse);
        Mixer<n>::Vector inputs{};
        for (int i = 0; i < n; ++i) inputs[i] = static_cast<int16_t>(stretch(estimate(i).p12()));
        auto& weights = mixer_.at(sizes_.latest(0) << 4 | sizes_.latest(1));
        const int mixed = weights.mix(inputs);
        in_polygon = coder.bit(in_polygon, bounded(squash(mixed)));
        weights.learn(inputs, mixed, in_polygon);
        for (int i = 0; i < n; ++i) estimate(i).learn(in_polygon);
        return in_polygon;
    }

    void advance(Symbol symbol, Index triangle, bool in_polygon) {
        sizes_.add(triangle, in_polygon);
        recent_ = recent_ << 3 | history_code(symbol, in_polygon);
    }

private:
    static constexpr int n = 6;

    Estimate& estimate(int i) { return evidence_[i]->estimates[0]; }

    void find(const Reverse& reverse) {
        const LoopEdge &gate = reverse.edge(reverse.gate()), &right = reverse.edge(gate.next),
                       &left = reverse.edge(gate.previous);
        const uint32_t size = sizes_.latest(0);
        const uint32_t around = pack(size, sizes_.at(left), sizes_.at(right)), degrees = pack(gate.degree, right.degree);
        int i = 0, n_known = 0;
        const auto add = [&](uint32_t a, uint32_t b = 0) {
            const uint32_t hash = context_hash(i, a, b);
            evidence_[i] = &tables_.at(i, hash);
            n_known += evidence_[i]->meet(hash);
            ++i;
        };
        add(pack(size, sizes_.latest(1), sizes_.latest(2), sizes_.latest(3)));
        add(around);
        add(pack(size, gate.degree, right.degree), recent_ & 7);
        add(around, degrees);
        add(size, recent_ & 0x7FFF);
        add(pack(around, sizes_.at(reverse.edge(left.previous)), sizes_.at(reverse.edge(right.next))));
    }

    Sizes sizes_;
    Mixer<n> mixer_;
    EvidenceTables tables_;
    std::array<Evidence*, n> evidence_{};
    uint32_t recent_ = 0;
};

}  // namespace ebz::polygons
