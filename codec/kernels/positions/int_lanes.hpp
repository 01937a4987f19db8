// Integers of x, y, z and a lane that does not matter, modulo 2^32 or 2^64, and as floats.
#pragma once

#include <cstdint>

#include "lanes.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <class Unsigned>
struct Integers {
    typedef Unsigned Lanes __attribute__((vector_size(4 * sizeof(Unsigned))));
};
using UintLanes = Integers<uint32_t>::Lanes;
using WideUintLanes = Integers<uint64_t>::Lanes;

inline IntLanes as_ints(UintLanes x) { return reinterpret_cast<IntLanes>(x); }
inline UintLanes as_uints(IntLanes x) { return reinterpret_cast<UintLanes>(x); }
inline IntLanes bits_of(Lanes x) { return reinterpret_cast<IntLanes>(x); }
inline Lanes magnitudes(Lanes x) { return reinterpret_cast<Lanes>(bits_of(x) & INT32_MAX); }
inline Lanes clamp(Lanes x, float low, float high) { return min(max(x, splat<Lanes>(low)), splat<Lanes>(high)); }
inline IntLanes truncated(Lanes x) { return __builtin_convertvector(x, IntLanes); }

inline IntLanes choose(IntLanes mask, IntLanes x, IntLanes y) { return (x & mask) | (y & ~mask); }
inline Lanes choose(IntLanes mask, Lanes x, Lanes y) { return reinterpret_cast<Lanes>(choose(mask, bits_of(x), bits_of(y))); }
inline UintLanes choose(IntLanes mask, UintLanes x, UintLanes y) { return as_uints(choose(mask, as_ints(x), as_ints(y))); }
inline WideUintLanes choose(IntLanes mask, WideUintLanes x, WideUintLanes y) {
    const auto wide = reinterpret_cast<WideUintLanes>(__builtin_convertvector(mask, int64_t __attribute__((vector_size(32)))));
    return (x & wide) | (y & ~wide);
}

// Signed integers as floats; those of 64 bits within 2^42, which valid differences are.
inline Lanes as_floats(UintLanes x) { return __builtin_convertvector(as_ints(x), Lanes); }
inline Lanes as_floats(WideUintLanes x) {
    return clamp(__builtin_convertvector(reinterpret_cast<int64_t __attribute__((vector_size(32)))>(x), Lanes), -0x1p42f, 0x1p42f);
}

// The nearest integers, of magnitudes below 2^30.
inline IntLanes rounded(Lanes x) {
    const IntLanes half = bits_of(splat<Lanes>(0.5f)) | (bits_of(x) & INT32_MIN);
    return truncated(x + reinterpret_cast<Lanes>(half));
}

// Which are nearly logarithms.
inline Lanes bit_patterns(Lanes x) { return __builtin_convertvector(bits_of(x), Lanes); }

// Half-octaves of x + 1/8, x >= 0: 1 gives 6.
inline IntLanes half_octaves(Lanes x) { return (bits_of(x + 0.125f) >> 22) - 248; }

inline Lanes rotated(Lanes x) { return __builtin_shufflevector(x, x, 1, 2, 0, 3); }
inline Lanes cross(Lanes u, Lanes w) { return rotated(u * rotated(w) - rotated(u) * w); }
inline float dot(Lanes u, Lanes w) {
    const Lanes x = u * w;
    return (x[0] + x[1]) + x[2];
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
