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

#include "../adaptive_symbol.hpp"
#include "fast.hpp"
#include "residual_digits.hpp"
#include "surface.hpp"
#include "two_part_stream.hpp"

namespace ebz::positions {
inline namespace EBZ_INSTRUCTIONS {

// A number below 2^8 for each axis, the first lowest.
using Sizes = uint32_t;

inline uint32_t size_of(Sizes sizes, size_t d) { return sizes >> (8 * d) & 0xff; }

// Of each axis, halves upwards.
inline Sizes mean(Sizes a, Sizes b) { return (a | b) - ((a ^ b) >> 1 & 0x7f7f7f); }

// What a token tells of a residual: the magnitude is at least `least`, the sign and more are in n_bits digits.
struct Meaning {
    uint32_t least;
    uint8_t n_bits;
    uint8_t size;  // about the half-octave: the next vertex does not wait for the digits
    bool is_escape;

    constexpr Meaning() : least(0), n_bits(0), size(0), is_escape(false) {}
    constexpr Meaning(uint32_t token, int shift) {
        const int n = n_low_digits(token, shift);
        const auto h = static_cast<uint32_t>(shift);
        least = static_cast<uint32_t>(leading_digits(token) << n);
        n_bits = static_cast<uint8_t>(n + (token + h != 0));
        size = static_cast<uint8_t>(token == 0 ? h : token + 2 * h);
        is_escape = token == escape_token;
    }

    // The sign is the lowest digit.
    uint64_t digits(int32_t e) const { return (static_cast<uint64_t>(magnitude(e)) << 1 | (e < 0)) & ((uint64_t{1} << n_bits) - 1); }
    int32_t residual(uint64_t digits) const { return static_cast<int32_t>(with_sign(least + (digits >> 1), digits & 1)); }
};

inline constexpr uint32_t n_expected = 32;  // the digits of all axes are 54 at most

constexpr int shift_of(uint32_t expected) { return expected < 8 ? 0 : static_cast<int>(expected - 8) / 2; }

inline constexpr auto meanings = [] {
    std::array<std::array<Meaning, 16>, n_expected> table;
    for (uint32_t x = 0; x < n_expected; ++x)
        for (uint32_t token = 0; token < 16; ++token) table[x][token] = Meaning(token, shift_of(x));
    return table;
}();

// A coordinate's residual is told by its size; those far from what was expected by one told before, or in full.
class FastModel {
public:
    static constexpr size_t n_kinds = 4;
    using Row = AdaptiveSymbol<16>;
    using Residuals = std::array<int32_t, 3>;

    // expected: the half-octaves that the magnitudes are expected in.  Returns those that they are found in.
    template <class Coder>
    Sizes code(Coder& coder, size_t kind, Sizes expected, Residuals& e) {
        if ((expected & 0xe0e0e0) != 0) return code_wide(coder, kind, expected, e);
        std::array<const Meaning*, 3> found;
        uint32_t escapes = 0;
        for (size_t d = 0; d < 3; ++d) {
            const uint32_t x = size_of(expected, d);
            const uint32_t token = code_token(coder, d, rows_[d][kind][x], e[d], shift_of(x));
            found[d] = &meanings[x][token];
            escapes |= token + 1;
        }
        if (escapes > escape_token) return code_surprises(coder, found, e);
        Sizes sizes = 0;
        coder.plain.together([&](auto bits) {
            for (size_t d = 0; d < 3; ++d) {
                const Meaning& m = *found[d];
                e[d] = m.residual(bits(Coder::encoding ? m.digits(e[d]) : 0, m.n_bits));
                sizes |= Sizes{m.size} << (8 * d);
            }
        });
        return sizes;
    }

private:
    static constexpr size_t n_recent = 15;

    template <class Coder>
    static uint32_t code_token(Coder& coder, size_t d, Row& row, int32_t e, int shift) {
        return coder.symbols.symbol(d, row, Coder::encoding ? residual_token(magnitude(e), shift) : 0);
    }

    // Whatever is expected.
    template <class Coder>
    [[gnu::noinline]] Sizes code_wide(Coder& coder, size_t kind, Sizes expected, Residuals& e) {
        std::array<Meaning, 3> wide;
        for (size_t d = 0; d < 3; ++d) {
            const uint32_t x = size_of(expected, d);
            wide[d] = Meaning(code_token(coder, d, rows_[d][kind][std::min(x, n_expected - 1)], e[d], shift_of(x)), shift_of(x));
        }
        return code_surprises(coder, {&wide[0], &wide[1], &wide[2]}, e);
    }

    template <class Coder>
    [[gnu::noinline]] Sizes code_surprises(Coder& coder, const std::array<const Meaning*, 3>& found, Residuals& e) {
        Sizes sizes = 0;
        for (size_t d = 0; d < 3; ++d) {
            const Meaning& m = *found[d];
            if (m.is_escape) {
                e[d] = code_surprise(coder, d, e[d]);
                sizes |= half_octave(magnitude(e[d])) << (8 * d);
            } else {
                e[d] = m.residual(coder.plain.bits(m.digits(e[d]), m.n_bits));
                sizes |= Sizes{m.size} << (8 * d);
            }
        }
        return sizes;
    }

    // 0: a new one; else its place among the recent ones, from 1.
    template <class Coder>
    int32_t code_surprise(Coder& coder, size_t d, int32_t e) {
        std::array<int32_t, n_recent>& recent = recent_[d];
        uint32_t place = 0;
        if constexpr (Coder::encoding) {
            const auto at = std::find(recent.begin(), recent.end(), e);
            place = at == recent.end() ? 0 : static_cast<uint32_t>(at - recent.begin()) + 1;
        }
        place = coder.symbols.symbol(d, places_[d], place);
        if (place > 0) return recent[place - 1];
        const uint32_t zigzag = static_cast<uint32_t>(e) << 1 ^ static_cast<uint32_t>(e >> 31);
        const auto n_digits = static_cast<int>(coder.plain.bits(static_cast<uint64_t>(std::bit_width(zigzag)), 6));
        const auto digits = static_cast<uint32_t>(coder.plain.bits(zigzag, std::min(n_digits, 32)));
        e = static_cast<int32_t>(digits >> 1 ^ (0 - (digits & 1)));
        recent[oldest_[d]] = e;
        oldest_[d] = static_cast<uint8_t>((oldest_[d] + 1u) % n_recent);
        return e;
    }

    std::array<std::array<std::array<Row, n_expected>, n_kinds>, 3> rows_;
    std::array<Row, 3> places_;
    std::array<std::array<int32_t, n_recent>, 3> recent_{};
    std::array<uint8_t, 3> oldest_{};
};

// A vertex and the half-octaves of its residual.
struct FastVertex {
    std::array<uint32_t, 3> position;
    Sizes sizes;
};

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
    std::vector<FastVertex> vertices(values.size() / 3);
    bool fits = true;
    for (size_t i = 0; i < values.size(); ++i) {
        const auto value = static_cast<int32_t>(values[i]);
        fits &= value == values[i];
        vertices[i / 3].position[i % 3] = static_cast<uint32_t>(value);
    }
    if (!fits) return {};
    TwoPartEncoder coder;
    code_positions_fast(coder, mesh, vertices);
    return coder.finish();
}

void decode_fast(std::span<const uint8_t> bytes, const Surface& mesh, std::span<int64_t> values) {
    std::vector<FastVertex> vertices(values.size() / 3);
    TwoPartDecoder coder(bytes);
    code_positions_fast(coder, mesh, vertices);
    for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<int32_t>(vertices[i / 3].position[i % 3]);
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::positions
