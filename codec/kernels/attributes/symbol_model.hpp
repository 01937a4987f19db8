// A label as its bits, highest first, each in contexts of values and of the bits before.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "decision.hpp"

namespace ebz::attributes {

struct Likely {
    Hashes context{};
    std::array<int64_t, n_candidates> value{};
    unsigned candidates = 0;
    std::array<uint8_t, n_candidates> value_context{};
    size_t turn = 0;
};

class SymbolModel {
public:
    static constexpr int max_bits = 16;

    SymbolModel(size_t n_values, int n_bits) : decision_(n_values, initial_weights_of_symbol), n_bits_(n_bits) {}

    template <class Coder>
    int64_t code(Coder& coder, const Likely& x, int64_t value) {
        decision_.consider(x.candidates, x.value_context);
        uint32_t known = 1;  // the bits so far below a leading one
        for (int left = n_bits_, slot = 0; left-- > 0;) {
            if ((n_bits_ - 1 - left) % nibble == 0) {
                enter(x, known);
                slot = 0;
            }
            unsigned upper = 0;
            for (unsigned rest = decision_.alive(); rest != 0; rest &= rest - 1) {
                const auto i = static_cast<size_t>(std::countr_zero(rest));
                upper |= static_cast<unsigned>(x.value[i] >> left & 1) << i;
            }
            const auto n_alive = static_cast<size_t>(std::popcount(decision_.alive()));
            const auto node = static_cast<size_t>(n_bits_ - 1 - left);
            const bool bit = decision_.code(coder, node, static_cast<size_t>(slot), x.turn,
                                            std::min(n_alive, Decision::n_levels - 1), upper, (value >> left & 1) != 0);
            decision_.keep(bit ? upper : ~upper);
            known = 2 * known + bit;
            slot = 2 * slot + 1 + bit;
        }
        const int64_t decoded = known & ((1u << n_bits_) - 1);
        unsigned right = 0;
        for (size_t i = 0; i < n_candidates; ++i) right |= (x.value[i] == decoded ? 1u : 0u) << i;
        decision_.settle(right);
        return decoded;
    }

private:
    static constexpr int nibble = 4;  // 15 counters to a line

    void enter(const Likely& x, uint32_t known) {
        Hashes hashes;
        for (size_t i = 0; i < n_contexts; ++i) hashes[i] = hash(x.context[i], known);
        decision_.enter(hashes);
    }

    Decision decision_;
    int n_bits_;
};

}  // namespace ebz::attributes
