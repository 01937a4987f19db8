// The light method for AVX2; what comes before avx2.hpp stays within the baseline.
#include "../instructions.hpp"

#ifdef EBZ_HAS_AVX2

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "axis_order.hpp"
#include "gate_order.hpp"
#include "least_squares.hpp"
#include "light.hpp"
#include "recall.hpp"
#include "site.hpp"
#include "surface.hpp"
#include "twins.hpp"
#include "wrapping.hpp"

#include "../avx2.hpp"
#include "light_coder.hpp"

#endif
