// What is known of the decoder's stack of loops: lengths and conflicts.
//
// A loop (l, k) has l edges; the k-th successive C from now would re-create an edge that exists
// (k = 0: none would).  The rules are complete: they count Tutte's numbers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "edgebreaker.hpp"
#include "../errors.hpp"

namespace ebz {

struct Loop {
    uint32_t length;
    uint32_t conflict;
};

// The length of a loop after a special S; it stays above every real length and forbids nothing.
inline constexpr uint32_t unknown_length = 1u << 31;

class LoopStack {
public:
    // Of polygons, only loops of two edges cannot be closed: diagonals may repeat edges.
    explicit LoopStack(PieceKind kind = PieceKind::triangles)
        : has_conflicts_(kind == PieceKind::triangles), least_(has_conflicts_ ? 3 : 2) {}

    size_t size() const { return loops_.size(); }
    const Loop& top(size_t below = 0) const { return loops_[loops_.size() - 1 - below]; }
    bool allows_close() const { return loops_.back().length != least_ && loops_.back().conflict != 1; }

    // One reverse operation; a special S joins no loop of the stack.  Throws Corrupt where the
    // operation is not possible.
    void apply(Symbol symbol, bool special) {
        if (symbol == E) return loops_.push_back({3, 0});
        if (loops_.empty()) throw Corrupt("the word needs a loop where there is none");
        Loop& loop = loops_.back();
        switch (symbol) {
            case C:
                if (!allows_close()) throw Corrupt("the word has a C where it is forbidden");
                loop = {known(loop.length) ? loop.length - 1 : unknown_length,
                        loop.conflict ? loop.conflict - 1 : 0};
                break;
            case L: loop = {sum(loop.length, 1), has_conflicts_}; break;
            case R: loop = {sum(loop.length, 1), 0}; break;
            default: special ? forget() : join();
        }
    }

private:
    static bool known(uint32_t length) { return length < unknown_length; }
    static uint32_t sum(uint32_t a, uint32_t b) { return std::min(a + b, unknown_length); }

    void forget() { loops_.back() = {unknown_length, 0}; }

    void join() {
        if (loops_.size() < 2) throw Corrupt("the word has an S that lacks its left loop");
        const uint32_t right = loops_.back().length;
        loops_.pop_back();
        const uint32_t left = loops_.back().length;
        const bool sized = known(left) && known(right);
        loops_.back() = {sized ? sum(right, left - 1) : unknown_length, has_conflicts_ && known(left) ? left - 1 : 0};
    }

    bool has_conflicts_;
    uint32_t least_;
    std::vector<Loop> loops_;
};

}  // namespace ebz
