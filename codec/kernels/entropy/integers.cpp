#include "integers.hpp"

namespace ebz {

std::vector<uint8_t> encode_integers(std::span<const uint64_t> values, size_t n_columns) {
    std::vector<IntegerModel> models(n_columns);
    RangeEncoder coder;
    for (size_t i = 0; i < values.size(); ++i) models[i % n_columns].code(coder, values[i]);
    return coder.finish();
}

std::vector<uint64_t> decode_integers(std::span<const uint8_t> bytes, size_t n_rows, size_t n_columns) {
    std::vector<IntegerModel> models(n_columns);
    std::vector<uint64_t> values(n_rows * n_columns);
    RangeDecoder coder(bytes);
    for (size_t i = 0; i < values.size(); ++i) values[i] = models[i % n_columns].code(coder, 0);
    return values;
}

}  // namespace ebz
