#include "half_edge_groups.hpp"

#include <algorithm>
#include <memory>

namespace ebz {

namespace {

// A half-edge of the vertex whose bucket it is in, the smaller one of its ends.
struct Entry {
    Index far;  // the other end
    Index half_edge;
    bool operator<(const Entry& other) const {
        return far != other.far ? far < other.far : half_edge < other.half_edge;
    }
};

template <class Faces>
class Matcher {
public:
    Matcher(const Faces& faces, Index n_vertices, std::span<Index> opposite)
        : faces_(faces), opposite_(opposite), latest_(static_cast<size_t>(n_vertices), none) {
        singular_.offsets.push_back(0);
    }

    // All half-edges whose smaller vertex is the same, ascending.
    void bucket(std::span<Entry> entries) {
        if (match(entries)) return;
        for (const Entry& entry : entries) opposite_[entry.half_edge] = none;
        std::sort(entries.begin(), entries.end());
        for (size_t i = 0, j = 0; i < entries.size(); i = j) {
            while (j < entries.size() && entries[j].far == entries[i].far) ++j;
            edge(entries.subspan(i, j - i));
        }
    }

    SingularEdges finish() { return std::move(singular_); }

private:
    // Without branches, which would be hard to foresee: each half-edge is matched with the latest one between
    // the same vertices.  False if that is wrong for some.
    bool match(std::span<const Entry> entries) {
        bool wrong = false;
        Index nowhere = none;
        for (const auto& [far, h] : entries) {
            const Index g = latest_[far];
            latest_[far] = h;
            Index& across = g == none ? nowhere : opposite_[g];
            wrong |= g != none && (across != none || faces_[g] == faces_[h]);
            across = g == none ? none : h;
            opposite_[h] = g;
        }
        for (const Entry& entry : entries) latest_[entry.far] = none;
        return !wrong;
    }

    void edge(std::span<const Entry> group) {
        if (group.size() == 1) return;
        const Index a = group[0].half_edge, b = group[1].half_edge;
        if (group.size() == 2 && faces_[a] != faces_[b]) {
            opposite_[a] = b;
            opposite_[b] = a;
            return;
        }
        for (const Entry& entry : group) singular_.half_edges.push_back(entry.half_edge);
        singular_.offsets.push_back(static_cast<Index>(singular_.half_edges.size()));
    }

    const Faces& faces_;
    std::span<Index> opposite_;
    std::vector<Index> latest_;  // half-edge of the bucket, by its far vertex
    SingularEdges singular_;
};

// Calls visit(near, far, h) for all half-edges of the faces that take part.
template <class Faces, class Visit>
void each_half_edge(const Faces& faces, std::span<const uint8_t> isolated, Visit visit) {
    for (Index f = 0; f < faces.n_faces(); ++f) {
        const Index first = faces.first(f), end = first + faces.size(f);
        if (isolated[f] || first == end) continue;
        Index here = faces[first];
        for (Index h = first; h < end; ++h) {
            const Index there = faces[h + 1 == end ? first : h + 1];
            visit(std::min(here, there), std::max(here, there), h);
            here = there;
        }
    }
}

}  // namespace

template <class Faces>
SingularEdges match_regular_edges(const Faces& faces, Index n_vertices, std::span<const uint8_t> isolated,
                                  std::span<Index> opposite) {
    // A counting sort by the smaller vertex: afterwards bucket v is [start[v - 1], start[v]).
    std::vector<Index> start(static_cast<size_t>(n_vertices) + 1, 0);
    each_half_edge(faces, isolated, [&](Index near, Index, Index) { ++start[near + 1]; });
    for (Index v = 0; v < n_vertices; ++v) start[v + 1] += start[v];
    const auto sorted = std::make_unique_for_overwrite<Entry[]>(static_cast<size_t>(start[n_vertices]));
    each_half_edge(faces, isolated, [&](Index near, Index far, Index h) { sorted[start[near]++] = {far, h}; });
    Matcher matcher(faces, n_vertices, opposite);
    for (Index v = 0, from = 0; v < n_vertices; from = start[v++]) {
        if (start[v] - from > 1) matcher.bucket({&sorted[from], static_cast<size_t>(start[v] - from)});
    }
    return matcher.finish();
}

template SingularEdges match_regular_edges(const TriangleFaces&, Index, std::span<const uint8_t>, std::span<Index>);
template SingularEdges match_regular_edges(const PolygonFaces&, Index, std::span<const uint8_t>, std::span<Index>);

}  // namespace ebz
