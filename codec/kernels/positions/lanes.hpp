// Four floats at a time, with the vector types that GCC and Clang share; every lane is plain IEEE.
#pragma once

#include <cstdint>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace ebz::positions {

using Lanes = float __attribute__((vector_size(16)));
using IntLanes = int32_t __attribute__((vector_size(16)));

inline Lanes splat(float x) { return Lanes{x, x, x, x}; }
#ifdef __SSE2__  // GCC makes four instructions of the equivalent a < b ? a : b
inline Lanes min(Lanes a, Lanes b) { return _mm_min_ps(a, b); }
inline Lanes max(Lanes a, Lanes b) { return _mm_max_ps(a, b); }
#else
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
#endif

// A fixed order of summation.
inline float sum(Lanes x) { return (x[0] + x[1]) + (x[2] + x[3]); }

// As in float_logistic.hpp.
inline Lanes exp2_approx(Lanes x) {
    const IntLanes whole = __builtin_convertvector(x + 128.0f, IntLanes) - 128;
    const Lanes part = x - __builtin_convertvector(whole, Lanes);
    return reinterpret_cast<Lanes>((whole + 127) << 23) * (1.0f + part * (0.6565f + 0.3435f * part));
}

inline Lanes log2_approx(Lanes x) {
    const IntLanes bits = reinterpret_cast<IntLanes>(x);
    const Lanes part = reinterpret_cast<Lanes>((bits & 0x7fffff) | 0x3f800000) - 1.0f;
    return __builtin_convertvector((bits >> 23) - 127, Lanes) + part * (1.343f - 0.343f * part);
}

inline Lanes squash(Lanes x) { return 1.0f / (1.0f + exp2_approx(-x)); }

}  // namespace ebz::positions
