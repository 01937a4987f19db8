#include "topology.hpp"

#include <numeric>

namespace ebz {

namespace {

// The boundary half-edge that starts where boundary half-edge h ends.
Index next_on_boundary(std::span<const Index> opposite, Index h) {
    Index c = next(h);
    while (opposite[c] != none) c = next(opposite[c]);
    return c;
}

void count_boundary(std::span<const Index> opposite, Topology& topology) {
    std::vector<bool> seen(opposite.size());
    for (Index h = 0; h < static_cast<Index>(opposite.size()); ++h) {
        if (opposite[h] != none || seen[h]) continue;
        ++topology.n_boundary_loops;
        for (Index g = h; !seen[g]; g = next_on_boundary(opposite, g)) {
            seen[g] = true;
            ++topology.n_boundary_edges;
        }
    }
}

Index count_components(std::span<const Index> opposite) {
    std::vector<Index> parent(opposite.size() / 3);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](Index t) {
        while (parent[t] != t) t = parent[t] = parent[parent[t]];
        return t;
    };
    Index n_components = static_cast<Index>(parent.size());
    for (Index h = 0; h < static_cast<Index>(opposite.size()); ++h) {
        if (opposite[h] <= h) continue;
        const Index a = root(h / 3), b = root(opposite[h] / 3);
        if (a == b) continue;
        parent[a] = b;
        --n_components;
    }
    return n_components;
}

}  // namespace

Topology describe(std::span<const Index> opposite) {
    Topology topology;
    count_boundary(opposite, topology);
    topology.n_components = count_components(opposite);
    topology.n_edges = (static_cast<Index>(opposite.size()) + topology.n_boundary_edges) / 2;
    return topology;
}

}  // namespace ebz
