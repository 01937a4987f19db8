// The special S of a word in the order of decoding.
#pragma once

#include <cstdint>
#include <span>

#include "edgebreaker.hpp"

namespace ebz {

// The special S of the word, met from the last to the first.
class SpecialsReversed {
public:
    explicit SpecialsReversed(std::span<const SpecialS> specials) : left_(specials) {}

    // What the S at `position` meets, none if it is not special; positions fall from call to call.
    int64_t take(int64_t position) {
        if (left_.empty() || left_.back().position != position) return none;
        const int64_t meets = left_.back().meets;
        left_ = left_.first(left_.size() - 1);
        return meets;
    }

    bool all_taken() const { return left_.empty(); }

private:
    std::span<const SpecialS> left_;
};

}  // namespace ebz
