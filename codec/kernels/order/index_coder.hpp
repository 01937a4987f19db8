// Permutations: index after index, each among those not used yet.
//
// An index is first compared with exact guesses, one decision each.  If none is right, the tree of unused
// indices is descended: without experience by the counts, which is the uniform code, and shifted by what
// was learnt about the distance from several anchors.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "log_odds.hpp"
#include "unused.hpp"

namespace ebz::order {

// An index that is likely to be the one; values that are no unused index are passed over.
struct Guess {
    int64_t value;
    int kind;
};

// What is known of an index before it is coded.
struct Expectation {
    static constexpr int max_guesses = 12, max_anchors = 8;

    void guess(int64_t value, int kind) { guesses[n_guesses++] = {value, kind}; }
    // Near what the index is thought to be; `none` where there is nothing.
    void anchor(int64_t value) { anchors[n_anchors++] = value; }

    std::array<Guess, max_guesses> guesses;
    std::array<int64_t, max_anchors> anchors;
    int n_guesses = 0, n_anchors = 0;
    int64_t reference = 0;           // distances of guesses are judged from here
    std::array<Index, 2> beside{none, none};  // indices coded before, whose kinds matter
};

template <class Coder>
class IndexCoder {
public:
    IndexCoder(Coder& coder, Index n) : coder_(coder), unused_(n), kind_(n) { error_.fill(4 * error_unit); }

    const Unused& unused() const { return unused_; }

    // Decoders pass anything and use what comes back.
    Index code(const Expectation& expected, Index index) {
        const int kind = try_guesses(expected, index);
        if (kind == missed) index = descend<true>(expected, index);
        unused_.take(index);
        kind_[index] = static_cast<uint8_t>(kind);
        learn_errors(expected, index);
        return index;
    }

    // With equal probabilities: log2(n!) bits for all n, and less than 0.1 % more for rounding.
    Index code_uniform(Index index) {
        index = descend<false>({}, index);
        unused_.take(index);
        return index;
    }

private:
    static constexpr int max_kinds = 14, missed = max_kinds, nothing = max_kinds + 1;
    static constexpr int n_places = 16, n_errors = 16, max_levels = 32;
    static constexpr int hit_base = -stretch_unit;  // a guess is right with probability 0.27 at first

    // The kind of the guess that is right, and the index by reference.
    int try_guesses(const Expectation& expected, Index& index) {
        int tried = 0;
        for (int i = 0; i < expected.n_guesses; ++i) {
            const Guess& guess = expected.guesses[i];
            if (!unused_.has(guess.value) || is_repeated(expected, i)) continue;
            LogOdds odds(hit_base);
            uint8_t& history = history_[guess.kind];
            odds.add(by_history_.at(guess.kind, history));
            odds.add(by_agreement_.at(guess.kind, agreement(expected, i), std::min(tried++, 7)));
            odds.add(by_distance_.at(guess.kind, distance_class(guess.value - expected.reference)));
            odds.add(by_kinds_.at(guess.kind, kind_at(expected.beside[0]), kind_at(expected.beside[1])));
            const bool hit = odds.code(coder_, guess.value == index);
            history = static_cast<uint8_t>((2 * history + hit) & 63);
            if (hit) {
                index = static_cast<Index>(guess.value);
                return guess.kind;
            }
        }
        return missed;
    }

    static bool is_repeated(const Expectation& expected, int i) {
        return std::any_of(expected.guesses.begin(), expected.guesses.begin() + i,
                           [&](const Guess& other) { return other.value == expected.guesses[i].value; });
    }

    // How many other guesses say the same.
    static int agreement(const Expectation& expected, int i) {
        int n = 0;
        for (int k = i + 1; k < expected.n_guesses; ++k) n += expected.guesses[k].value == expected.guesses[i].value;
        return std::min(n, 7);
    }

    // 0 to 63: small distances one by one, the others by size.
    static int distance_class(int64_t distance) {
        if (-16 < distance && distance < 16) return static_cast<int>(distance) + 16;
        return (distance < 0 ? 32 : 48) + size_class(distance) / 2;
    }

    static int size_class(int64_t distance) {
        return std::min(30, static_cast<int>(std::bit_width(static_cast<uint64_t>(distance < 0 ? -distance : distance))));
    }

    int kind_at(Index index) const { return index == none ? nothing : kind_[index]; }

    template <bool learnt>
    Index descend(const Expectation& expected, Index index) {
        size_t node = 1;
        int64_t first = 0;
        for (int level = unused_.height() - 1; level >= 0; --level) {
            const uint32_t left = unused_.count(2 * node), right = unused_.count(2 * node + 1);
            bool go_right = right > 0;
            if (left > 0 && right > 0) {
                const bool bit = (index >> level) & 1;
                go_right = learnt ? code_side(expected, level, first, left, right, bit) : code_share(left, right, bit);
            }
            node = 2 * node + go_right;
            first += int64_t{go_right} << level;
        }
        return static_cast<Index>(first);
    }

    bool code_share(uint32_t left, uint32_t right, bool bit) {
        const uint64_t share = (uint64_t{right} << probability_bits) / (uint64_t{left} + right);
        return coder_.bit(bit, static_cast<uint32_t>(std::max<uint64_t>(share, 1)));
    }

    bool code_side(const Expectation& expected, int level, int64_t first, uint32_t left, uint32_t right, bool bit) {
        LogOdds odds(logarithm(right) - logarithm(left));
        for (int k = 0; k < expected.n_anchors; ++k) {
            if (expected.anchors[k] == none) continue;
            const int place = place_of(expected.anchors[k] - first, level);
            odds.add(by_place_.at(k, level, place, std::min(error_[k] / error_unit, n_errors - 1)));
        }
        return odds.code(coder_, bit);
    }

    // Where an anchor lies, seen from a node of 2^(level + 1) indices: before, in an eighth of it, behind.
    static int place_of(int64_t offset, int level) {
        const int64_t width = int64_t{2} << level;
        if (offset < 0) return widths_away(-offset, level);
        if (offset >= width) return 12 + widths_away(offset - width, level);
        return 4 + static_cast<int>(level >= 2 ? offset >> (level - 2) : offset << (2 - level));
    }

    static int widths_away(int64_t distance, int level) {
        return std::min(3, static_cast<int>(std::bit_width(static_cast<uint64_t>(distance >> (level + 1)))));
    }

    // The size of each anchor's recent errors, in a sliding mean.
    void learn_errors(const Expectation& expected, Index index) {
        for (int k = 0; k < expected.n_anchors; ++k) {
            if (expected.anchors[k] == none) continue;
            error_[k] += (error_unit / 2 * size_class(expected.anchors[k] - index) - error_[k]) / 4;
        }
    }

    static constexpr int error_unit = 8;

    Coder& coder_;
    Unused unused_;
    std::vector<uint8_t> kind_;  // of the guess by which each index was coded
    std::array<uint8_t, max_kinds> history_{};
    std::array<int, Expectation::max_anchors> error_;
    Weights<max_kinds, 64> by_history_;
    Weights<max_kinds, 8, 8> by_agreement_;
    Weights<max_kinds, 64> by_distance_;
    Weights<max_kinds, max_kinds + 2, max_kinds + 2> by_kinds_;
    Weights<Expectation::max_anchors, max_levels, n_places, n_errors> by_place_;
};

}  // namespace ebz::order
