// The fast method, in the versions for several instruction sets that fast_coder.hpp is compiled to.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../instructions.hpp"
#include "attributes.hpp"

namespace ebz::attributes {

inline namespace baseline {
std::vector<uint8_t> encode_fast(const Items& items, Space space, std::span<const int64_t> values);
void decode_fast(std::span<const uint8_t> bytes, const Items& items, Space space, std::span<int64_t> values);
}
inline namespace avx2 {
std::vector<uint8_t> encode_fast(const Items& items, Space space, std::span<const int64_t> values);
void decode_fast(std::span<const uint8_t> bytes, const Items& items, Space space, std::span<int64_t> values);
}

// Nothing where a value has more than 32 bits.
inline std::vector<uint8_t> encode_by_best_instructions(const Items& items, Space space, std::span<const int64_t> values) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::encode_fast(items, space, values);
#endif
    return baseline::encode_fast(items, space, values);
}

inline void decode_by_best_instructions(std::span<const uint8_t> bytes, const Items& items, Space space,
                                        std::span<int64_t> values) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::decode_fast(bytes, items, space, values);
#endif
    baseline::decode_fast(bytes, items, space, values);
}

}  // namespace ebz::attributes
