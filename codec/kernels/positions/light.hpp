// The light and medium methods, in the versions for several instruction sets that light_coder.hpp is compiled to.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../instructions.hpp"
#include "surface.hpp"

namespace ebz::positions {

inline namespace baseline {
std::vector<uint8_t> encode_light(const Surface& mesh, std::span<const int64_t> values, bool thorough);
void decode_light(std::span<const uint8_t> bytes, const Surface& mesh, std::span<int64_t> values, bool thorough);
}
inline namespace avx2 {
std::vector<uint8_t> encode_light(const Surface& mesh, std::span<const int64_t> values, bool thorough);
void decode_light(std::span<const uint8_t> bytes, const Surface& mesh, std::span<int64_t> values, bool thorough);
}

// thorough: light, else medium.
inline std::vector<uint8_t> encode_positions_light(const Surface& mesh, std::span<const int64_t> values, bool thorough) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::encode_light(mesh, values, thorough);
#endif
    return baseline::encode_light(mesh, values, thorough);
}

inline void decode_positions_light(std::span<const uint8_t> bytes, const Surface& mesh, std::span<int64_t> values, bool thorough) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::decode_light(bytes, mesh, values, thorough);
#endif
    baseline::decode_light(bytes, mesh, values, thorough);
}

}  // namespace ebz::positions
