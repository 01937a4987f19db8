// Values that a coordinate may have exactly, each with a decision of its own where that pays.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "../instruction_set.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// Signed: of residuals.
template <class Signed>
class LightValues {
public:
    enum Kind : size_t { twin, neighbour, tip, along, around, mirrored, n_kinds };

    LightValues() { hits_.fill(first_hits); }

    void clear() { n_ = 0; }

    // agreement, strength: 0 to 3, of what stands for the value.  Values that are there already are left out.
    void add(Kind kind, size_t turn, size_t agreement, Signed residual, size_t strength = 0) {
        for (size_t i = 0; i < n_; ++i)
            if (residuals_[i] == residual) return;
        residuals_[n_] = residual;
        contexts_[n_++] = static_cast<uint16_t>(((kind * 3 + turn) * 4 + agreement) * 4 + strength);
    }

    // True if e, then one of the values, has been coded.  octaves: half-octaves of the magnitude expected, 6 for 1;
    // a value that hits hardly more often than any other of that magnitude is left to others.
    template <class Coder>
    bool code(Coder& coder, size_t lane, int octaves, Signed& e) {
        const int least = std::max(least_hits, 32768 >> std::clamp((octaves - 6) / 2, 0, 15));
        for (size_t i = 0; i < n_; ++i) {
            const uint16_t p = hits_[contexts_[i]];
            if (p < least || !coder.bit(lane, e == residuals_[i], p)) continue;
            e = residuals_[i];
            return true;
        }
        return false;
    }

    void learn(Signed e) {
        for (size_t i = 0; i < n_; ++i) {
            uint16_t& p = hits_[contexts_[i]];
            p = static_cast<uint16_t>(p + (((e == residuals_[i] ? 32768 - 15 : 15) - p) >> 4));
        }
    }

private:
    static constexpr size_t n_contexts = n_kinds * 3 * 4 * 4;
    static constexpr uint16_t first_hits = 8192;  // of 2^15
    static constexpr int least_hits = 600;

    std::array<uint16_t, n_contexts> hits_;
    std::array<Signed, n_kinds> residuals_{};
    std::array<uint16_t, n_kinds> contexts_{};
    size_t n_ = 0;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
