// Fast attributes for AVX2; what comes before avx2.hpp stays within the baseline.
#include "../instructions.hpp"

#ifdef EBZ_HAS_AVX2

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "../positions/surface.hpp"
#include "../positions/wrapping.hpp"
#include "attributes.hpp"
#include "fast.hpp"

#include "../avx2.hpp"
#include "fast_coder.hpp"

#endif
