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
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "fast.hpp"
#include "fast_model.hpp"
#include "lanes.hpp"
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
          sizes_(std::make_unique_for_overwrite<Sizes[]>(vertices.size())), n_vertices_(mesh.n_vertices) {}

    // In blocks, in steps that do not wait for each other: faces are sifted for those that have a new vertex,
    // what predicts these is looked up, and they are coded.
    void run() {
        constexpr int32_t block = 256;
        std::array<Fresh, block> fresh;
        std::array<Parents, block> parents;
        for (int32_t t = 0, n = 0; t < n_faces_;) {
            const int32_t end = std::min(t + block, n_faces_);
            size_t n_fresh = 0;
            for (; t < end; ++t) {
                const int32_t largest = std::max({vertex_[3 * t], vertex_[3 * t + 1], vertex_[3 * t + 2]});
                fresh[n_fresh] = {3 * t, n};
                n_fresh += largest >= n;
                n = std::max(n, largest + 1);
            }
            for (size_t i = 0; i < n_fresh; ++i) parents[i] = parents_of(fresh[i]);
            for (size_t i = 0; i < n_fresh; ++i) {
                if (parents[i].kind < without_parallelogram) predict(parents[i]);
                else face(parents[i].gate);
            }
        }
        while (known_ < n_vertices_) from_latest(without_parallelogram);
    }

private:
    static constexpr uint32_t without_parallelogram = 2;  // of kinds: 0 with one, 1 with two, 3 beside a neighbour

    // A face of which some vertex is new, and how many vertices are known before.
    struct Fresh {
        int32_t gate, known;
    };

    // The vertices of the parallelogram a, b, o and, where kind is 1, of that of b, x, y; else these are others.
    struct Parents {
        int32_t a, b, o, x, y;
        uint32_t kind;
        int32_t gate;
    };

    // Without branches, which would be hard to foresee.  The first face of a component has none behind its gate.
    Parents parents_of(Fresh face) const {
        const int32_t gate = face.gate, known = face.known, behind = opposite_[gate], across = opposite_[gate + 1];
        const int32_t a = vertex_[gate], b = vertex_[gate + 1], o = vertex_[previous(either(behind < 0, gate, behind))];
        const bool one = (behind >= 0) & (vertex_[gate + 2] >= known) & (std::max({a, b, o}) < known);
        // The apex y of the second parallelogram is behind the face on the right, which has x, the tip and b.
        const int32_t right = either(across < 0, gate, across), beyond = opposite_[next(right)];
        const int32_t x = vertex_[previous(right)], y = vertex_[previous(either(beyond < 0, gate, beyond))];
        const bool two = (across >= 0) & (beyond >= 0) & (std::max(x, y) < known);
        return {a, b, o, either(two, x, a), either(two, y, o), one ? static_cast<uint32_t>(two) : without_parallelogram, gate};
    }

    static int32_t either(bool first, int32_t a, int32_t b) { return b ^ ((a ^ b) & -static_cast<int32_t>(first)); }

    void predict(const Parents& of) {
        const FastVertex &a = vertices_[of.a], &b = vertices_[of.b];
        const UintLanes pb = lanes(b), first = lanes(a) + pb - lanes(vertices_[of.o]);
        const UintLanes other = pb + lanes(vertices_[of.x]) - lanes(vertices_[of.y]);
        const UintLanes base = first + reinterpret_cast<UintLanes>(reinterpret_cast<IntLanes>(other - first) >> 1);
        code(of.kind, base, mean(sizes_[of.a], sizes_[of.b]));
    }

    void face(int32_t gate) {
        for (int32_t c = gate; c < gate + 3; ++c)
            if (vertex_[c] >= known_) from_latest(without_parallelogram + (c != gate));
    }

    // Without a parallelogram: from the vertex coded before, which is a neighbour for kind 3.
    void from_latest(size_t kind) {
        Sizes& steps = steps_[kind - without_parallelogram];
        code(kind, known_ > 0 ? lanes(vertices_[known_ - 1]) : UintLanes{}, steps);
        steps = sizes_[known_ - 1];
        sizes_[known_ - 1] = 0;
    }

    // All lanes are written at once: what is read next is forwarded whole.
    void code(size_t kind, UintLanes base, Sizes expected) {
        FastVertex& at = vertices_[known_];
        FastModel::Residuals e{};
        if constexpr (Coder::encoding) e = reinterpret_cast<IntLanes>(lanes(at) - base);
        sizes_[known_++] = model_.code(coder_, kind, expected, e);
        UintLanes position = base + reinterpret_cast<UintLanes>(e);
        std::memcpy(&at, &position, sizeof at);
    }

    // The position; the last lane is of no account.
    static UintLanes lanes(const FastVertex& vertex) { return std::bit_cast<UintLanes>(vertex); }

    Coder& coder_;
    const int32_t *opposite_, *vertex_;
    int32_t n_faces_;
    FastVertex* vertices_;
    std::unique_ptr<Sizes[]> sizes_;  // of the residuals of each vertex: apart, as the next one waits for them
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
    TwoPartEncoder coder(values.size() + values.size() / 8);
    code_positions_fast(coder, mesh, {vertices.get(), n});
    return coder.finish();
}

void decode_fast(std::span<const uint8_t> bytes, const Surface& mesh, std::span<FastVertex> vertices) {
    TwoPartDecoder coder(bytes);
    code_positions_fast(coder, mesh, vertices);
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
