// Several floats at a time, with the vector types that GCC and Clang share; every lane is plain IEEE.
#pragma once

#include <cstdint>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "../instruction_set.hpp"
#include "float_logistic.hpp"

#if defined(__GNUC__) && !defined(__clang__)
// Wide vectors are passed by value, but only to functions that are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

using Lanes = float __attribute__((vector_size(16)));
using IntLanes = int32_t __attribute__((vector_size(16)));
using UintLanes = uint32_t __attribute__((vector_size(16)));
using WideLanes = float __attribute__((vector_size(32)));
using WideIntLanes = int32_t __attribute__((vector_size(32)));

// The integers that comparisons of such vectors give.
template <class Floats>
using IntsOf = decltype(Floats{} < Floats{});

template <class Floats>
Floats splat(float x) {
    if constexpr (sizeof(Floats) == 16) return Floats{x, x, x, x};
    else return Floats{x, x, x, x, x, x, x, x};
}

// GCC makes four instructions of the equivalent a < b ? a : b.
#ifdef __SSE2__
inline Lanes min(Lanes a, Lanes b) { return _mm_min_ps(a, b); }
inline Lanes max(Lanes a, Lanes b) { return _mm_max_ps(a, b); }
#else
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
#endif

#ifdef EBZ_AVX2
inline WideLanes min(WideLanes a, WideLanes b) { return _mm256_min_ps(a, b); }
inline WideLanes max(WideLanes a, WideLanes b) { return _mm256_max_ps(a, b); }
#else
inline Lanes low_half(WideLanes x) { return Lanes{x[0], x[1], x[2], x[3]}; }
inline Lanes high_half(WideLanes x) { return Lanes{x[4], x[5], x[6], x[7]}; }
inline WideLanes joined(Lanes a, Lanes b) { return WideLanes{a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]}; }
inline WideLanes min(WideLanes a, WideLanes b) {
    return joined(min(low_half(a), low_half(b)), min(high_half(a), high_half(b)));
}
inline WideLanes max(WideLanes a, WideLanes b) {
    return joined(max(low_half(a), low_half(b)), max(high_half(a), high_half(b)));
}
#endif

// A fixed order of summation.
inline float sum(Lanes x) { return (x[0] + x[1]) + (x[2] + x[3]); }
inline float sum(WideLanes x) { return ((x[0] + x[4]) + (x[1] + x[5])) + ((x[2] + x[6]) + (x[3] + x[7])); }

// All ones in the lanes whose bit is set.
inline WideIntLanes lanes_of(unsigned bits) {
    constexpr WideIntLanes each = {1, 2, 4, 8, 16, 32, 64, 128};
    const auto b = static_cast<int32_t>(bits);
    return (WideIntLanes{b, b, b, b, b, b, b, b} & each) != 0;
}

// x where the mask is all ones, else 0.
inline WideLanes only(WideIntLanes mask, WideLanes x) {
    return reinterpret_cast<WideLanes>(mask & reinterpret_cast<WideIntLanes>(x));
}

// As in float_logistic.hpp.
template <class Floats>
Floats exp2_approx(Floats x) {
    using Ints = IntsOf<Floats>;
    const Ints whole = __builtin_convertvector(x + 128.0f, Ints) - 128;
    const Floats part = x - __builtin_convertvector(whole, Floats);
    return reinterpret_cast<Floats>((whole + 127) << 23) * (1.0f + part * (0.6565f + 0.3435f * part));
}

template <class Floats>
Floats log2_approx(Floats x) {
    using Ints = IntsOf<Floats>;
    const Ints bits = reinterpret_cast<Ints>(x);
    const Floats part = reinterpret_cast<Floats>((bits & 0x7fffff) | 0x3f800000) - 1.0f;
    return __builtin_convertvector((bits >> 23) - 127, Floats) + part * (1.343f - 0.343f * part);
}

// log2(a / b) for normal a, b > 0, within 0.09: bit patterns are nearly logarithms.
template <class Floats>
Floats log2_ratio(Floats a, Floats b) {
    using Ints = IntsOf<Floats>;
    const Ints difference = reinterpret_cast<Ints>(a) - reinterpret_cast<Ints>(b);
    return __builtin_convertvector(difference, Floats) * 0x1p-23f;
}

template <class Floats>
Floats squash(Floats x) {
    return 1.0f / (1.0f + exp2_approx(-x));
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
