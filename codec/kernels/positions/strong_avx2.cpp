// code_strong for AVX2; what comes before avx2.hpp stays within the baseline.
#include "../instructions.hpp"

#ifdef EBZ_HAS_AVX2

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "../entropy/range_coder.hpp"
#include "axes.hpp"
#include "axis_order.hpp"
#include "expectation.hpp"
#include "initial_weights.hpp"
#include "prediction.hpp"
#include "strong.hpp"
#include "surroundings.hpp"
#include "traversal.hpp"
#include "twins.hpp"
#include "wrapping.hpp"

#include "../avx2.hpp"
#include "strong_coder.hpp"

#endif
