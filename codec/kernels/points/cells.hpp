// The occupied cells of one level of an octree, and who lies beside whom.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace ebz::points {

using Position = std::array<uint64_t, 3>;

// A cube that holds points; its place counts cubes of its size.
struct Cell {
    Position at{};
    uint32_t begin = 0, end = 0;  // its points
    uint8_t chain = 0;            // how many cells above it in turn had one child, 255 at most
    uint8_t siblings = 0;         // the other children of the cell above
    uint8_t child = 0;            // which child of it this is
    bool is_remote = false;       // no cell is beside it, so none will be beside its children
};

// Multiplicative hashes, the upper bits of which are used.
inline uint64_t mix(uint64_t a, uint64_t b) {
    const uint64_t h = (a + 0x632BE59BD9B4E019u) * 0x9E3779B97F4A7C15u + b * 0xC2B2AE3D27D4EB4Fu;
    return (h ^ h >> 29) * 0xD6E8FEB86659FD93u;
}

// Finds cells by their place.  Where hashes collide both sides miss or confuse the same cells, which
// costs bits only; the limit on probes bounds the time that chosen collisions take.
class CellTable {
public:
    static constexpr uint32_t none = ~uint32_t{0};

    void build(std::span<const Cell> cells) {
        const size_t size = std::bit_ceil(2 * cells.size() + n_probes);
        shift_ = 65 - std::bit_width(size);
        slots_.assign(size, {0, none});
        for (uint32_t i = 0; i < cells.size(); ++i) {
            const uint64_t key = hash(cells[i].at);
            for (size_t probe = 0; probe < n_probes; ++probe) {
                Slot& slot = slots_[place(key, probe)];
                if (slot.cell != none) continue;
                slot = {static_cast<uint32_t>(key), i};
                break;
            }
        }
    }

    uint32_t find(const Position& at) const {
        const uint64_t key = hash(at);
        for (size_t probe = 0; probe < n_probes; ++probe) {
            const Slot& slot = slots_[place(key, probe)];
            if (slot.cell == none || slot.key == static_cast<uint32_t>(key)) return slot.cell;
        }
        return none;
    }

private:
    static constexpr size_t n_probes = 16;

    struct Slot {
        uint32_t key, cell;
    };

    static uint64_t hash(const Position& at) { return mix(mix(at[0], at[1]), at[2]); }

    size_t place(uint64_t key, size_t probe) const { return ((key >> shift_) + probe) & (slots_.size() - 1); }

    std::vector<Slot> slots_;
    int shift_ = 0;
};

// The 27 cells around and including one, by place: 9 x + 3 y + z, each 0 (below), 1 or 2 (above).
inline constexpr int n_around = 27, centre = 13;

// Bit i is set where the cell at place i holds points.  children: of those among the cells that come
// before, 0 for the others.
struct Surroundings {
    uint32_t present = 1u << centre;
    std::array<uint8_t, n_around> children{};

    bool has(int place) const { return present >> place & 1; }
    bool is_alone() const { return present == 1u << centre; }
};

}  // namespace ebz::points
