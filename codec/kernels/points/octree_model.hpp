// How likely each child of an octree's cell holds points, from what is known around it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "cells.hpp"
#include "decision.hpp"
#include "neighbours.hpp"

namespace ebz::points {

using order::Weights;

// The children of a cell as bits, at least one.
class OctreeModel {
public:
    // level: of the children, 0 for single positions.  Decoders pass anything and use what comes back.
    template <class Coder>
    uint8_t code(Coder& coder, uint8_t children, const Cell& cell, const Surroundings& beside, int level) {
        const int n_beside = std::popcount(beside.present) - 1;
        if (code_single(coder, std::has_single_bit(children), cell, n_beside, level)) {
            return code_child(coder, children, cell, beside, level);
        }
        return code_several(coder, children, cell, beside, n_beside, level);
    }

private:
    static constexpr int max_level = 31, n_kinds = 9;

    static int capped(int level) { return std::min(level, max_level); }
    static int size_class(int n) { return n < 4 ? n : n < 7 ? 4 : n < 10 ? 5 : n < 14 ? 6 : 7; }

    template <class Coder>
    bool code_single(Coder& coder, bool is_single, const Cell& cell, int n_beside, int level) {
        Decision decision;
        const int chain = std::min<int>(cell.chain, 7);
        decision.add(single_by_level_.at(capped(level), chain));
        decision.add(single_by_siblings_.at(cell.siblings, chain, cell.is_remote));
        decision.add(single_by_beside_.at(n_beside, chain));
        decision.add(single_by_all_.at(size_class(n_beside), cell.siblings, capped(level)));
        return decision.code(coder, is_single);
    }

    // The one child that there is, axis by axis.
    template <class Coder>
    uint8_t code_child(Coder& coder, uint8_t children, const Cell& cell, const Surroundings& beside, int level) {
        const int child = std::countr_zero(children | 0x80u);
        int known = 0;
        for (int axis = 0; axis < 3; ++axis) {
            Decision decision;
            const auto [below, above] = sides(beside, axis, known);
            const int before = axis * 4 + known;
            decision.add(child_by_sides_.at(before, below, above));
            decision.add(child_by_history_.at(before, cell.child, std::min<int>(cell.chain, 3)));
            decision.add(child_by_level_.at(before, capped(level)));
            decision.add(child_by_faces_.at(before, faces(beside)));
            decision.add(child_by_touching_.at(before, touching(beside, axis)));
            decision.add(slab(axis, cell.at[axis], level), gains_[axis]);
            decision.add(column(axis, cell.at, known, level), gains_[3 + axis]);
            known = 2 * known + decision.code(coder, bit_on(child, axis));
        }
        return static_cast<uint8_t>(1u << known);
    }

    // At least two children, one after another.
    template <class Coder>
    uint8_t code_several(Coder& coder, uint8_t children, const Cell& cell, const Surroundings& beside, int n_beside,
                         int level) {
        uint32_t coded = 0;
        for (int child = 0; child < 8; ++child) {
            const int n = std::popcount(coded);
            bool holds = n + 8 - child <= 2;  // then all that are left are needed
            if (!holds) {
                Decision decision;
                const int before = before_mask(beside, child, coded), corner = corner_mask(beside, child);
                const int n_before = std::popcount(static_cast<uint32_t>(before));
                const int n_corner = std::popcount(static_cast<uint32_t>(corner));
                decision.add(by_before_.at(child, before));
                decision.add(by_corner_.at(std::min(n, 3), corner));
                decision.add(by_axes_.at(child, on_axes(before), on_axes(corner)));
                decision.add(by_siblings_.at((1u << child) | coded, size_class(n_beside)));
                decision.add(by_counts_.at(child, n_before, n_corner, std::min(n, 3)));
                decision.add(by_level_.at(child, capped(level), cell.siblings));
                for (int axis = 0; axis < 3; ++axis) {
                    Estimate& estimate = slab(3 + axis, 2 * cell.at[axis] + bit_on(child, axis), level);
                    decision.add(estimate, gains_[6 + axis]);
                }
                holds = decision.code(coder, children >> child & 1);
            }
            coded |= static_cast<uint32_t>(holds) << child;
        }
        return static_cast<uint8_t>(coded);
    }

    // Coordinates repeat: what followed the same leading bits on an axis.
    Estimate& slab(int kind, uint64_t at, int level) {
        return places_[mix(at, static_cast<uint64_t>(64 * kind + level)) >> (64 - place_bits)];
    }

    // The same beside the same leading bits on another axis.
    Estimate& column(int axis, const Position& at, int known, int level) {
        const uint64_t beside = axis == 0 ? at[1] : 2 * at[axis - 1] + static_cast<uint64_t>(known & 1);
        return slab(6 + axis, mix(at[axis], beside), level);
    }

    static constexpr int place_bits = 16;
    static_assert(64 * n_kinds <= 1 << place_bits);

    std::vector<Estimate> places_ = std::vector<Estimate>(1 << place_bits);
    std::array<Decision::Gains, n_kinds> gains_{};
    Weights<max_level + 1, 8> single_by_level_;
    Weights<8, 8, 2> single_by_siblings_;
    Weights<n_around, 8> single_by_beside_;
    Weights<8, 8, max_level + 1> single_by_all_;
    Weights<12, 10, 10> child_by_sides_;
    Weights<12, 8, 4> child_by_history_;
    Weights<12, max_level + 1> child_by_level_;
    Weights<12, 64> child_by_faces_;
    Weights<12, 16> child_by_touching_;
    Weights<8, 128> by_before_;
    Weights<4, 128> by_corner_;
    Weights<8, 8, 8> by_axes_;
    Weights<256, 8> by_siblings_;
    Weights<8, 8, 8, 4> by_counts_;
    Weights<8, max_level + 1, 8> by_level_;
};

}  // namespace ebz::points
