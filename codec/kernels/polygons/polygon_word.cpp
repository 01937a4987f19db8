#include <algorithm>

#include "../word/mixed_model.hpp"
#include "../word/special_coder.hpp"
#include "mark_model.hpp"
#include "polygons.hpp"

namespace ebz::polygons {

namespace {

// The word and its marks as far as they are known: all of them when encoding.
struct MarkedWord {
    std::vector<uint8_t> symbols;
    std::vector<SpecialS> specials;   // decoded: by falling position
    std::vector<uint8_t> marks;       // by position, then those of closed components' first triangles
};

// As the WordCoder of triangles (adaptive_connectivity.cpp), but that a mark comes before each symbol.
template <class Model, class Coder>
class PolygonCoder {
public:
    PolygonCoder(Coder& coder, const WordHeader& header, Index n_specials, MarkedWord& word)
        : coder_(coder),
          header_(header),
          word_(word),
          reverse_(header.n_symbols, header.n_closed, header.n_single, PieceKind::polygons),
          loops_(PieceKind::polygons),
          specials_(n_specials, header.n_symbols, word.specials),
          model_(header.n_symbols),
          mark_model_(header.n_symbols + header.n_closed),
          n_singles_left_(header.n_single) {}

    Reverse run() {
        for (Index position = header_.n_symbols - 1; position >= 0; --position) step(position);
        specials_.finish();
        for (uint8_t& mark : std::span(word_.marks).subspan(header_.n_symbols)) {
            mark = first_mark_.code(coder_, mark == goes_on) ? goes_on : last;
        }
        return std::move(reverse_);
    }

private:
    void step(Index position) {
        int64_t meets = specials_.known(position);
        const bool in_polygon = code_mark(word_.marks[position]);
        const bool determined = loops_.size() == 0 || is_single_;
        const uint8_t left_degree = loops_.size() == 0 ? 0 : reverse_.edge(reverse_.gate()).degree;
        const Symbol symbol = !determined ? code(position, in_polygon, meets) : in_polygon ? L : E;
        if (Coder::encoding && word_.symbols[position] != symbol) throw Corrupt("no word of Edgebreaker's");
        word_.symbols[position] = symbol;
        loops_.apply(symbol, meets != none);
        reverse_.apply(symbol, meets);
        model_.advance(word_.symbols, position, left_degree, in_polygon);
        mark_model_.advance(symbol, position + header_.n_closed, in_polygon);
    }

    // Whether the triangle adds to the polygon of the latest one.
    bool code_mark(uint8_t& mark) {
        if (loops_.size() > 0 && mark_model_.code(coder_, reverse_, mark == goes_on)) {
            reverse_.uncount_gate();
            mark = goes_on;
            return true;
        }
        is_single_ = n_singles_left_ > 0;
        if (is_single_) {
            --n_singles_left_;
            code_small(mark);
        } else {
            mark = last;
        }
        return false;
    }

    // Single triangles may stand for fewer corners.
    void code_small(uint8_t& mark) {
        if (!is_small_.code(coder_, mark != last)) {
            mark = last;
        } else {
            mark = is_one_.code(coder_, mark == one_corner) ? one_corner : two_corners;
        }
    }

    Symbol code(Index position, bool in_polygon, int64_t& meets) {
        WordView view(reverse_, loops_);
        view.in_polygon = in_polygon;
        const auto symbol = static_cast<Symbol>(word_.symbols[position]);
        return specials_.code_symbol(coder_, model_, view, reverse_, position, symbol, meets);
    }

    Coder& coder_;
    const WordHeader& header_;
    MarkedWord& word_;
    Reverse reverse_;
    LoopStack loops_;
    SpecialsOfWord specials_;
    Model model_;
    MarkModel mark_model_;
    bool is_single_ = false;  // the latest polygon is a component of its own, one of the last
    Index n_singles_left_;
    Estimate is_small_, is_one_, first_mark_;
};

template <class Coder>
Reverse code_word(Effort effort, Coder& coder, const WordHeader& header, Index n_specials, MarkedWord& word) {
    if (effort != Effort::strong) {
        return PolygonCoder<MixedModel<FastContexts>, Coder>(coder, header, n_specials, word).run();
    }
    return PolygonCoder<MixedModel<StrongContexts>, Coder>(coder, header, n_specials, word).run();
}

}  // namespace

std::vector<uint8_t> encode_adaptive(std::span<const uint8_t> symbols, std::span<const uint8_t> marks,
                                     const WordHeader& header, std::span<const SpecialS> specials,
                                     Effort effort) {
    MarkedWord word{{symbols.begin(), symbols.end()}, {specials.begin(), specials.end()}, {marks.begin(), marks.end()}};
    RangeEncoder coder;
    code_word(effort, coder, header, static_cast<Index>(specials.size()), word);
    return coder.finish();
}

DecodedPolygons decode_adaptive(std::span<const uint8_t> bytes, const WordHeader& header, Index n_specials,
                                Effort effort) {
    const size_t n_symbols = header.n_symbols;
    MarkedWord word{std::vector<uint8_t>(n_symbols), {}, std::vector<uint8_t>(n_symbols + header.n_closed)};
    RangeDecoder coder(bytes);
    Reverse reverse = code_word(effort, coder, header, n_specials, word);
    DecodedPolygons decoded{{{std::move(word.symbols), {}}, std::move(word.specials)}, std::move(word.marks)};
    std::reverse(decoded.triangles.specials.begin(), decoded.triangles.specials.end());
    decoded.triangles.word.connectivity = reverse.finish();
    return decoded;
}

}  // namespace ebz::polygons
