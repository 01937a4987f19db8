#include "attributes.hpp"

#include <memory>

#include "../entropy/range_coder.hpp"
#include "fast.hpp"
#include "labels.hpp"
#include "neighbourhood.hpp"
#include "number_model.hpp"
#include "predictor.hpp"
#include "symbol_model.hpp"

namespace ebz::attributes {

namespace {

template <class Walk, class S, class Coder>
void code_numbers(Coder& coder, const Items& items, const Coding& coding, std::span<int64_t> values) {
    Walk walk(items);
    Neighbourhood around;
    Predictor<S> predictor(items, coding, values, walk.corners());
    const auto model = std::make_unique<NumberModel>(values.size());
    Expectation x;
    for (int32_t v; (v = walk.next()) >= 0;) {
        walk.surround(v, around);
        predictor.begin(v, around);
        for (size_t turn = 0; turn < items.n_components; ++turn) {
            predictor.expect(turn, x);
            int64_t& value = values[static_cast<size_t>(v) * items.n_components + predictor.component(turn)];
            const int64_t base = predictor.base();
            value = wrapping_sum(base, model->code(coder, x, wrapping_difference(value, base)));
            predictor.reveal(turn, value);
        }
        predictor.end();
    }
}

template <class Walk, class Coder>
void code_symbols(Coder& coder, const Items& items, std::span<int64_t> values) {
    Walk walk(items);
    Neighbourhood around;
    Labels labels(items, values);
    const auto model = std::make_unique<SymbolModel>(values.size(), code_width(coder, values));
    Likely x;
    for (int32_t v; (v = walk.next()) >= 0;) {
        walk.surround(v, around);
        labels.begin(v, around);
        for (size_t c = 0; c < items.n_components; ++c) {
            labels.expect(c, x);
            int64_t& value = values[static_cast<size_t>(v) * items.n_components + c];
            value = model->code(coder, x, value);
            labels.reveal(x, c, value);
        }
        labels.end();
    }
}

template <class Walk, class Coder>
void code_along(Coder& coder, const Items& items, const Coding& coding, std::span<int64_t> values) {
    if (coding.method == Method::symbols) return code_symbols<Walk>(coder, items, values);
    switch (coding.space) {
        case Space::integers: return code_numbers<Walk, IntegerSpace>(coder, items, coding, values);
        case Space::float32: return code_numbers<Walk, Float32>(coder, items, coding, values);
        case Space::float64: return code_numbers<Walk, Float64>(coder, items, coding, values);
    }
}

template <class Coder>
void code(Coder& coder, const Items& items, const Coding& coding, std::span<int64_t> values) {
    if (!items.item.empty()) return code_along<SurfaceWalk>(coder, items, coding, values);
    if (!items.opposite.empty()) return code_along<FaceWalk>(coder, items, coding, values);
    code_along<RowWalk>(coder, items, coding, values);
}

}  // namespace

std::vector<uint8_t> encode(const Items& items, const Coding& coding, std::span<const int64_t> values) {
    if (coding.method == Method::fast) return encode_by_best_instructions(items, coding.space, values);
    // The shared path writes to each item what it read from it.
    std::vector<int64_t> copy(values.begin(), values.end());
    RangeEncoder coder;
    code(coder, items, coding, copy);
    return coder.finish();
}

void decode(std::span<const uint8_t> bytes, const Items& items, const Coding& coding, std::span<int64_t> values) {
    if (coding.method == Method::fast) return decode_by_best_instructions(bytes, items, coding.space, values);
    RangeDecoder coder(bytes);
    code(coder, items, coding, values);
}

}  // namespace ebz::attributes
