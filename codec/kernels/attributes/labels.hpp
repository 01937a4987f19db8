// Which labels are likely at an item: those around it, of the items before, and of its own components.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes.hpp"
#include "neighbourhood.hpp"
#include "symbol_model.hpp"

namespace ebz::attributes {

// The bits that all labels fit in, told first; one at least, so that each label has a cost.
template <class Coder>
int code_width(Coder& coder, std::span<const int64_t> values) {
    int64_t most = 0;
    if constexpr (Coder::encoding)
        for (const int64_t x : values) most = std::max(most, x);
    const auto width = static_cast<uint32_t>(std::bit_width(static_cast<uint64_t>(most)));
    return static_cast<int>(std::clamp<uint32_t>(coder.raw(width, 5), 1, SymbolModel::max_bits));
}

class Labels {
public:
    Labels(const Items& items, std::span<const int64_t> values)
        : items_(items), values_(values), history_(std::min(items.n_components, max_turns)) {}

    void begin(int32_t v, const Neighbourhood& around) {
        item_ = v;
        around_ = &around;
    }

    void expect(size_t c, Likely& x) {
        x.turn = c;
        x.candidates = 0;
        for (size_t k = 0; k < 4 && k < around_->n_neighbours; ++k) offer(x, k, around_->neighbours[k], c);
        offer(x, 4, last_, c);
        offer(x, 5, before_last_, c);
        if (c > 0) offer(x, 6, item_, c - 1);
        if (c > 1) offer(x, 7, item_, c - 2);
        for (size_t k = 0; k < n_candidates; ++k) {
            const unsigned before = c == 0 ? 0 : 1 + (hits_ >> k & 1);
            x.value_context[k] = static_cast<uint8_t>(before * 8 + history(c)[k]);
        }
        set_contexts(c, x);
    }

    void reveal(const Likely& x, size_t c, int64_t value) {
        hits_ = 0;
        for (size_t k = 0; k < n_candidates; ++k) {
            if ((x.candidates >> k & 1) == 0) continue;
            const bool hit = x.value[k] == value;
            hits_ |= (hit ? 1u : 0u) << k;
            history(c)[k] = static_cast<uint8_t>((history(c)[k] << 1 | (hit ? 1 : 0)) & 7);
        }
    }

    void end() {
        before_last_ = last_;
        last_ = item_;
    }

private:
    static constexpr size_t max_turns = 64;
    using History = std::array<uint8_t, n_candidates>;

    History& history(size_t c) { return history_[std::min(c, max_turns - 1)]; }

    void offer(Likely& x, size_t k, int32_t item, size_t c) const {
        x.value[k] = -1;
        if (item < 0) return;
        x.value[k] = values_[static_cast<size_t>(item) * items_.n_components + c];
        x.candidates |= 1u << k;
    }

    void set_contexts(size_t c, Likely& x) const {
        const auto label = [&](size_t k) { return (x.candidates >> k & 1) != 0 ? static_cast<uint64_t>(x.value[k]) : 0xfffff; };
        const uint64_t turn = std::min<uint64_t>(c, 255);
        const auto key = [&](uint64_t i, uint64_t a, uint64_t b, uint64_t d) { return hash(i << 8 | turn, a << 40 | b << 20 | d); };
        x.context[0] = key(0, 0, 0, 0);
        x.context[1] = key(1, 0, 0, label(0));
        x.context[2] = key(2, 0, label(1), label(0));
        x.context[3] = key(3, label(2), label(1), label(0));
        x.context[4] = key(4, 0, label(5), label(4));
        x.context[5] = key(5, 0, label(6), label(0));
        x.context[6] = key(6, label(7), label(6), c > 0 ? 0 : label(4));
        x.context[7] = key(7, around_->n_neighbours, label(4), label(0));
    }

    const Items& items_;
    std::span<const int64_t> values_;
    std::vector<History> history_;
    const Neighbourhood* around_ = nullptr;
    int32_t item_ = 0, last_ = -1, before_last_ = -1;
    unsigned hits_ = 0;
};

}  // namespace ebz::attributes
