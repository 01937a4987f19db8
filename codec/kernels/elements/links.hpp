// The vertices of rows (edges, lines): each is mostly joined to the one before by an edge of the mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ebz::elements {

struct Mesh {
    std::span<const int32_t> vertex;   // of each corner of the faces
    std::span<const int32_t> offsets;  // where the corners of each face begin
    std::span<const double> points;    // 3 for each vertex
    int32_t n_vertices;
};

// offsets: where the corners of each row begin.
std::vector<uint8_t> encode_links(const Mesh& mesh, std::span<const int64_t> offsets, std::span<const int32_t> corners);

// Throws Corrupt at a vertex that is none.
std::vector<int32_t> decode_links(std::span<const uint8_t> bytes, const Mesh& mesh, std::span<const int64_t> offsets);

}  // namespace ebz::elements
