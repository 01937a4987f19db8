// Which corner of each face is first in the source, face after face in the order of the source.
#include <algorithm>
#include <array>
#include <bit>

#include "log_odds.hpp"
#include "permutations.hpp"

namespace ebz::order {

namespace {

// One path for both sides: an encoder codes the rotations that are there, a decoder fills them in.
template <class Coder>
class RotationCoder {
public:
    RotationCoder(const Geometry& known, std::span<const Index> face_source, std::span<const Index> vertex_source,
                  std::span<uint8_t> rotations, Coder& coder)
        : surface_(known.surface),
          face_source_(face_source),
          rotations_(rotations),
          coder_(coder),
          number_(surface_.n_vertices, unseen),
          is_seen_(surface_.n_vertices),
          by_use_(vertex_source.empty()) {
        std::copy(vertex_source.begin(), vertex_source.end(), number_.begin());
    }

    void run() {
        std::vector<Index> faces(face_source_.size());
        for (Index f = 0; f < static_cast<Index>(faces.size()); ++f) faces[face_source_[f]] = f;
        for (const Index f : faces) {
            rotations_[f] = code(f, rotations_[f]);
            see(f);
            previous_ = f;
        }
    }

private:
    static constexpr int64_t unseen = INT64_MAX;
    static constexpr int no_slot = 3, n_sizes = 8;

    // The corner with the least number first; what is coded is how far on from there the first one is.
    uint8_t code(Index f, uint8_t rotation) {
        int least = 0;
        for (int k = 1; k < 3; ++k) least = number(f, k) < number(f, least) ? k : least;
        int turn = (rotation - least + 3) % 3;
        if (code_one(0, f, least, turn == 0)) {
            turn = 0;
        } else {
            turn = code_one(1, f, (least + 1) % 3, turn == 1) ? 1 : 2;
        }
        history_ = (4 * history_ + turn) & 63;
        return static_cast<uint8_t>((least + turn) % 3);
    }

    // Whether a corner is the first one; which: 0 for the least, 1 for the next.
    bool code_one(int which, Index f, int corner, bool is_first) {
        const std::array<int, 3> at = {corner, (corner + 1) % 3, (corner + 2) % 3};
        int seen = 0, before = 0, across = 0;
        for (const int k : at) {
            seen = 2 * seen + is_seen_[vertex(f, k)];
            before = 4 * before + slot_in_previous(vertex(f, k));
            across = 4 * across + slot_across(3 * f + k);
        }
        const bool ascends = number(f, at[1]) < number(f, at[2]);
        const int64_t own = number(f, corner);
        LogOdds odds(which == 0 ? -stretch_unit * 7 / 10 : 0);  // 1 : 2 and 1 : 1
        odds.add(by_order_.at(which, ascends, history_ & 15));
        odds.add(by_use_before_.at(which, seen, history_ & 3));
        odds.add(by_previous_.at(which, before, history_ & 3));
        odds.add(by_neighbours_.at(which, across));
        odds.add(by_history_.at(which, face_source_[f] & 1, history_));
        odds.add(by_gaps_.at(which, size_class(number(f, at[1]) - own), size_class(number(f, at[2]) - own)));
        odds.add(by_both_.at(which, before, across));
        return odds.code(coder_, is_first);
    }

    Index vertex(Index f, int k) const { return surface_.vertex[3 * f + k]; }

    // In the source, or by first use there; vertices not yet seen come last.
    int64_t number(Index f, int k) const { return number_[vertex(f, k)]; }

    // Which corner of the source's previous face a vertex is.
    int slot_in_previous(Index v) const {
        if (previous_ == none) return no_slot;
        for (int k = 0; k < 3; ++k) {
            if (vertex(previous_, k) == v) return slot(previous_, k);
        }
        return no_slot;
    }

    // Which corner an edge starts from in the face across, if that comes earlier in the source.
    int slot_across(Index h) const {
        const Index across = surface_.opposite[h];
        if (across == none || face_source_[across / 3] >= face_source_[h / 3]) return no_slot;
        return slot(across / 3, across % 3);
    }

    int slot(Index f, int k) const { return (k - rotations_[f] + 3) % 3; }

    static int size_class(int64_t difference) {
        if (difference < 0) return 0;
        return std::min(n_sizes - 1, static_cast<int>(std::bit_width(static_cast<uint64_t>(difference))) + 1);
    }

    void see(Index f) {
        for (int k = 0; k < 3; ++k) {
            const Index v = vertex(f, (rotations_[f] + k) % 3);
            if (by_use_ && !is_seen_[v]) number_[v] = n_seen_++;
            is_seen_[v] = true;
        }
    }

    const Surface& surface_;
    std::span<const Index> face_source_;
    std::span<uint8_t> rotations_;
    Coder& coder_;
    std::vector<int64_t> number_;
    std::vector<bool> is_seen_;  // by a face that comes earlier in the source
    bool by_use_;
    int64_t n_seen_ = 0;
    Index previous_ = none;
    int history_ = 0;  // the last three turns
    Weights<2, 2, 16> by_order_;
    Weights<2, 8, 4> by_use_before_;
    Weights<2, 64, 4> by_previous_;
    Weights<2, 64> by_neighbours_;
    Weights<2, 2, 64> by_history_;
    Weights<2, n_sizes, n_sizes> by_gaps_;
    Weights<2, 64, 64> by_both_;
};

// Each with probability 1/3.
template <class Coder>
void run_uniform(std::span<uint8_t> rotations, Coder& coder) {
    constexpr uint32_t third = (1u << probability_bits) / 3, half = 1u << (probability_bits - 1);
    for (uint8_t& rotation : rotations) {
        if (coder.bit(rotation == 0, third)) {
            rotation = 0;
        } else {
            rotation = coder.bit(rotation == 1, half) ? 1 : 2;
        }
    }
}

template <class Coder>
void run(const Geometry& known, std::span<const Index> face_source, std::span<const Index> vertex_source,
         bool uniform, std::span<uint8_t> rotations, Coder& coder) {
    if (uniform) return run_uniform(rotations, coder);
    RotationCoder<Coder>(known, face_source, vertex_source, rotations, coder).run();
}

}  // namespace

Bytes encode_rotations(const Geometry& known, std::span<const Index> face_source,
                       std::span<const Index> vertex_source, bool uniform, std::span<const uint8_t> rotations) {
    std::vector<uint8_t> copy(rotations.begin(), rotations.end());
    RangeEncoder coder;
    run(known, face_source, vertex_source, uniform, copy, coder);
    return coder.finish();
}

std::vector<uint8_t> decode_rotations(std::span<const uint8_t> bytes, const Geometry& known,
                                      std::span<const Index> face_source, std::span<const Index> vertex_source,
                                      bool uniform) {
    std::vector<uint8_t> rotations(known.surface.vertex.size() / 3);
    RangeDecoder coder(bytes);
    run(known, face_source, vertex_source, uniform, rotations, coder);
    return rotations;
}

}  // namespace ebz::order
