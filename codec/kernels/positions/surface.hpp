// Triangles by half-edge, with the vertices of the mesh, and the corners around each vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../surface/corner_table.hpp"

namespace ebz::positions {

using ebz::next;
using ebz::previous;

// Several fans may share a vertex; some vertices may be in no face.
struct Surface {
    std::span<const int32_t> opposite;  // 3 m: the half-edge that runs the other way, -1 on a boundary
    std::span<const int32_t> vertex;    // 3 m: vertex of each corner
    int32_t n_vertices;
};

// One array for all: a non-manifold vertex simply has the corners of several fans.
class CornersOfVertices {
public:
    explicit CornersOfVertices(const Surface& mesh)
        : first_(static_cast<size_t>(mesh.n_vertices) + 1, 0), corners_(mesh.vertex.size()) {
        for (int32_t v : mesh.vertex) ++first_[static_cast<size_t>(v)];
        int32_t sum = 0;
        for (int32_t& f : first_) f = sum += f;
        for (size_t c = mesh.vertex.size(); c-- > 0;) {
            const int32_t at = --first_[static_cast<size_t>(mesh.vertex[c])];
            corners_[static_cast<size_t>(at)] = static_cast<int32_t>(c);
        }
    }

    std::span<const int32_t> operator[](int32_t v) const {
        const auto at = static_cast<size_t>(v);
        const auto begin = static_cast<size_t>(first_[at]);
        return std::span(corners_).subspan(begin, static_cast<size_t>(first_[at + 1]) - begin);
    }

private:
    std::vector<int32_t> first_;
    std::vector<int32_t> corners_;
};

}  // namespace ebz::positions
