// Entropy coder for attributes: rows of integers, one per item of a surface or of a list.
//
// References: as in positions.hpp; S. Haykin, "Adaptive filter theory" (recursive least squares).  Each
// component is expected near several candidates (neighbours, parallelograms, what geometry says, what the
// components before tell); every binary decision mixes distributions around them, counted contexts, and
// how often each candidate is exactly right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "spaces.hpp"

namespace ebz::attributes {

enum class Method : uint8_t {
    numbers,  // differences to a prediction
    symbols,  // labels and ids below 2^16: bits in contexts of values
    fast,     // differences to a prediction, in few operations
};

// What components have to do with each other.
enum class Relation : uint8_t {
    none,
    unit,  // three components: the sum of squares is total^2
    sum,   // the sum is total
    octahedral,  // two: a unit vector on the unfolded octahedron, total being its centre
};

// What both sides know.  With `item` (of each corner), items lie on a surface; else with `opposite` they
// are its faces; else rows.
struct Items {
    std::span<const int32_t> opposite, item;
    std::span<const int32_t> offsets;  // n + 1, where the half-edges of each face begin; none of triangles
    int32_t n;
    size_t n_components;
    std::span<const double> points;   // 3 per item, or none: where it is
    std::span<const int32_t> site;    // per item, or none: items of one site are at one place
    std::span<const double> guess;    // n_components per item, or none
};

struct Coding {
    Method method;
    Space space;
    Relation relation;
    double total;
    bool heights;  // guesses are normals of vertices that lie above or below where they were
    bool by_area;  // the weights of the faces around
};

// values: n_components per item; of symbols 0 to 2^16 - 1.  Nothing where the fast method has no room for one.
std::vector<uint8_t> encode(const Items& items, const Coding& coding, std::span<const int64_t> values);

// Fills values with what was encoded alike.  Any bytes decode to some values.
void decode(std::span<const uint8_t> bytes, const Items& items, const Coding& coding, std::span<int64_t> values);

}  // namespace ebz::attributes
