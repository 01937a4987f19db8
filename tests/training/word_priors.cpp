// Learns word_priors.hpp from word files: see tests/training/README.md.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "word/mixed_model.hpp"

namespace ebz {

struct WordFile {
    std::array<int32_t, 5> sizes;  // symbols, closed components, single triangles, special S, vertices
    std::vector<uint8_t> symbols;
    std::vector<SpecialS> specials;

    explicit WordFile(const char* path) {
        std::ifstream file(path, std::ios::binary);
        file.read(reinterpret_cast<char*>(sizes.data()), sizeof sizes);
        symbols.resize(sizes[0]);
        specials.resize(sizes[3]);
        file.read(reinterpret_cast<char*>(symbols.data()), sizes[0]);
        file.read(reinterpret_cast<char*>(specials.data()), 16 * sizes[3]);
    }
};

// Passes the symbols that are coded to a visitor: visitor.code(view), then visitor.advance(position, degree).
template <class Visitor>
void replay(WordFile& word, int limit, Visitor&& visitor) {
    Reverse reverse(word.sizes[0], word.sizes[1], word.sizes[2]);
    LoopStack loops;
    size_t specials = word.specials.size();
    for (Index position = word.sizes[0] - 1, n = 0; position >= 0 && n < limit; --position) {
        const bool special = specials > 0 && word.specials[specials - 1].position == position;
        const int64_t meets = special ? word.specials[--specials].meets : none;
        const bool determined = loops.size() == 0 || position >= word.sizes[0] - word.sizes[2];
        const Symbol symbol = static_cast<Symbol>(word.symbols[position]);
        const uint8_t degree = loops.size() == 0 ? 0 : reverse.edge(reverse.gate()).degree;
        if (!determined) {
            WordView view(reverse, loops);
            view.can_split |= specials > 0 || special;
            visitor.code(symbol, view);
            ++n;
        }
        loops.apply(symbol, special);
        reverse.apply(symbol, meets);
        visitor.advance(position, degree);
    }
}

// Stands in for a coder, and adds up what coding costs.
struct Meter {
    static constexpr bool encoding = true;
    double bits = 0;
    bool bit(bool bit, uint32_t p1) {
        bits -= std::log2((bit ? p1 : 65536 - p1) / 65536.0);
        return bit;
    }
};

struct Counts {
    double n[n_decisions][16][64][2] = {};
};

struct CountVisitor {
    WordFile& word;
    Counts& counts;
    double weight;
    WordHistory history{};

    void add(int decision, const WordView& view, bool bit) {
        counts.n[decision][view.l0][history.latest(2)][bit] += weight;
    }

    void code(Symbol symbol, const WordView& view) {
        if (view.can_close) add(0, view, symbol == C);
        if (symbol == C) return;
        add(1, view, symbol == R);
        if (symbol == R) return;
        add(2, view, symbol == L);
        if (symbol != L && view.can_split) add(3, view, symbol == S);
    }

    void advance(Index position, uint8_t degree) {
        history.advance(static_cast<Symbol>(word.symbols[position]), degree);
    }
};

template <class Model>
struct ModelVisitor {
    WordFile& word;
    Model model;
    Meter meter{};

    void code(Symbol symbol, const WordView& view) { model.code(meter, symbol, view); }
    void advance(Index position, uint8_t degree) { model.advance(word.symbols, position, degree); }
};

constexpr int symbols_per_word = 6000;

struct Training {
    static inline DegreePrior degrees{};

    static void count(std::vector<WordFile>& words) {
        static Counts counts;
        for (WordFile& word : words) {
            const double weight = 1000.0 / std::min<double>(symbols_per_word, word.symbols.size());
            replay(word, symbols_per_word, CountVisitor{word, counts, std::min(weight, 1.0)});
        }
        for (int d = 0; d < n_decisions; ++d) {
            for (int degree = 0; degree < 16; ++degree) {
                for (int latest = 0; latest < 64; ++latest) {
                    const double* n = counts.n[d][degree][latest];
                    const double log_odds = 16 * std::log((n[1] + 0.4) / (n[0] + 0.4));
                    const int rounded = static_cast<int>(std::lround(std::clamp(log_odds, -96.0, 96.0)));
                    degrees[d][degree][latest] = n[0] + n[1] < 1 ? 0 : static_cast<int8_t>(rounded == 0 ? 1 : rounded);
                }
            }
        }
    }

