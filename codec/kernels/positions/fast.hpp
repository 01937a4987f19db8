// The fast method, in the versions for several instruction sets that fast_coder.hpp is compiled to.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../instructions.hpp"
#include "surface.hpp"

namespace ebz::positions {

// Positions are signed integers modulo 2^32; the coder keeps sizes for itself.
struct FastVertex {
    std::array<uint32_t, 3> position;
    uint32_t sizes;
};

inline namespace baseline {
std::vector<uint8_t> encode_fast(const Surface& mesh, std::span<const int64_t> values);
void decode_fast(std::span<const uint8_t> bytes, const Surface& mesh, std::span<FastVertex> vertices);
}
inline namespace avx2 {
std::vector<uint8_t> encode_fast(const Surface& mesh, std::span<const int64_t> values);
void decode_fast(std::span<const uint8_t> bytes, const Surface& mesh, std::span<FastVertex> vertices);
}

// Nothing where a value has more than 32 bits.
inline std::vector<uint8_t> encode_positions_fast(const Surface& mesh, std::span<const int64_t> values) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::encode_fast(mesh, values);
#endif
    return baseline::encode_fast(mesh, values);
}

// vertices: as many as the surface has, whatever they hold.
inline void decode_positions_fast(std::span<const uint8_t> bytes, const Surface& mesh, std::span<FastVertex> vertices) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::decode_fast(bytes, mesh, vertices);
#endif
    baseline::decode_fast(bytes, mesh, vertices);
}

}  // namespace ebz::positions
