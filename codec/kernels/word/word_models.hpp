// Probability models of the reverse word, as frozen integer tables.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edgebreaker.hpp"
#include "loops.hpp"
#include "../entropy/range_coder.hpp"

namespace ebz {

// The share of each symbol in 2^16, as where the shares of L, R, S and E start; that of C starts at 0.
// C may have no share, which forbids it; E always has one, so every start fits 16 bits.
class Shares {
public:
    Shares() = default;
    explicit Shares(std::span<const uint32_t> frequencies) {
        uint32_t sum = 0;
        for (size_t i = 0; i < starts_.size(); ++i) {
            sum += frequencies[i];
            starts_[i] = static_cast<uint16_t>(sum);
        }
    }

    void encode(RangeEncoder& coder, Symbol symbol) const {
        const uint32_t from = start(symbol), to = start(symbol + 1);
        if (from == to) throw Corrupt("the model forbids a symbol of the word");
        coder.symbol(from, to - from, probability_bits);
    }

    Symbol decode(RangeDecoder& coder) const {
        const int symbol = coder.count_below(starts_);
        coder.consume(start(symbol), start(symbol + 1) - start(symbol));
        return static_cast<Symbol>(symbol);
    }

private:
    uint32_t start(int symbol) const {
        return symbol == C ? 0 : symbol > E ? 1u << probability_bits : starts_[symbol - 1];
    }

    std::array<uint16_t, n_symbols - 1> starts_;
};

// A finite automaton that reads the reverse word; state 0 is where it starts and where it forgets.
class AutomatonModel {
public:
    struct State {
        Shares shares;
        std::array<uint16_t, n_symbols> successor;
    };

    // frequencies and successors: 5 per state, columns C, L, R, S, E; already checked by the caller:
    // every row of frequencies sums to 2^16, every successor is below the number of states.
    AutomatonModel(std::span<const uint32_t> frequencies, std::span<const uint16_t> successors)
        : states_(frequencies.size() / n_symbols) {
        for (size_t s = 0; s < states_.size(); ++s) {
            states_[s].shares = Shares(frequencies.subspan(s * n_symbols, n_symbols));
            std::copy_n(&successors[s * n_symbols], n_symbols, states_[s].successor.begin());
        }
    }

    const Shares& shares() const { return states_[state_].shares; }
    void advance(Symbol symbol, bool special) { state_ = special ? 0 : states_[state_].successor[symbol]; }

private:
    std::vector<State> states_;
    uint16_t state_ = 0;
};

// Probabilities that look at the decoder's real stack of loops (codec/models/stack.py has the rules).
class StackModel {
public:
    // frequencies: 5 per row; top: rows of n_conflicts by the length of the top loop; step: rows of
    // n_lengths by the class below.  Already checked: classes and columns are in range.
    StackModel(std::span<const uint32_t> frequencies, std::span<const uint8_t> top, uint32_t n_conflicts,
               std::span<const uint8_t> step, uint32_t n_lengths, uint8_t bottom)
        : rows_(frequencies.size() / n_symbols),
          top_(top.begin(), top.end()),
          step_(step.begin(), step.end()),
          longest_(static_cast<uint32_t>(top.size()) / n_conflicts - 1),
          n_conflicts_(n_conflicts),
          longest_below_(n_lengths - 1),
          n_columns_(static_cast<uint32_t>(rows_.size() / (step.size() / n_lengths))),
          loops_(1, {unknown_length, 0, bottom}) {
        for (size_t row = 0; row < rows_.size(); ++row) {
            rows_[row] = Shares(frequencies.subspan(row * n_symbols, n_symbols));
        }
    }

    const Shares& shares() const {
        const ClassedLoop& loop = loops_.back();
        return rows_[loop.below * n_columns_ + top_[std::min(loop.length, longest_) * n_conflicts_ + loop.conflict]];
    }

    void advance(Symbol symbol, bool special) {
        ClassedLoop& loop = loops_.back();
        switch (symbol) {
            case C: return set(loop, plus(loop.length, -1), loop.conflict - (loop.conflict > 0));
            case L: return set(loop, plus(loop.length, 1), 1);
            case R: return set(loop, plus(loop.length, 1), 0);
            case E: return push(loop);
            default: return special ? set(loop, unknown_length, 0) : join();
        }
    }

private:
    struct ClassedLoop {
        uint32_t length;
        uint32_t conflict;
        uint32_t below;  // class of the loops below
    };

    static uint32_t plus(uint32_t length, int change) {
        return length == unknown_length ? length : length + static_cast<uint32_t>(change);
    }

    static void set(ClassedLoop& loop, uint32_t length, uint32_t conflict) {
        loop.length = length;
        loop.conflict = conflict;
    }

    void push(const ClassedLoop& loop) {
        const uint32_t length = std::min(loop.length, longest_below_);
        loops_.push_back({3, 0, step_[loop.below * (longest_below_ + 1) + length]});
    }

    // LoopStack has already refused an S that lacks its left loop.
    void join() {
        const uint32_t right = loops_.back().length;
        loops_.pop_back();
        ClassedLoop& loop = loops_.back();
        const uint32_t left = loop.length;
        const bool sized = left != unknown_length && right != unknown_length;
        const bool remembered = left != unknown_length && left - 1 < n_conflicts_;
        set(loop, sized ? right + left - 1 : unknown_length, remembered ? left - 1 : 0);
    }

    std::vector<Shares> rows_;
    std::vector<uint8_t> top_, step_;
    uint32_t longest_, n_conflicts_, longest_below_, n_columns_;
    std::vector<ClassedLoop> loops_;  // the first is virtual
};

}  // namespace ebz
