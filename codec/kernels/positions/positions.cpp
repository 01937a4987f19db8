#include "positions.hpp"

#include <utility>

#include "../entropy/range_coder.hpp"
#include "axis_order.hpp"
#include "fast.hpp"
#include "float_coder.hpp"
#include "light.hpp"
#include "medium.hpp"
#include "strong.hpp"

namespace ebz::positions {

namespace {

// The first byte is the order of axes.
std::vector<uint8_t> encode_strong(const Surface& surface, std::span<const int64_t> values) {
    std::vector<uint8_t> shortest;
    for (const AxisOrder order : axis_orders(surface, values)) {
        // The shared path writes to each vertex what it read from it.
        std::vector<int64_t> copy(values.begin(), values.end());
        RangeEncoder coder;
        code_positions_strong(coder, surface, order, copy);
        std::vector<uint8_t> bytes = coder.finish();
        bytes.insert(bytes.begin(), order.last);
        if (shortest.empty() || bytes.size() < shortest.size()) shortest = std::move(bytes);
    }
    return shortest;
}

void decode_strong(std::span<const uint8_t> bytes, const Surface& surface, std::span<int64_t> values) {
    if (bytes.empty()) return;
    RangeDecoder coder(bytes.subspan(1));
    code_positions_strong(coder, surface, AxisOrder::of(bytes[0]), values);
}

template <class Space>
std::vector<uint8_t> encode_floats(const Surface& surface, std::span<const int64_t> values) {
    std::vector<int64_t> copy(values.begin(), values.end());
    RangeEncoder coder;
    FloatCoder<Space, RangeEncoder>(surface, copy, coder).run();
    return coder.finish();
}

template <class Space>
void decode_floats(std::span<const uint8_t> bytes, const Surface& surface, std::span<int64_t> values) {
    RangeDecoder coder(bytes);
    FloatCoder<Space, RangeDecoder>(surface, values, coder).run();
}

}  // namespace

std::vector<uint8_t> encode(const Surface& surface, std::span<const int64_t> values, Method method) {
    switch (method) {
        case Method::fast: return encode_positions_fast(surface, values);
        case Method::medium: return encode_positions_medium(surface, values);
        case Method::light: return encode_positions_light(surface, values);
        case Method::strong: return encode_strong(surface, values);
        case Method::float32_bits: return encode_floats<Float32Space>(surface, values);
        case Method::float64_bits: return encode_floats<Float64Space>(surface, values);
    }
    return {};
}

void decode(std::span<const uint8_t> bytes, const Surface& surface, Method method, std::span<int64_t> values) {
    switch (method) {
        case Method::light: return decode_positions_light(bytes, surface, values);
        case Method::strong: return decode_strong(bytes, surface, values);
        case Method::float32_bits: return decode_floats<Float32Space>(bytes, surface, values);
        case Method::float64_bits: return decode_floats<Float64Space>(bytes, surface, values);
        case Method::fast:
        case Method::medium: return;
    }
}

}  // namespace ebz::positions
