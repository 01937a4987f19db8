// Counts that describe a surface.
#pragma once

#include <span>

#include "corner_table.hpp"

namespace ebz {

struct Topology {
    Index n_components = 0;
    Index n_boundary_loops = 0;
    Index n_boundary_edges = 0;
    Index n_edges = 0;
};

Topology describe(std::span<const Index> opposite);

}  // namespace ebz
