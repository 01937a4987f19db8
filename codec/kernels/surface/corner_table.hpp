// Corners and half-edges of a triangle mesh, as index arithmetic.
//
// Corner c is in triangle c / 3.  Half-edge c runs from the vertex of corner c to that of next(c);
// opposite[c] is the half-edge that runs the other way across the same edge, -1 on a boundary.
// Reference: J. Rossignac, A. Safonova, A. Szymczak, "3D compression made simple: Edgebreaker on a
// corner table", 2001.  There a corner names the edge across from it; here it names the edge after it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ebz {

using Index = int32_t;
inline constexpr Index none = -1;

// Without branches, which would be hard to foresee.
constexpr Index next(Index c) { return c + 1 - 3 * (c % 3 == 2); }
constexpr Index previous(Index c) { return c - 1 + 3 * (c % 3 == 0); }

struct Fans {
    std::vector<Index> vertex;  // per corner
    Index n_vertices = 0;
    std::vector<Index> first;   // corner of each vertex
};

// Corners in output order, with the vertices of the pieces numbered by first corner.
struct Connectivity {
    std::vector<Index> opposite;
    Fans fans;
};

// One vertex for each fan of corners that are joined through edges, numbered by first corner.
// opposite must be an involution without fixed points.
Fans number_fans(std::span<const Index> opposite);

// The same around faces of any kind (faces.hpp).
template <class Faces>
Fans number_fans(std::span<const Index> opposite, const Faces& faces);

struct Numbered {
    std::vector<Index> number;  // of each entry's item
    std::vector<Index> items;   // by number
};

// Numbers items by first use; entries: items in [0, n_items).
Numbered number_by_first_use(std::span<const Index> entries, Index n_items);

}  // namespace ebz
