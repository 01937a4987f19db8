// What followed the last time the same circumstances were met: a match model of order one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ebz::positions {

class Recall {
public:
    struct Entry {
        int64_t value;
        uint32_t key;
        uint32_t hits;  // times in a row that the value came again, 0 if never met
    };
    static constexpr uint32_t max_hits = 15;

    explicit Recall(int log2_entries) : shift_(32 - log2_entries), entries_(size_t{1} << log2_entries) {}

    void prefetch(uint32_t key) const { __builtin_prefetch(&entries_[key >> shift_], 1); }

    // Null if these circumstances are new.
    const Entry* find(uint32_t key) const {
        const Entry& e = entries_[key >> shift_];
        return e.hits != 0 && e.key == key ? &e : nullptr;
    }

    void learn(uint32_t key, int64_t value) {
        Entry& e = entries_[key >> shift_];
        const bool again = e.hits != 0 && e.key == key && e.value == value;
        e = {value, key, again ? (e.hits < max_hits ? e.hits + 1 : max_hits) : 1};
    }

private:
    int shift_;
    std::vector<Entry> entries_;
};

}  // namespace ebz::positions
