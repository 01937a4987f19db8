// What followed the last time the same circumstances were met: a match model of order one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ebz::positions {

// Small values make small tables, which are fast.
template <class Value>
class Recall {
public:
    static constexpr uint32_t max_hits = 15;

    struct Entry {
        uint32_t key_and_hits = 0;  // the lower 28 bits of the key; times in a row that the value came again, 0 if never met
        Value value = 0;

        uint32_t hits() const { return key_and_hits & max_hits; }
        bool is_of(uint32_t key) const { return hits() != 0 && (key_and_hits ^ key << 4) <= max_hits; }

        // is_known: what is_of tells.
        void learn(uint32_t key, bool is_known, Value latest) {
            const bool again = is_known && value == latest;
            *this = {key << 4 | (again ? std::min(hits() + 1, max_hits) : 1), latest};
        }
    };

    // log2_entries >= 4: then the place tells the rest of the key.
    explicit Recall(int log2_entries) : shift_(32 - log2_entries), entries_(size_t{1} << log2_entries) {}

    void prefetch(uint32_t key) const { __builtin_prefetch(&entries_[key >> shift_], 1); }

    // Where these circumstances belong; others may be there.
    Entry& at(uint32_t key) { return entries_[key >> shift_]; }

    // Null if these circumstances are new.
    const Entry* find(uint32_t key) const {
        const Entry& e = entries_[key >> shift_];
        return e.is_of(key) ? &e : nullptr;
    }

    void learn(uint32_t key, Value value) {
        Entry& e = at(key);
        e.learn(key, e.is_of(key), value);
    }

private:
    int shift_;
    std::vector<Entry> entries_;
};

}  // namespace ebz::positions
