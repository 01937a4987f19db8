#include <algorithm>
#include <functional>

#include "../surface/pieces.hpp"
#include "../word/regions.hpp"
#include "../surface/touching_fans.hpp"
#include "polygons.hpp"

namespace ebz::polygons {

namespace {

// As the encoder of triangles (edgebreaker_encode.cpp), but that it cuts polygons into them.
class PolygonEncoder {
public:
    PolygonEncoder(const PolygonFaces& faces, Index n_vertices, const Pieces& pieces)
        : faces_(faces),
          opposite_(pieces.opposite),
          vertex_(pieces.fans.vertex),
          removed_(faces.n_faces()),
          output_of_(opposite_.size()),
          regions_(faces, pieces.opposite, pieces.fans.vertex, pieces.fans.n_vertices),
          touching_(faces, pieces.fans, n_vertices) {}

    EncodedPolygons encode() {
        const auto on_boundary = [&](Index c) { return regions_.leaving(vertex_[c]); };
        each_component(on_boundary, [&](Index h) {
            if (opposite_[h] == none && !is_single(faces_.face(h))) open_component(h);
        });
        each_component(std::identity(), [&](Index h) {
            if (!is_single(faces_.face(h))) closed_component(h);
        });
        each_component(std::identity(), [&](Index h) { single_polygon(faces_.face(h)); });
        const auto by_position = [](const SpecialS& a, const SpecialS& b) { return a.position < b.position; };
        std::sort(word().specials.begin(), word().specials.end(), by_position);
        glue();
        word_marks().insert(word_marks().end(), first_marks_.begin(), first_marks_.end());
        return std::move(encoded_);
    }

private:
    enum Side : Index { gate_side, right_side, left_side };

    Word& word() { return encoded_.word; }
    std::vector<uint8_t>& word_marks() { return encoded_.marks; }
    std::vector<Index>& output() { return encoded_.connectivity.opposite; }
    bool is_new(Index h) const { return !removed_[faces_.face(h)]; }
    bool is_done(Index h) const { return opposite_[h] == none || !is_new(opposite_[h]); }
    Index position() const { return static_cast<Index>(encoded_.word.symbols.size()); }

    bool is_single(Index f) const {
        const auto own = opposite_.subspan(faces_.first(f), faces_.size(f));
        return std::all_of(own.begin(), own.end(), [](Index h) { return h == none; });
    }

    template <class At, class Enter>
    void each_component(At at, Enter enter) {
        const std::vector<Index>& coded = encoded_.source_corner;
        touching_.each_half_edge(at, [&](Index h) {
            if (!is_new(h)) return true;
            const size_t n_before = coded.size();
            enter(h);
            if (!touching_.any()) return true;
            for (size_t i = n_before; i < coded.size(); ++i) touching_.reach(coded[i]);
            return true;
        });
    }

    // From its first corner: it may have repeated the last.
    void single_polygon(Index face) {
        ++word().n_single;
        open_component(faces_.first(face));
    }

    void open_component(Index boundary) {
        regions_.mark_boundary(vertex_[boundary]);
        regions_.leave(boundary, none);
        run();
    }

    // What is left of the first polygon lies across the gate of its first triangle.
    void closed_component(Index gate) {
        const Index face = faces_.face(gate), left = faces_.previous(gate), right = faces_.previous(left);
        const Index size = faces_.size(face);
        removed_[face] = true;
        ++word().n_closed;
        for (const Index c : {gate, right, left}) regions_.mark(vertex_[c]);
        add_triangle(gate, right, left, size > 3 ? gate_side : none);
        first_marks_.push_back(size > 3 ? goes_on : last);
        put(right, right_side);
        put(left, left_side);
        if (size > 3) {
            region(rest_of_polygon(right, gate, size - 1));
        } else {
            put(gate, gate_side);
            region(opposite_[gate]);
        }
        run();
    }

    void run() {
        regions_.run([&](Index gate) { return is_new(gate); }, [&](Index gate) { region(gate); },
                     [&](Index gate, Index position) { special(gate, position); });
    }

    void special(Index gate, Index left_at) {
        const Index met = output_of_[gate];
        const int64_t triangle = met / 3 - word().n_closed;
        word().specials.push_back({left_at, 2 * triangle + (met % 3 == left_side)});
    }

    // Removes polygons until an E.
    void region(Index gate) {
        while (gate != none) {
            const Index face = faces_.face(gate);
            removed_[face] = true;
            output_of_[gate] = static_cast<Index>(output().size());
            gate = rest_of_polygon(gate, faces_.next(gate), faces_.size(face));
        }
    }

    // Removes what is left of a polygon, `size` corners from `end` to `from`, and gives the next gate.
    Index rest_of_polygon(Index from, Index end, Index size) {
        for (;; --size) {
            const Index tip = faces_.previous(from);
            const bool is_last = size == 3;
            const Symbol symbol = remove(tip, is_last && is_done(end));
            emit(symbol, is_last ? last : goes_on);
            add_triangle(from, end, tip, is_last ? none : right_side);
            put(tip, left_side);
            if (is_last) {
                put(end, right_side);
                return symbol == E ? none : opposite_[symbol == R ? tip : end];
            }
            from = tip;
        }
    }

    // The symbol of a triangle with the left edge `left`; S leaves the gate across it on the stack.
    Symbol remove(Index left, bool right_done) {
        const Index tip = vertex_[left];
        if (!regions_.is_marked(tip) && regions_.leaving(tip) == none) {
            regions_.mark(tip);
            return C;
        }
        if (regions_.is_marked(tip) && is_done(left)) return right_done ? E : L;
        if (regions_.is_marked(tip) && right_done) return R;
        regions_.mark_boundary(tip);
        regions_.leave(opposite_[left], position());
        return S;
    }

    void emit(Symbol symbol, Mark mark) {
        word().symbols.push_back(symbol);
        word_marks().push_back(mark);
    }

    // By its corners in the source; rest: the side across which its polygon goes on.
    void add_triangle(Index gate, Index end, Index tip, Index rest) {
        const Index first = static_cast<Index>(output().size());
        encoded_.source_corner.insert(encoded_.source_corner.end(), {gate, end, tip});
        output().insert(output().end(), 3, none);
        if (rest_ != none) {
            output()[rest_] = first;
            output()[first] = rest_;
        }
        rest_ = rest == none ? none : first + rest;
    }

    // What a half-edge of the polygon is in the latest triangle.
    void put(Index h, Side side) { output_of_[h] = static_cast<Index>(output().size()) - 3 + side; }

    void glue() {
        for (Index h = 0; h < faces_.n_corners(); ++h) {
            if (opposite_[h] != none) output()[output_of_[h]] = output_of_[opposite_[h]];
        }
    }

    const PolygonFaces& faces_;
    std::span<const Index> opposite_, vertex_;
    std::vector<bool> removed_;     // faces
    std::vector<Index> output_of_;  // the half-edge of a triangle that each half-edge becomes
    Regions<PolygonFaces> regions_;
    TouchingFans touching_;
    std::vector<uint8_t> first_marks_;
    Index rest_ = none;  // the half-edge of the output across which a polygon goes on
    EncodedPolygons encoded_;
};

}  // namespace

EncodedPolygons encode_polygons(std::span<const Index> vertex, std::span<const Index> offsets, Index n_vertices) {
    const PolygonFaces faces(vertex, offsets);
    EncodedPolygons encoded = PolygonEncoder(faces, n_vertices, cut_into_pieces(faces, n_vertices)).encode();
    encoded.connectivity.fans = number_fans(encoded.connectivity.opposite);
    return encoded;
}

}  // namespace ebz::polygons
