#include "byte_planes.hpp"

#include <algorithm>

#include "adaptive_bit.hpp"

namespace ebz {

namespace {

class ByteModel {
public:
    template <class Coder>
    uint8_t code(Coder& coder, uint8_t above, uint8_t byte) {
        AdaptiveBit* tree = &bits_[above * size_t{256}];
        unsigned node = 1;
        for (int i = 7; i >= 0; --i) node = 2 * node + tree[node].code(coder, (byte >> i) & 1);
        return static_cast<uint8_t>(node);
    }

private:
    std::vector<AdaptiveBit> bits_{256 * 256};
};

// Columns beyond these share models: a model takes 256 KiB.
constexpr size_t max_models = 16;

template <class Coder>
void run(Coder& coder, std::span<uint8_t> rows, size_t stride) {
    std::vector<ByteModel> models(std::min(stride, max_models));
    for (size_t i = 0; i < rows.size(); ++i) {
        const uint8_t above = i >= stride ? rows[i - stride] : 0;
        rows[i] = models[i % stride % models.size()].code(coder, above, rows[i]);
    }
}

}  // namespace

std::vector<uint8_t> encode_rows(std::span<const uint8_t> rows, size_t stride) {
    std::vector<uint8_t> copy(rows.begin(), rows.end());
    RangeEncoder coder;
    run(coder, copy, stride);
    return coder.finish();
}

void decode_rows(std::span<const uint8_t> bytes, size_t stride, std::span<uint8_t> rows) {
    RangeDecoder coder(bytes);
    run(coder, rows, stride);
}

}  // namespace ebz
