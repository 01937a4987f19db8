// The fast method for AVX2; what comes before avx2.hpp stays within the baseline.
#include "../instructions.hpp"

#ifdef EBZ_HAS_AVX2

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "fast.hpp"
#include "surface.hpp"
#include "wrapping.hpp"

#include "../avx2.hpp"
#include "fast_coder.hpp"

#endif
