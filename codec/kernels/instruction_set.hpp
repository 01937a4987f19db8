// Kernels compiled for several instruction sets from one source, with the same results.
//
// Such code is in headers that include this one, in the inline namespace EBZ_INSTRUCTIONS.  A source for
// another set than the baseline first includes what these headers share with other sources, then the
// header that selects the set (avx2.hpp), then them: shared inline functions must stay within the
// baseline, since a linker may take them from any source.
#pragma once

#ifndef EBZ_INSTRUCTIONS
#define EBZ_INSTRUCTIONS baseline
#endif
