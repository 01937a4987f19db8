#include "lists.hpp"

#include "../entropy/bits.hpp"
#include "../entropy/integers.hpp"

namespace ebz {

namespace {

constexpr uint8_t has_both = 64;  // what begins a list, beside the number of plain bits
enum Kind : uint64_t { plain, mirrored, both };

struct Head {
    size_t n_rows, n_plain, size;
};

Head head_of(std::span<const uint8_t> bytes, size_t n) {
    if (bytes.empty()) throw Corrupt("an empty list");
    const size_t n_plain = bytes[0] & (has_both - 1u), size = bytes[0] & has_both ? 3 : 1;
    const size_t n_both = size == 3 && bytes.size() >= 3 ? bytes[1] | size_t{bytes[2]} << 8 : 0;
    const bool is_known = bytes[0] < 2 * has_both && n_plain <= max_plain_bits && bytes.size() >= size && n_both <= n;
    if (!is_known || (n - n_both) * n_plain > 8 * (bytes.size() - size)) {
        throw Corrupt("a list of " + std::to_string(n) + " integers with " + std::to_string(n_plain) + " plain bits each");
    }
    return {n - n_both, n_plain, size};
}

}  // namespace

std::vector<int64_t> decode_list(std::span<const uint8_t> bytes, size_t n) {
    const Head head = head_of(bytes, n);
    const size_t n_bytes = (head.n_rows * head.n_plain + 7) / 8;
    BitReader low(bytes.subspan(head.size, n_bytes));
    const std::vector<uint64_t> rows = decode_integers(bytes.subspan(head.size + n_bytes), head.n_rows, 2);
    std::vector<int64_t> above, below;
    uint64_t magnitude = 0;
    for (size_t i = 0; i < head.n_rows; ++i) {
        const uint64_t kind = rows[2 * i], step = rows[2 * i + 1] << head.n_plain | low.bits(0, static_cast<int>(head.n_plain));
        if (kind > both) throw Corrupt("a kind that no integer of a list has");
        magnitude += step;
        if (kind != mirrored) above.push_back(static_cast<int64_t>(magnitude));
        if (kind != plain) below.push_back(static_cast<int64_t>(~magnitude));
    }
    if (above.size() + below.size() != n) {
        throw Corrupt("a list of " + std::to_string(above.size() + below.size()) + " integers, not " + std::to_string(n));
    }
    std::reverse(below.begin(), below.end());
    below.insert(below.end(), above.begin(), above.end());
    // Steps may add up to more than magnitudes of 64 bits with sign.
    if (!std::is_sorted(below.begin(), below.end())) std::sort(below.begin(), below.end());
    return below;
}

}  // namespace ebz
