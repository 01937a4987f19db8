#include "positions.hpp"

#include "../range_coder.hpp"
#include "fast.hpp"
#include "float_coder.hpp"
#include "light.hpp"
#include "medium.hpp"
#include "strong.hpp"

namespace ebz::positions {

namespace {

template <class Coder>
void code(Coder& coder, const Surface& surface, Method method, std::span<int64_t> values) {
    switch (method) {
        case Method::strong: return code_positions_strong(coder, surface, values);
        case Method::float32_bits: return FloatCoder<Float32Space, Coder>(surface, values, coder).run();
        case Method::float64_bits: return FloatCoder<Float64Space, Coder>(surface, values, coder).run();
        default: return;
    }
}

}  // namespace

std::vector<uint8_t> encode(const Surface& surface, std::span<const int64_t> values, Method method) {
    switch (method) {
        case Method::fast: return encode_positions_fast(surface, values);
        case Method::medium: return encode_positions_medium(surface, values);
        case Method::light: return encode_positions_light(surface, values);
        default: break;
    }
    // The shared path writes to each vertex what it read from it.
    std::vector<int64_t> copy(values.begin(), values.end());
    RangeEncoder coder;
    code(coder, surface, method, copy);
    return coder.finish();
}

void decode(std::span<const uint8_t> bytes, const Surface& surface, Method method, std::span<int64_t> values) {
    if (method == Method::light) return decode_positions_light(bytes, surface, values);
    RangeDecoder coder(bytes);
    code(coder, surface, method, values);
}

}  // namespace ebz::positions
