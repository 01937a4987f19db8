#include "instructions.hpp"

#include <atomic>

namespace ebz {

namespace {

std::atomic<bool> extensions_forbidden = false;

bool has_avx2() {
#ifdef EBZ_HAS_AVX2
    // All machines with AVX2 have the other two, but some emulators.
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
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
