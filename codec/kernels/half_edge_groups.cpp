#include "half_edge_groups.hpp"

#include <algorithm>

namespace ebz {

namespace {

struct Entry {
    Index far;  // the larger vertex of the edge
    Index half_edge;
    bool operator<(const Entry& other) const {
        return far != other.far ? far < other.far : half_edge < other.half_edge;
    }
};

template <class Faces>
class Matcher {
public:
    Matcher(const Faces& faces, std::span<Index> opposite)
        : faces_(faces), opposite_(opposite) {
        singular_.offsets.push_back(0);
    }

    // All half-edges whose smaller vertex is the same.
    void bucket(std::span<const Index> half_edges) {
        entries_.clear();
        for (const Index h : half_edges) {
            entries_.push_back({std::max(faces_[h], faces_[faces_.next(h)]), h});
        }
        std::sort(entries_.begin(), entries_.end());
        for (size_t i = 0, j = 0; i < entries_.size(); i = j) {
            while (j < entries_.size() && entries_[j].far == entries_[i].far) ++j;
            edge(std::span(entries_).subspan(i, j - i));
        }
    }

    SingularEdges finish() { return std::move(singular_); }

private:
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
    std::vector<Entry> entries_;
    SingularEdges singular_;
};

}  // namespace

template <class Faces>
SingularEdges match_regular_edges(const Faces& faces, Index n_vertices, const std::vector<bool>& isolated,
                                  std::span<Index> opposite) {
    const Index n = faces.n_corners();
    const auto near = [&](Index h) { return std::min(faces[h], faces[faces.next(h)]); };
    // A counting sort by the smaller vertex: afterwards bucket v is [start[v - 1], start[v]).
    std::vector<Index> start(static_cast<size_t>(n_vertices) + 1, 0);
    for (Index h = 0; h < n; ++h) {
        if (!isolated[faces.face(h)]) ++start[near(h) + 1];
    }
    for (Index v = 0; v < n_vertices; ++v) start[v + 1] += start[v];
    std::vector<Index> sorted(start[n_vertices]);
    for (Index h = 0; h < n; ++h) {
        if (!isolated[faces.face(h)]) sorted[start[near(h)]++] = h;
    }
    Matcher matcher(faces, opposite);
    for (Index v = 0, from = 0; v < n_vertices; from = start[v++]) {
        if (start[v] - from > 1) matcher.bucket(std::span(sorted).subspan(from, start[v] - from));
    }
    return matcher.finish();
}

template SingularEdges match_regular_edges(const TriangleFaces&, Index, const std::vector<bool>&, std::span<Index>);
template SingularEdges match_regular_edges(const PolygonFaces&, Index, const std::vector<bool>&, std::span<Index>);

}  // namespace ebz
