// Codes vertices in the order of the faces, each from the face behind its gate.
//
// Prediction is one parallelogram, or the mean of two where the next face on the right is known too.
// The size of a residual is a symbol in the context of the sizes at the gate; its digits are raw.
// Each axis has its own coder (ans.hpp): the three run side by side.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "../adaptive_symbol.hpp"
#include "../ans.hpp"
#include "residual_digits.hpp"
#include "surface.hpp"
#include "wrapping.hpp"

namespace ebz::positions {

class FastModel {
public:
    static constexpr size_t n_kinds = 4;

    // expected: the half-octave that the magnitude of e is expected in.
    template <class Coder>
    int64_t code(Coder& coder, size_t axis, size_t kind, uint32_t expected, int64_t e) {
        const int shift = expected > centre ? std::min(static_cast<int>(expected - centre) / 2, max_shift) : 0;
        AdaptiveSymbol<16>& row = rows_[axis][kind][std::min<size_t>(expected, n_expected - 1)];
        const uint64_t a = magnitude(e);
        const uint32_t token = coder.symbol(axis, row, residual_token(a, shift));
        if (token == 0 && shift == 0) return 0;
        if (token == escape_token) return code_large(coder, axis, e);
        // The sign is the lowest digit.
        const uint64_t decoded = code_low_digits(coder, axis, token, shift, a, e < 0);
        return with_sign(decoded >> 1, decoded & 1);
    }

private:
    static constexpr uint32_t centre = 8;
    static constexpr size_t n_expected = 32;

    std::array<std::array<std::array<AdaptiveSymbol<16>, n_expected>, n_kinds>, 3> rows_;
};

template <class Coder>
class FastCoder {
public:
    FastCoder(Coder& coder, const Surface& mesh, std::span<int64_t> xyz)
        : coder_(coder), mesh_(mesh), xyz_(xyz.data()), n_vertices_(mesh.n_vertices), sizes_(xyz.size() / 3 + 1) {}

    void run() {
        const auto n_faces = static_cast<int32_t>(mesh_.vertex.size() / 3);
        for (int32_t t = 0; t < n_faces; ++t) {
            const int32_t gate = 3 * t;
            if (vertex(gate + 2) >= known_ && tip(gate)) continue;
            for (int32_t c = gate; c < gate + 3; ++c)
                if (vertex(c) >= known_) from_latest(c == gate ? 2 : 3);
        }
        while (known_ < n_vertices_) from_latest(2);
    }

private:
    using Sizes = std::array<uint8_t, 4>;

    int32_t vertex(int32_t c) const { return mesh_.vertex[static_cast<size_t>(c)]; }
    int32_t opposite(int32_t c) const { return mesh_.opposite[static_cast<size_t>(c)]; }
    const int64_t* position(int32_t v) const { return xyz_ + 3 * static_cast<size_t>(v); }

    // False if the face behind the gate is not known: the first of a component has none.
    bool tip(int32_t gate) {
        if (opposite(gate) < 0) return false;
        const int32_t a = vertex(gate), b = vertex(gate + 1), o = vertex(previous(opposite(gate)));
        if (a >= known_ || b >= known_ || o >= known_) return false;
        std::array<uint64_t, 3> base;
        for (size_t d = 0; d < 3; ++d) base[d] = sum(a, b, o, d);
        size_t kind = 0;
        const int32_t y = second(gate + 1), x = y < 0 ? -1 : x_;
        if (y >= 0) {
            kind = 1;
            for (size_t d = 0; d < 3; ++d) {
                const uint64_t other = sum(b, x, y, d) - base[d];
                base[d] += static_cast<uint64_t>(static_cast<int64_t>(other) >> 1);
            }
        }
        code(kind, base, sizes_[static_cast<size_t>(a)], sizes_[static_cast<size_t>(b)]);
        return true;
    }

    // The apex of the second parallelogram, across from the tip: behind the face on the right (which has the
    // tip, the end of the gate and x_).
    int32_t second(int32_t right) {
        const int32_t across = opposite(right);
        if (across < 0) return -1;
        x_ = vertex(previous(across));
        if (x_ >= known_) return -1;
        const int32_t beyond = opposite(next(across));
        if (beyond < 0) return -1;
        const int32_t y = vertex(previous(beyond));
        return y < known_ ? y : -1;
    }

    uint64_t sum(int32_t a, int32_t b, int32_t o, size_t d) const {
        return static_cast<uint64_t>(position(a)[d]) + static_cast<uint64_t>(position(b)[d]) - static_cast<uint64_t>(position(o)[d]);
    }

    // Without a parallelogram: from the vertex coded before, which is a neighbour for kind 3.
    void from_latest(size_t kind) {
        std::array<uint64_t, 3> base{};
        for (size_t d = 0; known_ > 0 && d < 3; ++d) base[d] = static_cast<uint64_t>(position(known_ - 1)[d]);
        Sizes& steps = steps_[kind - 2];
        code(kind, base, steps, steps);
        steps = sizes_[static_cast<size_t>(known_ - 1)];
        sizes_[static_cast<size_t>(known_ - 1)] = {};
    }

    void code(size_t kind, const std::array<uint64_t, 3>& base, const Sizes& sa, const Sizes& sb) {
        int64_t* at = xyz_ + 3 * static_cast<size_t>(known_);
        Sizes& sizes = sizes_[static_cast<size_t>(known_)];
        for (size_t d = 0; d < 3; ++d) {
            const uint32_t expected = (uint32_t{sa[d]} + sb[d] + 1) / 2;
            const int64_t e = model_.code(coder_, d, kind, expected, static_cast<int64_t>(static_cast<uint64_t>(at[d]) - base[d]));
            at[d] = static_cast<int64_t>(base[d] + static_cast<uint64_t>(e));
            sizes[d] = static_cast<uint8_t>(half_octave(magnitude(e)));
        }
        ++known_;
    }

    Coder& coder_;
    const Surface& mesh_;
    int64_t* xyz_;
    int32_t n_vertices_, known_ = 0, x_ = -1;
    std::vector<Sizes> sizes_;
    std::array<Sizes, 2> steps_{};
    FastModel model_;
};

template <class Coder>
void code_positions_fast(Coder& coder, const Surface& mesh, std::span<int64_t> xyz) {
    const auto fast = std::make_unique<FastCoder<Coder>>(coder, mesh, xyz);
    fast->run();
}

}  // namespace ebz::positions
