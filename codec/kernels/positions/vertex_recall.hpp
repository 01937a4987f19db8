// The vertex by which the same circumstances were met the last time.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ebz::positions {

class VertexRecall {
public:
    // Vertices are below n < 2^31.
    VertexRecall(size_t n, int log2_entries)
        : shift_(32 - log2_entries), n_vertex_bits_(static_cast<int>(std::bit_width(n))), entries_(size_t{1} << log2_entries) {}

    void prefetch(uint32_t key) const { __builtin_prefetch(&entries_[key >> shift_], 1); }

    // -1 if these circumstances are new, as far as the bits of the key tell that an entry has room for.
    int32_t find(uint32_t key) const {
        const uint32_t above = entries_[key >> shift_] ^ check(key);
        return above >> n_vertex_bits_ == 0 ? static_cast<int32_t>(above) - 1 : -1;
    }

    void learn(uint32_t key, int32_t vertex) { entries_[key >> shift_] = check(key) | (static_cast<uint32_t>(vertex) + 1); }

private:
    uint32_t check(uint32_t key) const { return key << n_vertex_bits_; }

    int shift_, n_vertex_bits_;
    std::vector<uint32_t> entries_;  // the lower bits of the key, and below them the vertex + 1, 0 if there was none
};

}  // namespace ebz::positions
