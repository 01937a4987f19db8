#include "gluing.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "../entropy/adaptive_bit.hpp"
#include "../errors.hpp"
#include "../entropy/integers.hpp"

namespace ebz {

namespace {

// One path for both sides; a decoder passes the sites to be filled in.
template <class Coder>
class GluingCoder {
public:
    GluingCoder(const GluedPieces& pieces, std::span<Index> site, Coder& coder)
        : pieces_(pieces),
          site_(site),
          coder_(coder),
          after_(site.size(), none),
          before_(site.size(), none),
          starts_(site.size()),
          older_(site.size(), none),
          latest_(site.size(), none) {
        find_boundaries_and_starts();
    }

    void run() {
        std::vector<uint64_t> gaps = code_gaps();
        gaps.push_back(UINT64_MAX);
        auto gap = gaps.begin();
        const auto is_copy = [&](Index v) {
            if (!is_inside(v)) return code_is_copy(v);
            if ((*gap)-- > 0) return false;
            ++gap;
            return true;
        };
        Index v = 0;
        for (Index n_left = pieces_.n_copies; n_left > 0; ++v) {
            if (v == pieces_.n_vertices) throw Corrupt("fewer copies than declared");
            if (v > 0 && is_copy(v)) {
                const Index site = site_[v] = code_site(v);
                older_[v] = std::exchange(latest_[site], v);
                --n_left;
            } else {
                latest_[n_sites_] = v;
                site_[v] = n_sites_++;
            }
        }
        std::iota(site_.begin() + v, site_.end(), n_sites_);
    }

private:
    static constexpr size_t max_candidates = 4, max_pieces = 8;

    struct Candidates {
        std::array<Index, max_candidates> sites;
        size_t n = 0;

        void add(Index site) {
            const auto end = sites.begin() + static_cast<std::ptrdiff_t>(n);
            if (n < max_candidates && std::find(sites.begin(), end, site) == end) sites[n++] = site;
        }
    };

    // Neither on a boundary nor the first of a component.
    bool is_inside(Index v) const { return after_[v] == none && !starts_[v]; }

    // Copies inside are rare: how many vertices inside precede each, since the one before.
    std::vector<uint64_t> code_gaps() {
        std::vector<uint64_t> gaps;
        if constexpr (Coder::encoding) gaps = find_gaps();
        const uint64_t n = n_inside_.code(coder_, gaps.size());
        if (n > static_cast<uint64_t>(pieces_.n_copies)) throw Corrupt("more copies inside than copies");
        gaps.resize(n);
        for (uint64_t& gap : gaps) gap = gap_.code(coder_, gap);
        return gaps;
    }

    std::vector<uint64_t> find_gaps() const {
        std::vector<uint64_t> gaps;
        uint64_t gap = 0;
        Index n_sites = 0;
        for (Index v = 0; v < pieces_.n_vertices; ++v) {
            const bool is_copy = site_[v] < n_sites;
            n_sites += !is_copy;
            if (!is_inside(v)) continue;
            if (is_copy) gaps.push_back(gap);
            gap = is_copy ? 0 : gap + 1;
        }
        return gaps;
    }

    // Most triangles have an earlier neighbour and no boundary.
    void find_boundaries_and_starts() {
        const Index* const opposite = pieces_.opposite.data();
        for (Index first = 0; first < n_corners(); first += 3) {
            const Index a = opposite[first], b = opposite[first + 1], c = opposite[first + 2];
            if ((a | b | c) < 0) [[unlikely]] find_boundaries(first);
            // Components follow one another: one starts with a triangle that has no neighbour among those before.
            const auto none_before = [&](Index h) { return static_cast<uint32_t>(h) > static_cast<uint32_t>(first); };
            if (none_before(a) && none_before(b) && none_before(c)) starts_[pieces_.vertex[first]] = true;
        }
    }

