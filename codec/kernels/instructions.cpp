#include "instructions.hpp"

#include <atomic>

namespace ebz {

namespace {

std::atomic<bool> extensions_forbidden = false;

bool has_avx2() {
#ifdef EBZ_HAS_AVX2
    return __builtin_cpu_supports("avx2") != 0;
#else
    return false;
#endif
}

}  // namespace

bool use_avx2() {
    static const bool available = has_avx2();
    return available && !extensions_forbidden.load(std::memory_order_relaxed);
}

void forbid_extensions(bool forbidden) { extensions_forbidden.store(forbidden, std::memory_order_relaxed); }

}  // namespace ebz
