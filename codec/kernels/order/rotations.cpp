// Which corner of each face is first in the source, face after face in the order of the source.
#include <algorithm>
#include <array>
#include <bit>

#include "log_odds.hpp"
#include "permutations.hpp"

namespace ebz::order {

namespace {

// One path for both sides: an encoder codes the rotations that are there, a decoder fills them in.
template <class Faces, class Coder>
class RotationCoder {
public:
    RotationCoder(const FaceGeometry<Faces>& known, std::span<const Index> face_source,
                  std::span<const Index> vertex_source, std::span<Index> rotations, Coder& coder)
        : faces_(known.faces),
          opposite_(known.opposite),
          face_source_(face_source),
          rotations_(rotations),
          coder_(coder),
          number_(known.positions.size() / 3, unseen),
          is_seen_(number_.size()),
          by_use_(vertex_source.empty()) {
        std::copy(vertex_source.begin(), vertex_source.end(), number_.begin());
    }

    void run() {
        std::vector<Index> faces(face_source_.size());
        for (Index f = 0; f < static_cast<Index>(faces.size()); ++f) faces[face_source_[f]] = f;
        for (const Index f : faces) {
            if (faces_.size(f) > 0) rotations_[f] = code(f, rotations_[f]);
            see(f);
            previous_ = f;
        }
    }

private:
    static constexpr int64_t unseen = INT64_MAX;
    // Slots from the last on count as that; no more corners of a face before are looked at.
    static constexpr int last_slot = 3, no_slot = 4, n_slots = 5, n_sizes = 8;
    static constexpr Index max_corners = 16;

    // The corner with the least number first; what is coded is how far on from there the first one is.
    Index code(Index f, Index rotation) {
        const Index n = faces_.size(f);
        Index least = 0;
        for (Index k = 1; k < n; ++k) least = number(f, k) < number(f, least) ? k : least;
        const Index wanted = (rotation - least + n) % n;
        Index turn = 0;
        while (turn < n - 1 && !code_one(turn, f, (least + turn) % n, turn == wanted)) ++turn;
        history_ = (4 * history_ + std::min(turn, 3)) & 63;
        return (least + turn) % n;
    }

    // Whether a corner is the first one; turn: 0 for the least, 1 for the next.
    bool code_one(Index turn, Index f, Index corner, bool is_first) {
        const Index n = faces_.size(f);
        const std::array<Index, 3> at = {corner, (corner + 1) % n, (corner + 2) % n};
        const int which = std::min(turn, 2);
        int seen = 0, before = 0, across = 0;
        for (const Index k : at) {
            seen = 2 * seen + is_seen_[vertex(f, k)];
            before = n_slots * before + slot_in_previous(vertex(f, k));
            across = n_slots * across + slot_across(faces_.first(f) + k);
        }
        const bool ascends = number(f, at[1]) < number(f, at[2]);
        const int64_t own = number(f, corner);
        LogOdds odds(-logarithm(static_cast<uint32_t>(n - 1 - turn)));
        odds.add(by_order_.at(which, ascends, history_ & 15));
        odds.add(by_use_before_.at(which, seen, history_ & 3));
        odds.add(by_previous_.at(which, before, history_ & 3));
        odds.add(by_neighbours_.at(which, across));
        odds.add(by_history_.at(which, face_source_[f] & 1, history_));
        odds.add(by_gaps_.at(which, size_class(number(f, at[1]) - own), size_class(number(f, at[2]) - own)));
        odds.add(by_both_.at(which, before, across));
        return odds.code(coder_, is_first);
    }

    Index vertex(Index f, Index k) const { return faces_[faces_.first(f) + k]; }

    // In the source, or by first use there; vertices not yet seen come last.
    int64_t number(Index f, Index k) const { return number_[vertex(f, k)]; }

    // Which corner of the source's previous face a vertex is.
    int slot_in_previous(Index v) const {
        if (previous_ == none) return no_slot;
        for (Index k = 0; k < std::min(faces_.size(previous_), max_corners); ++k) {
            if (vertex(previous_, k) == v) return slot(previous_, k);
        }
        return no_slot;
    }

