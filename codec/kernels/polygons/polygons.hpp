// Polygons as runs of triangles in the word of Edgebreaker.
//
// A polygon is cut when it is entered: into a fan around the end of its gate, so that what is left of it
// lies across the right edge of each triangle, which is visited next after C, L and S alike.  So its
// triangles follow one another, and all but the last have one of these three symbols.
// Reference: M. Isenburg, "Compressing polygon mesh connectivity with degree duality prediction", 2002, for
// what degrees tell; there faces are coded whole.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../word/connectivity.hpp"

namespace ebz::polygons {

// What a triangle is of its polygon.  Faces of one and two corners are single triangles that repeat their
// last corner.  The marks of a word are by position, then those of closed components' first triangles.
enum Mark : uint8_t { last, goes_on, two_corners, one_corner };

struct EncodedPolygons {
    Word word;  // without gates; n_single is that of polygons
    std::vector<uint8_t> marks;
    Connectivity connectivity;
    std::vector<Index> source_corner;  // per corner of the triangles
};

// vertex: of k corners, in [0, n_vertices).  offsets: of faces with three corners at least.
EncodedPolygons encode_polygons(std::span<const Index> vertex, std::span<const Index> offsets, Index n_vertices);

// The word with the marks, in reverse order; as encode_adaptive.  Effort is fast or strong.
std::vector<uint8_t> encode_adaptive(std::span<const uint8_t> symbols, std::span<const uint8_t> marks,
                                     const WordHeader& header, std::span<const SpecialS> specials,
                                     Effort effort);

struct DecodedPolygons {
    AdaptivelyDecoded triangles;
    std::vector<uint8_t> marks;
};

DecodedPolygons decode_adaptive(std::span<const uint8_t> bytes, const WordHeader& header, Index n_specials,
                                Effort effort);

// The corners of the polygons, in order: each is that of a triangle from which its own edge leaves, which
// is no diagonal.
struct Corners {
    std::vector<Index> offsets;  // n_polygons + 1
    std::vector<Index> corner;
};

// Throws Corrupt where a polygon goes on in a triangle that is not across its edge.
Corners corners_of_polygons(std::span<const Index> opposite, std::span<const uint8_t> marks);

}  // namespace ebz::polygons
