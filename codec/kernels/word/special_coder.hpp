// Where the left edge of a special S meets the surface built so far.
//
// Mostly that is a few steps along the top loop: a hole's boundary, or the way around a handle.  Else it
// is told how far back in the word the triangle is.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "../entropy/context_mixing.hpp"
#include "../errors.hpp"
#include "reverse.hpp"
#include "specials.hpp"

namespace ebz {

// Exp-Golomb codes whose widths are learnt from the first value on.
class FewIntegers {
public:
    template <class Coder>
    uint64_t code(Coder& coder, uint64_t value) {
        const int width = std::bit_width(value + 1) - 1;
        int n_bits = 0;
        while (n_bits < max_bits && more_[n_bits].code(coder, n_bits < width)) ++n_bits;
        uint64_t decoded = 1;
        for (int left = n_bits; left > 0;) {
            const int n = std::min(left, 16);
            left -= n;
            const uint32_t low = static_cast<uint32_t>((value + 1) >> left) & ((1u << n) - 1);
            decoded = decoded << n | coder.raw(low, n);
        }
        return decoded - 1;
    }

private:
    static constexpr int max_bits = 40;  // more than any position needs
    std::array<Estimate, max_bits> more_;
};

class SpecialCoder {
public:
    SpecialCoder(Index n_specials, Index n_symbols) : n_left_(n_specials), n_symbols_(n_symbols) {}

    bool any_left() const { return n_left_ > 0; }

    // What the S at `position` meets, none if it is not special; decoders pass anything.
    template <class Coder>
    int64_t code(Coder& coder, const Reverse& reverse, Index position, int64_t meets) {
        if (n_left_ == 0) return none;
        if (reverse.n_loops() > 1 && !special_.code(coder, meets != none)) return none;
        --n_left_;
        return code_meets(coder, reverse, position, meets);
    }

private:
    static constexpr int64_t steps_per_symbol = 16;
    static constexpr int least_steps = 2;  // the neighbours cannot be met

    struct Path {
        int64_t n_steps = 0;  // 0: not found
        bool to_left = false;
    };

    // The shorter way, left where they tie; the search counts against the same budget as the walks, so
    // what is found stays within it.
    Path find(const Reverse& reverse, Index met) {
        const Index gate = reverse.gate();
        Index left = gate, right = gate;
        for (int64_t n_steps = 1; n_steps <= search_left_; ++n_steps) {
            left = reverse.edge(left).previous;
            right = reverse.edge(right).next;
            const bool found = left == met || right == met;
            if (found || left == gate) {
                search_left_ -= n_steps;
                return {found ? n_steps : 0, left == met};
            }
        }
        search_left_ = 0;
        return {};
    }

    template <class Coder>
    int64_t code_meets(Coder& coder, const Reverse& reverse, Index position, int64_t meets) {
        Path path;
        if constexpr (Coder::encoding) path = find(reverse, reverse.edge_met(meets));
        if (!on_loop_.code(coder, path.n_steps > 0)) return code_far(coder, position, meets);
        path.to_left = to_left_.code(coder, path.to_left);
        const uint64_t more_steps = static_cast<uint64_t>(path.n_steps - least_steps);
        const int64_t n_steps = static_cast<int64_t>(steps_[path.to_left].code(coder, more_steps)) + least_steps;
        // Walking takes linear time in all.
        if (n_steps > steps_left_) throw Corrupt("special S walk too far along their loops");
        steps_left_ -= n_steps;
        return reverse.met_along_loop(n_steps, path.to_left);
    }

    template <class Coder>
    int64_t code_far(Coder& coder, Index position, int64_t meets) {
        const int64_t nearest = 2 * (static_cast<int64_t>(position) + 1);
        const uint64_t ahead = far_.code(coder, static_cast<uint64_t>(meets - nearest));
        if (ahead >= 2 * static_cast<uint64_t>(n_symbols_)) {
            throw Corrupt("a special S meets a triangle out of range");
        }
        return nearest + static_cast<int64_t>(ahead);
    }

    int64_t n_left_, n_symbols_;
    int64_t steps_left_ = steps_per_symbol * n_symbols_;
    int64_t search_left_ = steps_left_;
    Estimate special_, on_loop_, to_left_;
    std::array<FewIntegers, 2> steps_;
    FewIntegers far_;
};

// The special S of a word: known to an encoder, filled in by a decoder (by falling position).
class SpecialsOfWord {
public:
    SpecialsOfWord(Index n_specials, Index n_symbols, std::vector<SpecialS>& specials)
        : specials_(specials), known_(specials), coder_(n_specials, n_symbols) {}

    bool any_left() const { return coder_.any_left(); }

    void finish() const {
        if (any_left()) throw Corrupt("the word has fewer special S than declared");
    }

    // What an encoder's S at `position` meets, none if it is not special; positions fall from call to call.
    int64_t known(Index position) { return known_.take(position); }

    template <class Coder>
    int64_t code(Coder& coder, const Reverse& reverse, Index position, int64_t meets) {
        meets = coder_.code(coder, reverse, position, meets);
        if (!Coder::encoding && meets != none) specials_.push_back({position, meets});
        return meets;
    }

    // The symbol at `position` by the model and, if it is an S, what that meets.
    template <class Coder, class Model, class View>
    Symbol code_symbol(Coder& coder, Model& model, View view, const Reverse& reverse, Index position, Symbol symbol,
                       int64_t& meets) {
        view.can_split |= any_left();
        symbol = model.code(coder, symbol, view);
        if (symbol == S) meets = code(coder, reverse, position, meets);
        return symbol;
    }

private:
    std::vector<SpecialS>& specials_;
    SpecialsReversed known_;
    SpecialCoder coder_;
};

}  // namespace ebz