    // Which corner an edge starts from in the face across, if that comes earlier in the source.
    int slot_across(Index h) const {
        const Index across = opposite_[h];
        if (across == none) return no_slot;
        const Index f = faces_.face(across);
        return face_source_[f] >= face_source_[faces_.face(h)] ? no_slot : slot(f, across - faces_.first(f));
    }

    int slot(Index f, Index k) const {
        const Index n = faces_.size(f);
        return std::min((k - rotations_[f] + n) % n, last_slot);
    }

    static int size_class(int64_t difference) {
        if (difference < 0) return 0;
        return std::min(n_sizes - 1, static_cast<int>(std::bit_width(static_cast<uint64_t>(difference))) + 1);
    }

    void see(Index f) {
        const Index n = faces_.size(f);
        for (Index k = 0; k < n; ++k) {
            const Index v = vertex(f, (rotations_[f] + k) % n);
            if (by_use_ && !is_seen_[v]) number_[v] = n_seen_++;
            is_seen_[v] = true;
        }
    }

    const Faces& faces_;
    std::span<const Index> opposite_, face_source_;
    std::span<Index> rotations_;
    Coder& coder_;
    std::vector<int64_t> number_;
    std::vector<bool> is_seen_;  // by a face that comes earlier in the source
    bool by_use_;
    int64_t n_seen_ = 0;
    Index previous_ = none;
    int history_ = 0;  // the last three turns
    static constexpr int n_questions = 3, n_places = n_slots * n_slots * n_slots;
    Weights<n_questions, 2, 16> by_order_;
    Weights<n_questions, 8, 4> by_use_before_;
    Weights<n_questions, n_places, 4> by_previous_;
    Weights<n_questions, n_places> by_neighbours_;
    Weights<n_questions, 2, 64> by_history_;
    Weights<n_questions, n_sizes, n_sizes> by_gaps_;
    Weights<n_questions, n_places, n_places> by_both_;
};

// Each corner of a face with the same probability.
template <class Faces, class Coder>
void run_uniform(const Faces& faces, std::span<Index> rotations, Coder& coder) {
    for (Index f = 0; f < faces.n_faces(); ++f) {
        Index rotation = 0;
        const auto share = [&] { return std::max<uint32_t>(1, (1u << probability_bits) / (faces.size(f) - rotation)); };
        while (rotation < faces.size(f) - 1 && !coder.bit(rotations[f] == rotation, share())) ++rotation;
        rotations[f] = rotation;
    }
}

template <class Faces, class Coder>
void run(const FaceGeometry<Faces>& known, std::span<const Index> face_source, std::span<const Index> vertex_source,
         bool uniform, std::span<Index> rotations, Coder& coder) {
    if (uniform) return run_uniform(known.faces, rotations, coder);
    RotationCoder<Faces, Coder>(known, face_source, vertex_source, rotations, coder).run();
}

}  // namespace

template <class Faces>
Bytes encode_rotations(const FaceGeometry<Faces>& known, std::span<const Index> face_source,
                       std::span<const Index> vertex_source, bool uniform, std::span<const Index> rotations) {
    std::vector<Index> copy(rotations.begin(), rotations.end());
    RangeEncoder coder;
    run(known, face_source, vertex_source, uniform, copy, coder);
    return coder.finish();
}

template <class Faces>
std::vector<Index> decode_rotations(std::span<const uint8_t> bytes, const FaceGeometry<Faces>& known,
                                    std::span<const Index> face_source, std::span<const Index> vertex_source,
                                    bool uniform) {
    std::vector<Index> rotations(known.faces.n_faces());
    RangeDecoder coder(bytes);
    run(known, face_source, vertex_source, uniform, rotations, coder);
    return rotations;
}

template Bytes encode_rotations(const FaceGeometry<TriangleFaces>&, std::span<const Index>, std::span<const Index>,
                                bool, std::span<const Index>);
template Bytes encode_rotations(const FaceGeometry<PolygonFaces>&, std::span<const Index>, std::span<const Index>,
                                bool, std::span<const Index>);
template std::vector<Index> decode_rotations(std::span<const uint8_t>, const FaceGeometry<TriangleFaces>&,
                                             std::span<const Index>, std::span<const Index>, bool);
template std::vector<Index> decode_rotations(std::span<const uint8_t>, const FaceGeometry<PolygonFaces>&,
                                             std::span<const Index>, std::span<const Index>, bool);

}  // namespace ebz::order
