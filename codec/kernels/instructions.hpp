// Which of the instruction sets that some kernels are compiled for (instruction_set.hpp) is taken.
#pragma once

// Clang lacks the pragma of avx2.hpp.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define EBZ_HAS_AVX2
#endif

namespace ebz {

// Whether this machine has AVX2 and it is not forbidden.
bool use_avx2();

// For tests: from now on the baseline is taken on every machine, or no more.
void forbid_extensions(bool forbidden);

}  // namespace ebz
