#include "positions.hpp"

#include "../ans.hpp"
#include "../range_coder.hpp"
#include "fast_coder.hpp"
#include "float_coder.hpp"
#include "light_coder.hpp"
#include "strong_coder.hpp"

namespace ebz::positions {

namespace {

constexpr size_t n_axes = 3;

template <class Coder>
void code(Coder& coder, const Surface& surface, Method method, std::span<int64_t> values) {
    switch (method) {
        case Method::fast: break;
        case Method::light: return code_positions_light(coder, surface, values);
        case Method::strong: return code_positions_strong(coder, surface, values);
        case Method::float32_bits: return FloatCoder<Float32Space, Coder>(surface, values, coder).run();
        case Method::float64_bits: return FloatCoder<Float64Space, Coder>(surface, values, coder).run();
    }
}

}  // namespace

std::vector<uint8_t> encode(const Surface& surface, std::span<const int64_t> values, Method method) {
    // The shared path writes to each vertex what it read from it.
    std::vector<int64_t> copy(values.begin(), values.end());
    if (method == Method::fast) {
        ans::Encoder<n_axes> coder;
        code_positions_fast(coder, surface, std::span(copy));
        return coder.finish();
    }
    RangeEncoder coder;
    code(coder, surface, method, copy);
    return coder.finish();
}

void decode(std::span<const uint8_t> bytes, const Surface& surface, Method method, std::span<int64_t> values) {
    if (method == Method::fast) {
        ans::Decoder<n_axes> coder(bytes);
        return code_positions_fast(coder, surface, values);
    }
    RangeDecoder coder(bytes);
    code(coder, surface, method, values);
}

}  // namespace ebz::positions
