// Attributes in the order of the faces, in integers of 32 bits: the models of positions/fast_model.hpp.
//
// One way of expecting values is taken for all of an attribute; the encoder tries each.  Floats of 32 bits
// are expected as such, and differ by the floats in between.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "../positions/fast_model.hpp"
#include "../positions/surface.hpp"
#include "../positions/two_part_stream.hpp"
#include "attributes.hpp"
#include "face_edges.hpp"
#include "fast.hpp"

namespace ebz::attributes {
inline namespace EBZ_INSTRUCTIONS {

enum class Expected : uint8_t { parallelogram, mean, nearest, guess };

// What the first byte of a stream says: how values are expected, and whether components after the first
// are off as much as that one (colours: it is the light that changes).
struct FastWay {
    Expected expected = Expected::parallelogram;
    bool coupled = false;

    static FastWay of(uint8_t byte) { return {static_cast<Expected>(byte & 3), (byte & 4) != 0}; }
    uint8_t byte() const { return static_cast<uint8_t>(static_cast<uint8_t>(expected) | (coupled ? 4 : 0)); }
};

// The known items that the next one is expected from; all are the latest where no other is near.
struct Near {
    int32_t a, b, across;
    size_t kind;
};

inline constexpr size_t near_both = 0, near_latest = 1, near_nothing = 2;

inline Near latest_of(int32_t known, size_t kind) { return {known - 1, known - 1, known - 1, kind}; }

// Of each item in ascending order: vertices and wedges where a face first has them.
template <class Code>
void along_surface(const Items& items, Code code) {
    int32_t known = 0;
    const int32_t *item = items.item.data(), *opposite = items.opposite.data();
    const auto n_corners = static_cast<int32_t>(items.item.size());
    for (int32_t gate = 0; gate < n_corners; gate += 3) {
        const int32_t a = item[gate], b = item[gate + 1], o = opposite[gate];
        const int32_t across = o < 0 ? known : item[positions::previous(o)];
        if (item[gate + 2] >= known && a < known && b < known && across < known) {
            code(known++, Near{a, b, across, near_both});
            continue;
        }
        for (int32_t c = gate; c < gate + 3; ++c)
            if (item[c] >= known) code(known, latest_of(known, c == gate ? near_nothing : near_latest)), ++known;
    }
    for (; known < items.n; ++known) code(known, latest_of(known, near_nothing));
}

// Of faces: those before across their edges, the latest first.
template <class Code>
void along_faces(const Items& items, Code code) {
    const FaceEdges edges(items);
    for (int32_t f = 0; f < items.n; ++f) {
        int32_t a = -1, b = -1;
        for (int32_t h = edges.begin(f), end = edges.end(f); h < end; ++h) {
            const int32_t across = edges.across(h), g = across < f ? across : -1;
            b = std::max(b, std::min(a, g));
            a = std::max(a, g);
        }
        code(f, a < 0 ? latest_of(f, near_nothing) : Near{a, b < 0 ? a : b, b < 0 ? a : b, near_both});
    }
}

template <class Code>
void along_rows(const Items& items, Code code) {
    for (int32_t row = 0; row < items.n; ++row) code(row, Near{row - 1, row - 1, std::max(row - 2, 0), row < 2 ? near_nothing : near_both});
}

// S: IntegerSpace, or Float32.
template <class S, class Coder>
class FastCoder {
public:
    // values: in groups of three components, zeros beyond the last; guess: alike, or none.
    FastCoder(Coder& coder, FastWay way, size_t width, std::span<uint32_t> values, std::span<const uint32_t> guess)
        : coder_(coder), way_(way), width_(width), values_(values), guess_(guess), sizes_(values.size() / 3),
          models_(std::min(width / 3, max_models)) {}

    void run(const Items& items) {
        const auto code_item = [&](int32_t item, const Near& near) { code(item, near); };
        if (!items.item.empty()) along_surface(items, code_item);
        else if (!items.opposite.empty()) along_faces(items, code_item);
        else along_rows(items, code_item);
    }

private:
    static constexpr size_t max_models = 22;

    void code(int32_t item, const Near& near) {
        const size_t at = static_cast<size_t>(item) * width_;
        // Of the first item a is -1: nothing is read there.
        const size_t a = near.a < 0 ? at : static_cast<size_t>(near.a) * width_, b = near.b < 0 ? at : static_cast<size_t>(near.b) * width_;
        const size_t across = near.across < 0 ? at : static_cast<size_t>(near.across) * width_;
        for (size_t c = 0; c < width_; c += 3) {
            std::array<uint32_t, 3> base{};
            positions::Sizes sizes = 0;
            if (near.a >= 0) {
                for (size_t d = 0; d < 3; ++d) base[d] = expect(a + c + d, b + c + d, across + c + d);
                sizes = positions::mean(sizes_[(a + c) / 3], sizes_[(b + c) / 3]);
            }
            if (way_.expected == Expected::guess && !guess_.empty())
                for (size_t d = 0; d < 3; ++d) base[d] = guess_[at + c + d];
            code_group(at + c, models_[std::min(c / 3, max_models - 1)], near.kind, base, sizes);
        }
    }

    uint32_t expect(size_t a, size_t b, size_t across) const {
        if constexpr (std::is_same_v<S, Float32>) return expect_float(a, b, across);
        switch (way_.expected) {
            case Expected::parallelogram: return values_[a] + values_[b] - values_[across];
            case Expected::mean: return values_[a] + static_cast<uint32_t>(static_cast<int32_t>(values_[b] - values_[a]) >> 1);
            default: return values_[a];
        }
    }

    uint32_t expect_float(size_t a, size_t b, size_t across) const {
        const auto of = [&](size_t i) { return S::value(static_cast<int32_t>(values_[i])); };
        switch (way_.expected) {
            case Expected::parallelogram: return static_cast<uint32_t>(S::nearest(of(a) + of(b) - of(across)));
            case Expected::mean: return static_cast<uint32_t>(S::nearest((of(a) + of(b)) * 0.5));
            default: return values_[a];
        }
    }

    void code_group(size_t at, positions::FastModel& model, size_t kind, const std::array<uint32_t, 3>& base,
                    positions::Sizes expected) {
        positions::FastModel::Residuals e;
        std::array<uint32_t, 3> off;
        for (size_t d = 0; d < 3; ++d) off[d] = values_[at + d] - base[d];
        const uint32_t shared = way_.coupled ? 0xffffffff : 0;
        for (size_t d = 0; d < 3; ++d) e[d] = static_cast<int32_t>(off[d] - (d > 0 ? off[0] & shared : 0));
        sizes_[at / 3] = model.code(coder_, kind, expected, e);
        for (size_t d = 0; d < 3; ++d)
            values_[at + d] = base[d] + static_cast<uint32_t>(e[d]) + (d > 0 ? static_cast<uint32_t>(e[0]) & shared : 0);
    }

    Coder& coder_;
    FastWay way_;
    size_t width_;
    std::span<uint32_t> values_;
    std::span<const uint32_t> guess_;
    std::vector<positions::Sizes> sizes_;  // how far each group was off
    std::vector<positions::FastModel> models_;
};

inline size_t width_of(const Items& items) { return (items.n_components + 2) / 3 * 3; }

template <class Value, class Integer>
std::vector<uint32_t> in_groups(const Items& items, std::span<const Value> values, Integer integer) {
    const size_t width = width_of(items), k = items.n_components;
    std::vector<uint32_t> groups(values.empty() ? 0 : static_cast<size_t>(items.n) * width);
    for (size_t i = 0, at = 0; i < values.size(); i += k, at += width)
        for (size_t c = 0; c < k; ++c) groups[at + c] = static_cast<uint32_t>(integer(values[i + c]));
    return groups;
}

template <class S>
std::vector<uint32_t> guess_of(const Items& items) {
    return in_groups(items, items.guess, [](double x) { return S::nearest(x); });
}

// groups: the values; they are written as they were read.
template <class S>
std::vector<uint8_t> encode_shortest(const Items& items, std::span<uint32_t> groups) {
    const std::vector<uint32_t> guess = guess_of<S>(items);
    std::vector<uint8_t> best;
    FastWay best_way;
    const auto attempt = [&](FastWay way) {
        positions::TwoPartEncoder coder(groups.size());
        FastCoder<S, positions::TwoPartEncoder>(coder, way, width_of(items), groups, guess).run(items);
        std::vector<uint8_t> bytes = coder.finish();
        if (!best.empty() && bytes.size() >= best.size()) return;
        best = std::move(bytes);
        best_way = way;
    };
    for (const Expected expected : {Expected::parallelogram, Expected::mean, Expected::nearest}) attempt({expected});
    if (!guess.empty()) attempt({Expected::guess});
    if (items.n_components > 1) attempt({best_way.expected, true});
    best.insert(best.begin(), best_way.byte());
    return best;
}

template <class S>
void decode_groups(std::span<const uint8_t> bytes, const Items& items, std::span<uint32_t> groups) {
    const std::vector<uint32_t> guess = guess_of<S>(items);
    const FastWay way = FastWay::of(bytes.empty() ? 0 : bytes[0]);
    positions::TwoPartDecoder coder(bytes.subspan(std::min<size_t>(bytes.size(), 1)));
    FastCoder<S, positions::TwoPartDecoder>(coder, way, width_of(items), groups, guess).run(items);
}

std::vector<uint8_t> encode_fast(const Items& items, Space space, std::span<const int64_t> values) {
    for (const int64_t x : values)
        if (x != static_cast<int32_t>(x)) return {};
    std::vector<uint32_t> groups = in_groups(items, values, [](int64_t x) { return x; });
    return space == Space::float32 ? encode_shortest<Float32>(items, groups) : encode_shortest<IntegerSpace>(items, groups);
}

void decode_fast(std::span<const uint8_t> bytes, const Items& items, Space space, std::span<int64_t> values) {
    const size_t width = width_of(items), k = items.n_components;
    std::vector<uint32_t> groups(static_cast<size_t>(items.n) * width);
    if (space == Space::float32) decode_groups<Float32>(bytes, items, groups);
    else decode_groups<IntegerSpace>(bytes, items, groups);
    for (size_t i = 0, at = 0; i < values.size(); i += k, at += width)
        for (size_t c = 0; c < k; ++c) values[i + c] = static_cast<int32_t>(groups[at + c]);
}

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::attributes
