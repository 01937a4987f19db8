// An adaptive model of the reverse word for speed: two contexts, no mixing, no search.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "context_mixing.hpp"
#include "word_priors.hpp"
#include "word_view.hpp"

namespace ebz {

class DirectModel {
public:
    explicit DirectModel(Index) {
        for (size_t d = 0; d < n_decisions; ++d) {
            for (size_t i = 0; i < n_contexts; ++i) {
                // Both contexts begin with degree and latest two symbols, 3 more bits follow.
                const Estimate start = starting_estimate(degree_prior[d][i >> 9][i >> 3 & 63]);
                by_right_end_[d][i] = start;
                by_symbols_[d][(i & ~size_t{511}) | (i >> 3 & 63) | (i & 7) << 6] = start;
            }
        }
    }

    template <class Coder>
    Symbol code(Coder& coder, Symbol symbol, const WordView& view) {
        at_symbols_ = view.l0 << 9 | recent_;
        at_right_end_ = view.l0 << 9 | (recent_ & 63) << 3 | (std::min(view.r0, 9u) - 2);
        if (view.can_close && decide(coder, 0, symbol == C)) return C;
        if (decide(coder, 1, symbol == R)) return R;
        if (decide(coder, 2, symbol == L)) return L;
        if (!view.can_split) return E;
        return decide(coder, 3, symbol == S) ? S : E;
    }

    void advance(std::span<const uint8_t> symbols, Index position, uint32_t) {
        recent_ = (recent_ << 3 | (symbols[position] + 1u)) & 511;
    }

private:
    static constexpr size_t n_contexts = 1 << 13;
    using Estimates = std::vector<Estimate>;

    template <class Coder>
    bool decide(Coder& coder, size_t decision, bool bit) {
        Estimate& a = by_symbols_[decision][at_symbols_];
        Estimate& b = by_right_end_[decision][at_right_end_];
        bit = coder.bit(bit, bounded(squash((stretch(a.p12()) + stretch(b.p12())) * 9 / 16)));
        a.learn(bit);
        b.learn(bit);
        return bit;
    }

    std::array<Estimates, n_decisions> by_symbols_ = all(), by_right_end_ = all();
    uint32_t recent_ = 0, at_symbols_ = 0, at_right_end_ = 0;

    static std::array<Estimates, n_decisions> all() {
        std::array<Estimates, n_decisions> tables;
        tables.fill(Estimates(n_contexts));
        return tables;
    }
};

}  // namespace ebz
