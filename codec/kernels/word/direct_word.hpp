// The reverse word, symbol by symbol, for speed: each symbol in one step.
//
// Lengths and conflicts of loops are not tracked: a C that they forbid is learnt to be rare.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "../entropy/adaptive_symbol.hpp"
#include "../entropy/ans.hpp"
#include "connectivity.hpp"
#include "../errors.hpp"
#include "reverse.hpp"
#include "special_coder.hpp"
#include "word_priors.hpp"

namespace ebz {

// A distribution per context: the degree of the gate's left end and the latest two symbols.
class DirectRows {
public:
    using Row = AdaptiveSymbol<8>;
    using History = uint32_t;  // the context of the next symbol
    static constexpr bool has_excesses = false;

    explicit DirectRows(std::span<const uint8_t>) : DirectRows(initial()) {}

    // latest: symbols, of which the latest two count.
    static uint32_t context(uint32_t degree, uint32_t latest) { return degree << 6 | (latest & 63); }

    const Row& at(uint32_t context) const { return rows_[context]; }

    Row& next(const Reverse&, History context) { return rows_[context]; }

    // degree: of the gate's left end after the symbol, the latest.
    static History after(History context, Index, Symbol symbol, uint8_t degree) {
        return DirectRows::context(degree, context << 3 | (symbol + 1u));
    }

    // Before the first symbol.
    static const DirectRows& initial() {
        static const DirectRows rows = from_prior();
        return rows;
    }

private:
    DirectRows() = default;

    static DirectRows from_prior() {
        DirectRows rows;
        for (uint32_t degree = 0; degree <= max_degree; ++degree)
            for (uint32_t latest = 0; latest < 64; ++latest) rows.rows_[context(degree, latest)] = Row(shares(degree, latest));
        return rows;
    }

    // The product of the decisions C or not, R or not, L or not, S or E.
    static std::array<uint32_t, n_symbols> shares(uint32_t degree, uint32_t latest) {
        std::array<uint32_t, n_symbols> shares{};
        uint32_t left = 1 << 16;
        constexpr std::array<Symbol, n_decisions> asked{C, R, L, S};
        for (size_t d = 0; d < n_decisions; ++d) {
            const auto p = static_cast<uint64_t>(squash(16 * degree_prior[d][degree][latest]));
            shares[asked[d]] = static_cast<uint32_t>(left * p >> 16);
            left -= shares[asked[d]];
        }
        shares[E] = left;
        return shares;
    }

    std::array<Row, (max_degree + 1) * 64> rows_;
};

// One lane of ANS with the interface of a range coder.
template <class Ans>
class SingleLane {
public:
    static constexpr bool encoding = Ans::encoding;

    explicit SingleLane(Ans& ans) : ans_(ans) {}

    // Calls work with the symbol as a constant.  A decoder finds it by branches: those that are foreseen take
    // the state off the path that all else waits for.
    template <class Row, class Work>
    void symbol(Row& row, Symbol symbol, Work work) {
        switch (find(row, symbol)) {
            case C: return take<C>(row, work);
            case L: return take<L>(row, work);
            case R: return take<R>(row, work);
            case S: return take<S>(row, work);
            default: return take<E>(row, work);
        }
    }

    // p1: of 2^16.
    bool bit(bool bit, uint32_t p1) { return ans_.bit(0, bit, std::clamp(p1 >> 1, 1u, 32767u)); }
    uint32_t raw(uint32_t value, int n_bits) { return ans_.raw(0, value, n_bits); }

private:
    template <class Row>
    Symbol find(const Row& row, Symbol known) const {
        if constexpr (Ans::encoding) {
            return known;
        } else {
            const uint32_t slot = ans_.slot(0, row);
            if (slot < row.start(L)) return C;
            if (slot >= row.start(R) && slot < row.start(S)) return R;
            if (slot < row.start(R)) return L;
            if (slot < row.start(E)) return S;
            if (slot < row.start(n_symbols)) return E;
            throw Corrupt("a symbol that is none of C, L, R, S, E");
        }
    }

    template <Symbol symbol, class Row, class Work>
    void take(Row& row, Work work) {
        if constexpr (Ans::encoding) ans_.symbol(0, row, symbol);
        else ans_.take(0, row, symbol);
        work(std::integral_constant<Symbol, symbol>{});
    }

    Ans& ans_;
};

template <class Coder, class Model>
class DirectWord {
public:
    // word: all of it when encoding; specials: by falling position when decoding.
    DirectWord(Coder coder, const WordHeader& header, Index n_specials, std::vector<uint8_t>& symbols,
               std::vector<SpecialS>& specials)
        : coder_(coder),
          header_(header),
          symbols_(symbols.data()),
          reverse_(header.n_symbols, header.n_closed, header.n_single),
          specials_(n_specials, header.n_symbols, specials),
          model_(symbols) {}

    // Runs the reverse construction and codes what that does not determine.
    Reverse run() {
        Index position = header_.n_symbols - 1;
        const Index n_coded = header_.n_symbols - std::max<Index>(header_.n_single, 1);
        History history{};
        for (; position >= 0 && position >= n_coded; --position) history = apply(history, position, E, none);
        for (; position >= 0; --position) {
            coder_.symbol(model_.next(reverse_, history), static_cast<Symbol>(symbols_[position]), [&](auto symbol) {
                const bool may_be_special = symbol == S && specials_.any_left();
                history = apply(history, position, symbol, may_be_special ? special(position) : none);
            });
        }
        specials_.finish();
        return std::move(reverse_);
    }

private:
    using History = typename Model::History;

    // What the model knows before the next symbol.
    [[gnu::always_inline]] History apply(const History& history, Index position, Symbol symbol, int64_t meets) {
        if (Coder::encoding && symbols_[position] != symbol) throw Corrupt("no word of Edgebreaker's");
        symbols_[position] = symbol;
        const uint8_t degree = reverse_.template apply<Model::has_excesses>(symbol, meets);
        return model_.after(history, position, symbol, degree);
    }

    int64_t special(Index position) {
        return specials_.code(coder_, reverse_, position, Coder::encoding ? specials_.known(position) : none);
    }

    Coder coder_;
    const WordHeader& header_;
    uint8_t* const symbols_;
    Reverse reverse_;
    SpecialsOfWord specials_;
    Model model_;
};

}  // namespace ebz
