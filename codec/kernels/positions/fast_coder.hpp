// Codes vertices in the order of the faces, each from the face behind its gate, in integers of 32 bits.
//
// Prediction is one parallelogram, or the mean of two where the next face on the right is known too.
// The size of a residual is a symbol in the context of the sizes at the gate; its digits are plain bits.
// Each axis has its own lane of ANS: the three run side by side.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fast.hpp"
#include "fast_model.hpp"
#include "residual_digits.hpp"
#include "surface.hpp"
#include "two_part_stream.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

template <class Coder>
class FastCoder {
public:
    // vertices: as many as the surface has.
    FastCoder(Coder& coder, const Surface& mesh, std::span<FastVertex> vertices)
        : coder_(coder), opposite_(mesh.opposite.data()), vertex_(mesh.vertex.data()),
          n_faces_(static_cast<int32_t>(mesh.vertex.size() / 3)), vertices_(vertices.data()),
          n_vertices_(mesh.n_vertices) {}

    // Faces are sifted in blocks for those that have a new vertex, without a branch that is hard to foresee.
    void run() {
        constexpr int32_t block = 256;
        std::array<int32_t, block> fresh;
        for (int32_t t = 0, n = 0; t < n_faces_;) {
            const int32_t end = std::min(t + block, n_faces_);
            size_t n_fresh = 0;
            for (; t < end; ++t) {
                const int32_t largest = std::max({vertex_[3 * t], vertex_[3 * t + 1], vertex_[3 * t + 2]});
                fresh[n_fresh] = t;
                n_fresh += largest >= n;
                n = std::max(n, largest + 1);
            }
            for (size_t i = 0; i < n_fresh; ++i) face(3 * fresh[i]);
        }
        while (known_ < n_vertices_) from_latest(2);
    }

private:
    void face(int32_t gate) {
        if (vertex_[gate + 2] >= known_ && tip(gate)) return;
        for (int32_t c = gate; c < gate + 3; ++c)
            if (vertex_[c] >= known_) from_latest(c == gate ? 2 : 3);
    }

    // False if the face behind the gate is not known: the first of a component has none.
    bool tip(int32_t gate) {
        if (opposite_[gate] < 0) return false;
        const int32_t a = vertex_[gate], b = vertex_[gate + 1], o = vertex_[previous(opposite_[gate])];
        if (a >= known_ || b >= known_ || o >= known_) return false;
        // The apex y of the second parallelogram is behind the face on the right, which has x, the tip and b.
        const int32_t across = opposite_[gate + 1], right = across < 0 ? gate : across;
        const int32_t x = vertex_[previous(right)], beyond = opposite_[next(right)];
        const int32_t y = vertex_[previous(beyond < 0 ? gate : beyond)];
        const bool second = (across >= 0) & (beyond >= 0) & (x < known_) & (y < known_);
        const FastVertex &va = vertices_[a], &vb = vertices_[b], &vo = vertices_[o];
        const FastVertex &vx = vertices_[second ? x : a], &vy = vertices_[second ? y : o];
        std::array<uint32_t, 3> base;
        for (size_t d = 0; d < 3; ++d) {
            const uint32_t first = va.position[d] + vb.position[d] - vo.position[d];
            const uint32_t other = vb.position[d] + vx.position[d] - vy.position[d];
            base[d] = first + static_cast<uint32_t>(static_cast<int32_t>(other - first) >> 1);
        }
        code(second, base, mean(va.sizes, vb.sizes));
        return true;
    }

    // Without a parallelogram: from the vertex coded before, which is a neighbour for kind 3.
    void from_latest(size_t kind) {
        Sizes& steps = steps_[kind - 2];
        code(kind, known_ > 0 ? vertices_[known_ - 1].position : std::array<uint32_t, 3>{}, steps);
        steps = vertices_[known_ - 1].sizes;
        vertices_[known_ - 1].sizes = 0;
    }

    void code(size_t kind, const std::array<uint32_t, 3>& base, Sizes expected) {
        FastVertex& at = vertices_[known_];
        FastModel::Residuals e{};
        if constexpr (Coder::encoding) {
            for (size_t d = 0; d < 3; ++d) e[d] = static_cast<int32_t>(at.position[d] - base[d]);
        }
        at.sizes = model_.code(coder_, kind, expected, e);
        for (size_t d = 0; d < 3; ++d) at.position[d] = base[d] + static_cast<uint32_t>(e[d]);
        ++known_;
    }

    Coder& coder_;
    const int32_t *opposite_, *vertex_;
    int32_t n_faces_;
    FastVertex* vertices_;
    int32_t n_vertices_, known_ = 0;
    std::array<Sizes, 2> steps_{};
    FastModel model_;
};

template <class Coder>
void code_positions_fast(Coder& coder, const Surface& mesh, std::span<FastVertex> vertices) {
    std::make_unique<FastCoder<Coder>>(coder, mesh, vertices)->run();
}

std::vector<uint8_t> encode_fast(const Surface& mesh, std::span<const int64_t> values) {
    const size_t n = values.size() / 3;
    const auto vertices = std::make_unique_for_overwrite<FastVertex[]>(n);
    bool fits = true;
    for (size_t i = 0; i < values.size(); ++i) {
        const auto value = static_cast<int32_t>(values[i]);
        fits &= value == values[i];
        vertices[i / 3].position[i % 3] = static_cast<uint32_t>(value);
    }
    if (!fits) return {};
    TwoPartEncoder coder;
    code_positions_fast(coder, mesh, {vertices.get(), n});
    return coder.finish();
}

void decode_fast(std::span<const uint8_t> bytes, const Surface& mesh, std::span<FastVertex> vertices) {
    TwoPartDecoder coder(bytes);
    code_positions_fast(coder, mesh, vertices);
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
