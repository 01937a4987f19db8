#include <algorithm>

#include "connectivity.hpp"
#include "direct_word.hpp"
#include "../errors.hpp"
#include "mixed_model.hpp"
#include "mixed_rows.hpp"
#include "special_coder.hpp"

namespace ebz {

namespace {

// The word as far as it is known: all of it when encoding.
struct Symbols {
    std::vector<uint8_t> symbols;
    std::vector<SpecialS> specials;  // decoded: by falling position
};

template <class Model, class Coder>
class WordCoder {
public:
    WordCoder(Coder& coder, const WordHeader& header, Index n_specials, Symbols& word)
        : coder_(coder),
          header_(header),
          word_(word),
          reverse_(header.n_symbols, header.n_closed, header.n_single),
          specials_(n_specials, header.n_symbols, word.specials),
          model_(header.n_symbols) {}

    // Runs the reverse construction and codes what that does not determine.
    Reverse run() {
        for (Index position = header_.n_symbols - 1; position >= 0; --position) step(position);
        specials_.finish();
        return std::move(reverse_);
    }

private:
    void step(Index position) {
        int64_t meets = specials_.known(position);
        const bool determined = loops_.size() == 0 || position >= header_.n_symbols - header_.n_single;
        const uint8_t left_degree = loops_.size() == 0 ? 0 : reverse_.edge(reverse_.gate()).degree;
        const Symbol symbol = determined ? E : code(position, meets);
        if (Coder::encoding && word_.symbols[position] != symbol) throw Corrupt("no word of Edgebreaker's");
        word_.symbols[position] = symbol;
        loops_.apply(symbol, meets != none);
        reverse_.apply(symbol, meets);
        model_.advance(word_.symbols, position, left_degree);
    }

    Symbol code(Index position, int64_t& meets) {
        WordView view(reverse_, loops_);
        const auto symbol = static_cast<Symbol>(word_.symbols[position]);
        return specials_.code_symbol(coder_, model_, view, reverse_, position, symbol, meets);
    }

    Coder& coder_;
    const WordHeader& header_;
    Symbols& word_;
    Reverse reverse_;
    LoopStack loops_;
    SpecialsOfWord specials_;
    Model model_;
};

// Calls work with the coder that the effort takes and what has been coded.
template <class Ans, class Range, class Work>
auto with_coder(Effort effort, const WordHeader& header, Index n_specials, Symbols& word, Work work, auto... source) {
    if (effort == Effort::strong) {
        Range coder(source...);
        Reverse reverse = WordCoder<MixedModel<StrongContexts>, Range>(coder, header, n_specials, word).run();
        return work(coder, reverse);
    }
    Ans ans(source...);
    if constexpr (Ans::encoding) ans.reserve(static_cast<size_t>(header.n_symbols));
    using Coder = SingleLane<Ans>;
    Reverse reverse = effort == Effort::direct
                          ? DirectWord<Coder, DirectRows>(Coder(ans), header, n_specials, word.symbols, word.specials).run()
                          : DirectWord<Coder, MixedRows>(Coder(ans), header, n_specials, word.symbols, word.specials).run();
    return work(ans, reverse);
}

}  // namespace

std::vector<uint8_t> encode_adaptive(std::span<const uint8_t> symbols, const WordHeader& header,
                                     std::span<const SpecialS> specials, Effort effort) {
    Symbols word{{symbols.begin(), symbols.end()}, {specials.begin(), specials.end()}};
    return with_coder<ans::Encoder<1>, RangeEncoder>(effort, header, static_cast<Index>(specials.size()), word,
                                                     [](auto& coder, Reverse&) { return coder.finish(); });
}

AdaptivelyDecoded decode_adaptive(std::span<const uint8_t> bytes, const WordHeader& header, Index n_specials,
                                  Effort effort) {
    Symbols word{std::vector<uint8_t>(header.n_symbols), {}};
    AdaptivelyDecoded decoded;
    decoded.word.connectivity = with_coder<ans::Decoder<1>, RangeDecoder>(
        effort, header, n_specials, word, [](auto&, Reverse& reverse) { return reverse.finish(); }, bytes);
    decoded.word.symbols = std::move(word.symbols);
    decoded.specials = std::move(word.specials);
    std::reverse(decoded.specials.begin(), decoded.specials.end());
    return decoded;
}

}  // namespace ebz