    [[gnu::noinline]] void find_boundaries(Index first) {
        for (Index h = first; h < first + 3; ++h) {
            if (pieces_.opposite[h] != none) continue;
            const Index from = pieces_.vertex[h], to = pieces_.vertex[next(h)];
            after_[from] = to;
            before_[to] = from;
        }
    }

    Index n_corners() const { return static_cast<Index>(pieces_.opposite.size()); }

    bool code_is_copy(Index v) {
        const bool truth = Coder::encoding && site_[v] < n_sites_;
        if (starts_[v]) return latest_start_ = start_bit_[latest_start_].code(coder_, truth);
        return copy_bit_[state(before_[v], v)][state(after_[v], v)].code(coder_, truth);
    }

    // 0: not known; 1: its site is its own so far; 2: it is glued.
    size_t state(Index u, Index v) const {
        if (u == none || u >= v) return 0;
        return is_glued(u) ? 2 : 1;
    }

    bool is_glued(Index u) const { return older_[u] != none || latest_[site_[u]] != u; }

    Index code_site(Index v) {
        const Candidates candidates = find_candidates(v);
        for (size_t i = 0; i < candidates.n; ++i) {
            if (candidate_bit_[i].code(coder_, site_[v] == candidates.sites[i])) return candidates.sites[i];
        }
        Index& base = base_[starts_[v]];
        const int64_t step = unzigzag(step_[starts_[v]].code(coder_, zigzag(int64_t{site_[v]} - base)));
        if (step < -int64_t{base} || step >= int64_t{n_sites_} - base) throw Corrupt("a copy of a vertex that is not yet there");
        return base += static_cast<Index>(step);
    }

    // Pieces that touch at a neighbour on the boundary may go on touching along the edge.
    Candidates find_candidates(Index v) const {
        Candidates found;
        for (const Index u : {before_[v], after_[v]}) {
            if (u == none || u >= v) continue;
            size_t n_seen = 0;
            for (Index w = latest_[site_[u]]; w != none && n_seen < max_pieces; w = older_[w], ++n_seen) {
                if (w == u) continue;
                for (const Index x : {after_[w], before_[w]}) {
                    if (x != none && x < v) found.add(site_[x]);
                }
            }
        }
        return found;
    }

    const GluedPieces& pieces_;
    std::span<Index> site_;
    Coder& coder_;
    std::vector<Index> after_, before_;  // the neighbours along the boundary
    std::vector<uint8_t> starts_;        // whether a component starts with the vertex
    std::vector<Index> older_;           // the piece vertex before each at its site
    std::vector<Index> latest_;          // at each site
    Index n_sites_ = 0;
    std::array<Index, 2> base_{};        // the site that steps are told from, by whether a component starts
    bool latest_start_ = false;
    std::array<AdaptiveBit, 2> start_bit_;
    std::array<std::array<AdaptiveBit, 3>, 3> copy_bit_;
    std::array<AdaptiveBit, max_candidates> candidate_bit_;
    std::array<IntegerModel, 2> step_;
    IntegerModel n_inside_, gap_;
};

}  // namespace

std::vector<uint8_t> encode_gluing(const GluedPieces& pieces, std::span<const Index> site) {
    // The shared path writes to each vertex what it read from it.
    std::vector<Index> copy(site.begin(), site.end());
    RangeEncoder coder;
    GluingCoder<RangeEncoder>(pieces, copy, coder).run();
    return coder.finish();
}

std::vector<Index> decode_gluing(std::span<const uint8_t> bytes, const GluedPieces& pieces) {
    std::vector<Index> site(static_cast<size_t>(pieces.n_vertices));
    RangeDecoder coder(bytes);
    GluingCoder<RangeDecoder>(pieces, site, coder).run();
    return site;
}

std::vector<Index> glue(std::span<const Index> vertex, std::span<const Index> site) {
    std::vector<Index> sites(vertex.size());
    for (size_t c = 0; c < sites.size(); ++c) sites[c] = site[vertex[c]];
    return sites;
}

}  // namespace ebz
