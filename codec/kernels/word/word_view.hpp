// What both sides know before a symbol: the degrees around the gate, the loops, the symbols so far.
#pragma once

#include <algorithm>
#include <cstdint>

#include "edgebreaker.hpp"
#include "loops.hpp"
#include "reverse.hpp"

namespace ebz {

// In three bits: C 1 to E 5, and where the triangle adds to a polygon C 6, L 7, S 0.
constexpr uint32_t history_code(Symbol symbol, bool in_polygon) {
    return !in_polygon ? symbol + 1u : symbol == C ? 6 : symbol == L ? 7 : 0;
}

// The symbols so far and the degrees of the vertices closed by the latest.
class WordHistory {
public:
    // The code of each symbol, the latest lowest; 0 before the first.
    uint64_t recent(int n = 21) const { return recent_ & ((uint64_t{1} << (3 * n)) - 1); }
    uint32_t latest(int n) const { return static_cast<uint32_t>(recent(n)); }  // n <= 10

    // Four bits each, the latest lowest.
    uint32_t closed_degrees(int n) const { return closed_degrees_ & ((uint32_t{1} << (4 * n)) - 1); }

    // Symbols since the latest C, at most 15.
    uint32_t since_close() const { return since_close_; }

    void advance(Symbol symbol, uint32_t left_degree, bool in_polygon = false) {
        recent_ = recent_ << 3 | history_code(symbol, in_polygon);
        since_close_ = symbol == C ? 0 : std::min(since_close_ + 1, 15u);
        if (symbol == C) closed_degrees_ = closed_degrees_ << 4 | left_degree;
    }

private:
    uint64_t recent_ = 0;
    uint32_t closed_degrees_ = 0x66666666;
    uint32_t since_close_ = 0;
};

// The top loop as seen from its gate; the vertices l0, l1, ... go left from the gate's left end along
// the loop, r0, r1, ... right from its right end.  All values fit four bits, lengths five.
struct WordView {
    uint32_t l0, l1, l2, l3, r0, r1, r2;  // degrees
    uint32_t excess_l0, excess_l1, excess_r0;
    uint32_t length, conflict;
    uint32_t below_length, below_l0, below_r0;  // the loop under the top one, 0 if there is none
    bool can_close, can_split;
    bool in_polygon = false;  // the triangle adds to the polygon of the latest, by C, L or S

    // There must be a loop.
    WordView(const Reverse& reverse, const LoopStack& loops) {
        const LoopEdge& gate = reverse.edge(reverse.gate());
        const LoopEdge& left1 = reverse.edge(gate.previous);
        const LoopEdge& left2 = reverse.edge(left1.previous);
        const LoopEdge& right0 = reverse.edge(gate.next);
        const LoopEdge& right1 = reverse.edge(right0.next);
        l0 = gate.degree, l1 = left1.degree, l2 = left2.degree;
        l3 = reverse.edge(left2.previous).degree;
        r0 = right0.degree, r1 = right1.degree, r2 = reverse.edge(right1.next).degree;
        excess_l0 = gate.excess, excess_l1 = left1.excess, excess_r0 = right0.excess;
        const Loop& top = loops.top();
        length = std::min(top.length, 31u), conflict = std::min(top.conflict, 15u);
        can_close = loops.allows_close();
        can_split = loops.size() > 1;
        below_length = below_l0 = below_r0 = 0;
        if (!can_split) return;
        const LoopEdge& below = reverse.edge(reverse.gate(1));
        below_length = std::min(loops.top(1).length, 31u);
        below_l0 = below.degree, below_r0 = reverse.edge(below.next).degree;
    }
};

}  // namespace ebz
