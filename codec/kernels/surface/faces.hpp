// Faces by their corners, as kernels see them: three to each, or as many as its offsets say.
//
// Half-edge c runs from the vertex of corner c to that of next(c), around the face.
#pragma once

#include <span>
#include <vector>

#include "corner_table.hpp"

namespace ebz {

class TriangleFaces {
public:
    // Pieces of triangles are simple: an edge is told by its two ends.
    static constexpr bool simple = true;

    explicit TriangleFaces(std::span<const Index> vertex) : vertex_(vertex) {}

    Index n_faces() const { return static_cast<Index>(vertex_.size() / 3); }
    Index n_corners() const { return static_cast<Index>(vertex_.size()); }
    Index operator[](Index c) const { return vertex_[c]; }
    Index next(Index c) const { return ebz::next(c); }
    Index previous(Index c) const { return ebz::previous(c); }
    Index face(Index c) const { return c / 3; }
    Index first(Index f) const { return 3 * f; }
    Index size(Index) const { return 3; }

private:
    std::span<const Index> vertex_;
};

class PolygonFaces {
public:
    static constexpr bool simple = false;

    // offsets: n_faces + 1, from 0 to the number of corners; faces may have any number.
    PolygonFaces(std::span<const Index> vertex, std::span<const Index> offsets)
        : vertex_(vertex), offsets_(offsets), face_(vertex.size()) {
        for (Index f = 0; f < n_faces(); ++f) {
            for (Index c = first(f); c < first(f + 1); ++c) face_[c] = f;
        }
    }

    Index n_faces() const { return static_cast<Index>(offsets_.size()) - 1; }
    Index n_corners() const { return static_cast<Index>(vertex_.size()); }
    Index operator[](Index c) const { return vertex_[c]; }
    Index next(Index c) const { return c + 1 == first(face_[c] + 1) ? first(face_[c]) : c + 1; }
    Index previous(Index c) const { return (c == first(face_[c]) ? first(face_[c] + 1) : c) - 1; }
    Index face(Index c) const { return face_[c]; }
    Index first(Index f) const { return offsets_[f]; }
    Index size(Index f) const { return first(f + 1) - first(f); }

private:
    std::span<const Index> vertex_, offsets_;
    std::vector<Index> face_;  // of each corner
};

}  // namespace ebz
