#include "adaptive_words.hpp"
#include "connectivity.hpp"
#include "errors.hpp"
#include "specials.hpp"

namespace ebz {

namespace {

// Runs the reverse construction and codes each symbol that it does not determine.
template <class Model, class Coder>
Reverse code_word(Coder& coder, const WordHeader& header, std::span<const SpecialS> specials,
                  std::span<uint8_t> symbols) {
    Reverse reverse(header.n_symbols, header.n_closed, header.n_single);
    LoopStack loops;
    SpecialsReversed reversed(specials);
    Model model(header.n_symbols);
    const Index first_single = header.n_symbols - header.n_single;
    for (Index position = header.n_symbols - 1; position >= 0; --position) {
        const int64_t meets = reversed.take(position);
        const bool special = meets != none;
        Symbol symbol = special ? S : E;
        uint8_t left_degree = 0;
        if (loops.size() > 0) {
            left_degree = reverse.edge(reverse.gate()).degree;
            if (!special && position < first_single) {
                symbol = model.code(coder, static_cast<Symbol>(symbols[position]), WordView(reverse, loops));
            }
        }
        if (Coder::encoding && symbols[position] != symbol) throw Corrupt("the word is not one of Edgebreaker's");
        symbols[position] = symbol;
        loops.apply(symbol, special);
        reverse.apply(symbol, meets);
        model.advance(symbols, position, left_degree);
    }
    if (!reversed.all_taken()) throw Corrupt("a special S lies outside the word");
    return reverse;
}

template <class Coder>
Reverse code_word(Effort effort, Coder& coder, const WordHeader& header, std::span<const SpecialS> specials,
                  std::span<uint8_t> symbols) {
    switch (effort) {
        case Effort::direct: return code_word<DirectModel>(coder, header, specials, symbols);
        case Effort::fast: return code_word<MixedModel<FastContexts>>(coder, header, specials, symbols);
        default: return code_word<MixedModel<StrongContexts>>(coder, header, specials, symbols);
    }
}

}  // namespace

std::vector<uint8_t> encode_adaptive(std::span<const uint8_t> symbols, const WordHeader& header,
                                     std::span<const SpecialS> specials, Effort effort) {
    std::vector<uint8_t> copy(symbols.begin(), symbols.end());
    RangeEncoder coder;
    code_word(effort, coder, header, specials, copy);
    return coder.finish();
}

DecodedConnectivity decode_adaptive(std::span<const uint8_t> bytes, const WordHeader& header,
                                    std::span<const SpecialS> specials, Effort effort) {
    DecodedConnectivity decoded;
    decoded.symbols.resize(header.n_symbols);
    RangeDecoder coder(bytes);
    Reverse reverse = code_word(effort, coder, header, specials, decoded.symbols);
    decoded.connectivity.opposite = reverse.finish();
    decoded.connectivity.fans = number_fans(decoded.connectivity.opposite);
    return decoded;
}

}  // namespace ebz
