// Predicts that what followed the same symbols earlier follows again.
//
// Reference: the match model of PAQ; M. Mahoney, 2002.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "edgebreaker.hpp"

namespace ebz {

class MatchModel {
public:
    // A context of n_context symbols (at most 21) is looked up.
    explicit MatchModel(int n_context, Index n_symbols)
        : n_context_(n_context), n_symbols_(n_symbols),
          shift_(64 - std::clamp(static_cast<int>(std::bit_width(static_cast<uint32_t>(n_symbols))), 8, 14)),
          latest_(size_t{1} << (64 - shift_)) {}

    static constexpr uint32_t no_symbol = n_symbols;

    // What followed, n_symbols if nothing matches.
    uint32_t predicted() const { return predicted_; }

    // Classes of the number of symbols that matched, 0 to 7.
    uint32_t confidence() const { return confidence_; }

    // symbols[position] is the latest, those before it have greater positions.
    void advance(std::span<const uint8_t> symbols, Index position, uint64_t recent) {
        if (length_ > 0 && symbols[at_] == symbols[position]) {
            length_ = std::min(length_ + 1, max_length);
            --at_;
        } else {
            length_ = 0;
        }
        const uint64_t key = recent & ((uint64_t{1} << (3 * n_context_)) - 1);
        const uint64_t hash = key * 0x9E3779B97F4A7C15u;
        Place& latest = latest_[hash >> shift_];
        const auto check = static_cast<uint32_t>(hash >> (shift_ - 32));
        if (length_ == 0 && latest.check == check) start(symbols, position, latest.after);
        latest = {position - 1, check};
        // A match that ran into the present has no symbol to offer yet.
        predicted_ = length_ > 0 ? symbols[at_] : n_symbols;
        confidence_ = length_ > 0 ? confidence_of(length_) : 0;
    }

private:
    static constexpr int max_length = 512, max_start = 32;

    struct Place {
        Index after = none;  // the position after the context
        uint32_t check = 0;  // further bits of its hash
    };

    void start(std::span<const uint8_t> symbols, Index position, Index after) {
        if (after == none) return;
        at_ = after;
        while (length_ < max_start && at_ + 1 + length_ < n_symbols_ &&
               symbols[at_ + 1 + length_] == symbols[position + length_]) {
            ++length_;
        }
        if (length_ < n_context_) length_ = 0;
    }

    static uint32_t confidence_of(int length) {
        constexpr std::array limits{15, 20, 24, 31, 100, 400};
        uint32_t passed = 1;
        for (const int limit : limits) passed += length > limit;
        return passed;
    }

    int n_context_;
    Index n_symbols_;
    int shift_;
    std::vector<Place> latest_;  // by hash of the context
    Index at_ = none;            // of the symbol predicted
    int length_ = 0;
    uint32_t predicted_ = no_symbol, confidence_ = 0;
};

}  // namespace ebz
