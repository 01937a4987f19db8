#include "text.hpp"

#include <algorithm>
#include <array>

#include "../order/log_odds.hpp"
#include "range_coder.hpp"

namespace ebz {

namespace {

// Learns the prior: codes nothing.
struct Reader {
    bool bit(bool bit, uint32_t) { return bit; }
};

}  // namespace

class TextModel {
public:
    // text: prior and text as one; what follows `at` is not looked at but to be coded.
    template <class Coder>
    uint8_t code(Coder& coder, std::span<const uint8_t> text, size_t at) {
        for (int order = 0; order < n_orders; ++order) hashes_[order] = hash_of_last(text, at, order);
        const int predicted = match_ > 0 ? text[match_] : -1;
        unsigned node = 1;
        for (int i = 7; i >= 0; --i) {
            const bool agrees = predicted >= 0 && (predicted + 256) >> (i + 1) == static_cast<int>(node);
            const bool guess = agrees && (predicted >> i & 1);
            node = 2 * node + code_bit(coder, node, agrees, guess, (text[at] >> i) & 1);
        }
        return static_cast<uint8_t>(node);
    }

    // Text up to `end` is known now.
    void learn(std::span<const uint8_t> text, size_t end) {
        if (match_ > 0 && text[match_] == text[end - 1]) {
            ++match_;
            length_ = std::min(length_ + 1, max_length);
        } else {
            match_ = length_ = 0;
        }
        if (end < match_order) return;
        uint32_t& place = places_[hash_of_last(text, end, match_order) >> (32 - place_bits)];
        if (match_ == 0) match_ = place;
        place = static_cast<uint32_t>(end);
    }

private:
    static constexpr int n_orders = 7, slot_bits = 14, place_bits = 12, max_length = 31;
    static constexpr size_t match_order = 4;

    template <class Coder>
    bool code_bit(Coder& coder, unsigned node, bool agrees, bool guess, bool bit) {
        order::LogOdds odds(0);
        for (int order = 0; order < n_orders; ++order) {
            const uint32_t slot = (hashes_[order] + node * 0x9E3779B1u) * 0x85EBCA6Bu;
            odds.add(slots_.at(order, slot >> (32 - slot_bits)));
        }
        if (agrees) odds.add(by_match_.at(length_, guess));
        return odds.code(coder, bit);
    }

    static uint32_t hash_of_last(std::span<const uint8_t> text, size_t end, size_t n) {
        uint32_t hash = static_cast<uint32_t>(n);
        for (size_t i = 1; i <= std::min(n, end); ++i) hash = (hash + text[end - i] + 1) * 0x2C9277B5u;
        return hash ^ hash >> 15;
    }

    order::Weights<n_orders, 1 << slot_bits> slots_;
    order::Weights<max_length + 1, 2> by_match_;
    std::array<uint32_t, n_orders> hashes_{};
    std::array<uint32_t, 1 << place_bits> places_{};
    size_t match_ = 0;  // of the byte that is expected next; 0: none
    int length_ = 0;
};

namespace {

template <class Coder>
void run(TextModel& model, Coder& coder, std::span<uint8_t> text, size_t begin) {
    for (size_t i = begin; i < text.size(); ++i) {
        text[i] = model.code(coder, text, i);
        model.learn(text, i + 1);
    }
}

// The prior, then room for n bytes.
std::vector<uint8_t> behind(const std::vector<uint8_t>& prior, size_t n) {
    std::vector<uint8_t> text(prior);
    text.resize(prior.size() + n);
    return text;
}

}  // namespace

TextCoder::TextCoder(std::span<const uint8_t> prior) : prior_(prior.begin(), prior.end()) {
    auto model = std::make_unique<TextModel>();
    Reader reader;
    run(*model, reader, prior_, 0);
    model_ = std::move(model);
}

TextCoder::~TextCoder() = default;

std::vector<uint8_t> TextCoder::encode(std::span<const uint8_t> text) const {
    TextModel model = *model_;
    std::vector<uint8_t> both = behind(prior_, text.size());
    std::copy(text.begin(), text.end(), both.begin() + static_cast<ptrdiff_t>(prior_.size()));
    RangeEncoder coder;
    run(model, coder, both, prior_.size());
    return coder.finish();
}

void TextCoder::decode(std::span<const uint8_t> bytes, std::span<uint8_t> text) const {
    TextModel model = *model_;
    std::vector<uint8_t> both = behind(prior_, text.size());
    RangeDecoder coder(bytes);
    run(model, coder, both, prior_.size());
    std::copy(both.begin() + static_cast<ptrdiff_t>(prior_.size()), both.end(), text.begin());
}

}  // namespace ebz