    template <class MixerType>
    static void keep(MixerType& from, MixerType& to) {
        to.sets_ = from.sets_;
    }

    // Weights carry over from word to word, evidence does not.
    template <class Contexts>
    static MixingPrior<Contexts::n> weigh(std::vector<WordFile>& words, int n_epochs) {
        using Model = MixedModel<Contexts>;
        Model last(1000);
        for (int epoch = 0; epoch < n_epochs; ++epoch) {
            for (WordFile& word : words) {
                ModelVisitor<Model> visitor{word, Model(word.sizes[0])};
                keep(last.by_known_, visitor.model.by_known_);
                keep(last.by_symbols_, visitor.model.by_symbols_);
                keep(last.by_match_, visitor.model.by_match_);
                replay(word, symbols_per_word, visitor);
                std::swap(last.by_known_.sets_, visitor.model.by_known_.sets_);
                std::swap(last.by_symbols_.sets_, visitor.model.by_symbols_.sets_);
                std::swap(last.by_match_.sets_, visitor.model.by_match_.sets_);
            }
        }
        MixingPrior<Contexts::n> prior;
        for (int d = 0; d < n_decisions; ++d) {
            prior.weights[d] = mean(last.by_symbols_, d * 128, 128);
            for (int k = 0; k <= Contexts::n; ++k) {
                prior.by_known[d][k] = mean(last.by_known_, d * (Contexts::n + 1) + k, 1);
            }
        }
        return prior;
    }

    // Of the sets that were used: the others are where they started.
    template <int n>
    static std::array<int16_t, n> mean(const Mixer<n>& mixer, int first, int n_sets) {
        if (mixer.sets_.empty()) return {};  // the model does without
        std::array<double, n> sum{};
        double n_uses = 0;
        for (int s = first; s < first + n_sets; ++s) {
            const double uses = mixer.sets_[s].n_uses_ + 1e-9;
            n_uses += uses;
            for (int i = 0; i < n; ++i) sum[i] += uses * mixer.sets_[s].weights_[i];
        }
        std::array<int16_t, n> weights;
        for (int i = 0; i < n; ++i) weights[i] = static_cast<int16_t>(std::lround(sum[i] / n_uses / 16));
        return weights;
    }
};

template <class Row>
void print_row(const Row& row) {
    std::printf("{");
    for (const auto value : row) std::printf("%d, ", value);
    std::printf("},\n");
}

template <int n>
void print(const char* name, const MixingPrior<n>& prior) {
    std::printf("inline constexpr MixingPrior<%d> %s{{{\n", n, name);
    for (const auto& row : prior.weights) print_row(row);
    std::printf("}}, {{\n");
    for (const auto& rows : prior.by_known) {
        std::printf("{{");
        for (const auto& row : rows) print_row(row);
        std::printf("}},\n");
    }
    std::printf("}}};\n");
}

void print(const DegreePrior& prior) {
    std::printf("inline constexpr DegreePrior degree_prior = [] {\n    DegreePrior prior{};\n");
    for (int d = 0; d < n_decisions; ++d) {
        for (int degree = 0; degree < 16; ++degree) {
            const auto& row = prior[d][degree];
            if (std::all_of(row.begin(), row.end(), [](int8_t x) { return x == 0; })) continue;
            std::printf("prior[%d][%d] = ", d, degree);
            std::printf("{");
            for (const int8_t value : row) std::printf("%d, ", value);
            std::printf("};\n");
        }
    }
    std::printf("    return prior;\n}();\n");
}

}  // namespace ebz

int main(int argc, char** argv) {
    using namespace ebz;
    std::vector<WordFile> words;
    for (int i = 2; i < argc; ++i) words.emplace_back(argv[i]);
    const bool with_weights = std::strcmp(argv[1], "weights") == 0;
    Training::count(words);
    std::printf("// Made by tests/training/word_priors.cpp; not to be changed by hand.\n#pragma once\n\n");
    std::printf("#include \"word_prior.hpp\"\n\nnamespace ebz {\n\n// clang-format off\n");
    print(Training::degrees);
    print("fast_prior", with_weights ? Training::weigh<FastContexts>(words, 3) : FastContexts::prior);
    print("strong_prior", with_weights ? Training::weigh<StrongContexts>(words, 3) : StrongContexts::prior);
    std::printf("// clang-format on\n\n}  // namespace ebz\n");
}
