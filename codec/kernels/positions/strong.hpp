// The strong method, in the versions for several instruction sets that strong_coder.hpp is compiled to.
#pragma once

#include <cstdint>
#include <span>

#include "../instructions.hpp"
#include "axis_order.hpp"
#include "surface.hpp"

namespace ebz::positions {

inline namespace baseline {
template <class Coder>
void code_strong(Coder& coder, const Surface& mesh, AxisOrder order, std::span<int64_t> xyz);
}
inline namespace avx2 {
template <class Coder>
void code_strong(Coder& coder, const Surface& mesh, AxisOrder order, std::span<int64_t> xyz);
}

template <class Coder>
void code_positions_strong(Coder& coder, const Surface& mesh, AxisOrder order, std::span<int64_t> xyz) {
#ifdef EBZ_HAS_AVX2
    if (use_avx2()) return avx2::code_strong(coder, mesh, order, xyz);
#endif
    baseline::code_strong(coder, mesh, order, xyz);
}

}  // namespace ebz::positions
