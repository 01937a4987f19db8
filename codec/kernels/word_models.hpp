// Probability models of the reverse word, as frozen integer tables.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edgebreaker.hpp"
#include "loops.hpp"
#include "range_coder.hpp"

namespace ebz {

// The share of each symbol in 2^16; a symbol of share zero is forbidden.
struct Shares {
    std::array<uint32_t, n_symbols + 1> start;  // cumulative; start[5] = 2^16

    void encode(RangeEncoder& coder, Symbol symbol) const {
        const uint32_t frequency = start[symbol + 1] - start[symbol];
        if (frequency == 0) throw Corrupt("the model forbids a symbol of the word");
        coder.symbol(start[symbol], frequency, probability_bits);
    }

    Symbol decode(RangeDecoder& coder) const {
        const uint32_t position = coder.peek(probability_bits);
        int symbol = 0;
        while (position >= start[symbol + 1]) ++symbol;
        coder.consume(start[symbol], start[symbol + 1] - start[symbol]);
        return static_cast<Symbol>(symbol);
    }
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
            states_[s].shares.start[0] = 0;
            for (size_t i = 0; i < n_symbols; ++i) {
                states_[s].shares.start[i + 1] = states_[s].shares.start[i] + frequencies[s * n_symbols + i];
                states_[s].successor[i] = successors[s * n_symbols + i];
            }
        }
    }

    const Shares& shares(const LoopStack&) const { return states_[state_].shares; }
    void advance(Symbol symbol, bool special) { state_ = special ? 0 : states_[state_].successor[symbol]; }

private:
    std::vector<State> states_;
    uint16_t state_ = 0;
};

}  // namespace ebz
