#include "positions.hpp"

#include "../ans.hpp"
#include "../range_coder.hpp"
#include "fast.hpp"
#include "float_coder.hpp"
#include "light_coder.hpp"
#include "strong.hpp"

namespace ebz::positions {

namespace {

template <class Coder>
void code(Coder& coder, const Surface& surface, Method method, std::span<int64_t> values) {
    switch (method) {
        case Method::light: return code_positions_light(coder, surface, values);
        case Method::strong: return code_positions_strong(coder, surface, values);
        case Method::float32_bits: return FloatCoder<Float32Space, Coder>(surface, values, coder).run();
        case Method::float64_bits: return FloatCoder<Float64Space, Coder>(surface, values, coder).run();
        default: return;
    }
}

// Calls work with the coder that the method takes.
template <template <size_t> class Ans, class Range, class Work>
auto with_coder(Method method, const Surface& surface, std::span<int64_t> values, Work work, auto... source) {
    if (method == Method::medium) {
        Ans<1> coder(source...);
        code_positions_medium(coder, surface, values);
        return work(coder);
    }
    Range coder(source...);
    code(coder, surface, method, values);
    return work(coder);
}

}  // namespace

std::vector<uint8_t> encode(const Surface& surface, std::span<const int64_t> values, Method method) {
    if (method == Method::fast) return encode_positions_fast(surface, values);
    // The shared path writes to each vertex what it read from it.
    std::vector<int64_t> copy(values.begin(), values.end());
    const auto finish = [](auto& coder) { return coder.finish(); };
    return with_coder<ans::Encoder, RangeEncoder>(method, surface, copy, finish);
}

void decode(std::span<const uint8_t> bytes, const Surface& surface, Method method, std::span<int64_t> values) {
    if (method == Method::fast) return decode_positions_fast(bytes, surface, values);
    with_coder<ans::Decoder, RangeDecoder>(method, surface, values, [](auto&) {}, bytes);
}

}  // namespace ebz::positions
