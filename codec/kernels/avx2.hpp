// What follows in this source is compiled for AVX2: see instruction_set.hpp.
#pragma once

#ifdef EBZ_INSTRUCTIONS
#error "a header that is compiled for several instruction sets was included before"
#endif

#include <immintrin.h>

#define EBZ_INSTRUCTIONS avx2
#define EBZ_AVX2
#pragma GCC target("avx2,bmi,bmi2")
