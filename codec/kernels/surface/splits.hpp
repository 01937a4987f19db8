// Points that several vertices share: which corners at a point belong to which vertex.
//
// Vertices with equal positions are welded into points, so that seams and triangle soups are coded as the
// surfaces they are.  Around each point, edges across which vertices differ cut its fans into runs.  Seams go
// on from point to point: what is told at one end of an edge foretells the other, and most points, which no
// seam reaches, are passed over together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "corner_table.hpp"

namespace ebz {

// A fan: the corners at one point that are joined across edges; numbered by first corner.
struct FannedPoints {
    std::span<const Index> opposite, fan, point;  // of each corner
    std::span<const Index> point_of_fan;
    Index n_points;
};

struct FansAtPoints {
    std::vector<Index> fan, point_of_fan;
};

FansAtPoints fans_at_points(std::span<const Index> opposite, std::span<const Index> point);

// One vertex of each point has its number; more are numbered as they are told, from n_points on.
struct Splits {
    std::vector<Index> vertex;  // of each corner
    std::vector<Index> point;   // of each vertex beyond the first n_points
};

struct EncodedSplits {
    std::vector<uint8_t> bytes;
    Splits splits;
    std::vector<Index> label;  // of each vertex
};

// label: of each corner, equal at the corners of one vertex, which is at one point.
EncodedSplits encode_splits(const FannedPoints& points, std::span<const Index> label);

Splits decode_splits(std::span<const uint8_t> bytes, const FannedPoints& points);

}  // namespace ebz
