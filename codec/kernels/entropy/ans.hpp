// Interleaved range ANS: several coders, one stream, so that the decoders of independent symbols overlap.
//
// Reference: J. Duda, "Asymmetric numeral systems", 2009; F. Giesen, "Interleaved entropy coders", 2014.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "adaptive_symbol.hpp"
#include "../instruction_set.hpp"

namespace ebz::ans {
inline namespace EBZ_INSTRUCTIONS {

// Between symbols a state is in [2^24, 2^56), and at the end 2^24; words of 32 bits go in and out.
inline constexpr int least_bits = 24, word_bits = 32, state_bytes = 7;
inline constexpr uint64_t least = uint64_t{1} << least_bits;
inline constexpr int max_raw = 16;

// Notes what is coded; finish() codes it from the last to the first.
template <size_t n_lanes>
class Encoder {
public:
    static constexpr bool encoding = true;

    // n: how many steps are expected.
    void reserve(size_t n) { steps_.reserve(n); }

    template <class Model>
    uint32_t symbol(size_t lane, Model& model, uint32_t symbol) {
        const Share share = model.share(symbol);
        steps_.push_back({share.start, share.frequency, model.total_bits, static_cast<uint16_t>(lane)});
        model.learn(symbol);
        return symbol;
    }

    // Of a model that is not to learn.
    template <class Model>
    uint32_t fixed(size_t lane, const Model& model, uint32_t symbol) {
        const Share share = model.share(symbol);
        steps_.push_back({share.start, share.frequency, model.total_bits, static_cast<uint16_t>(lane)});
        return symbol;
    }

    template <class Model>
    void fixed(const std::array<Model, n_lanes>& models, std::array<uint32_t, n_lanes>& symbols) {
        for (size_t lane = 0; lane < n_lanes; ++lane) fixed(lane, models[lane], symbols[lane]);
    }

    // p1: of 2^15, neither 0 nor all.
    bool bit(size_t lane, bool bit, uint32_t p1) {
        const uint32_t p0 = 32768 - p1;
        steps_.push_back({static_cast<uint16_t>(bit ? p0 : 0), static_cast<uint16_t>(bit ? p1 : p0), 15, static_cast<uint16_t>(lane)});
        return bit;
    }

    // The low n_bits <= max_raw of `value`, which has no others.
    uint32_t raw(size_t lane, uint32_t value, int n_bits) {
        steps_.push_back({static_cast<uint16_t>(value), 1, static_cast<uint16_t>(n_bits), static_cast<uint16_t>(lane)});
        return value;
    }

    // The bytes, one if nothing was coded.  A stream of b bytes holds less than 8 b bits of information.
    std::vector<uint8_t> finish() {
        if (steps_.empty()) return {0};
        std::array<uint64_t, n_lanes> states;
        states.fill(least);
        std::vector<uint32_t> words;
        for (size_t i = steps_.size(); i-- > 0;) {
            const Step& step = steps_[i];
            uint64_t& state = states[step.lane];
            if (state >= uint64_t{step.frequency} << (least_bits + word_bits - step.total_bits)) {
                words.push_back(static_cast<uint32_t>(state));
                state >>= word_bits;
            }
            state = step.frequency == 1 ? state << step.total_bits | step.start
                                        : (state / step.frequency << step.total_bits) + state % step.frequency + step.start;
        }
        std::vector<uint8_t> bytes;
        bytes.reserve(n_lanes * state_bytes + 4 * words.size());
        const auto write = [&](uint64_t value, int n) {
            for (int i = 0; i < n; ++i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
        };
        for (const uint64_t state : states) write(state, state_bytes);
        for (size_t i = words.size(); i-- > 0;) write(words[i], 4);
        return bytes;
    }

private:
    struct Step {
        uint16_t start, frequency, total_bits, lane;
    };

    std::vector<Step> steps_;
};

// Past the end of the stream everything reads as zero: any bytes decode to something.
template <size_t n_lanes>
class Decoder {
public:
    static constexpr bool encoding = false;

    explicit Decoder(std::span<const uint8_t> bytes)
        : bytes_(std::max(bytes.size(), n_lanes * state_bytes) + 8, 0) {
        if (!bytes.empty()) std::memcpy(bytes_.data(), bytes.data(), bytes.size());
        const uint8_t* at = bytes_.data();
        for (uint64_t& state : states_) {
            state = 0;
            for (int i = 0; i < state_bytes; ++i) state |= uint64_t{*at++} << (8 * i);
        }
        at_ = n_lanes * state_bytes;
        last_ = bytes_.size() - 4;
    }

    template <class Model>
    uint32_t symbol(size_t lane, Model& model, uint32_t) {
        const uint32_t symbol = step(states_[lane], model);
        model.learn(symbol);
        return symbol;
    }

    // A symbol in two steps: where in the row it is, and which one that turned out to be.
    template <class Model>
    uint32_t slot(size_t lane, const Model& model) const { return slot_of(states_[lane], model); }

    template <class Model>
    void take(size_t lane, Model& model, uint32_t symbol) {
        advance(states_[lane], model, symbol);
        model.learn(symbol);
    }

    template <class Model>
    void fixed(const std::array<Model, n_lanes>& models, std::array<uint32_t, n_lanes>& symbols) {
        std::array<uint64_t, n_lanes> states = states_;  // held in registers
        for (size_t lane = 0; lane < n_lanes; ++lane) {
            const Model& model = models[lane];
            const auto slot = static_cast<uint32_t>(states[lane]) & ((1u << model.total_bits) - 1);
            symbols[lane] = model.find(slot);
            const Share share = model.share(symbols[lane]);
            states[lane] = share.frequency * (states[lane] >> model.total_bits) + slot - share.start;
        }
        for (uint64_t& state : states) refill(state);
        states_ = states;
    }

    template <class Model>
    uint32_t fixed(size_t lane, const Model& model, uint32_t) {
        uint64_t& state = states_[lane];
        const auto slot = static_cast<uint32_t>(state) & ((1u << model.total_bits) - 1);
        const uint32_t symbol = model.find(slot);
        const Share share = model.share(symbol);
        state = share.frequency * (state >> model.total_bits) + slot - share.start;
        refill(state);
        return symbol;
    }

    bool bit(size_t lane, bool, uint32_t p1) {
        uint64_t& state = states_[lane];
        const uint32_t p0 = 32768 - p1, slot = static_cast<uint32_t>(state) & 32767;
        const bool bit = slot >= p0;
        state = (bit ? p1 : p0) * (state >> 15) + slot - (bit ? p0 : 0);
        refill(state);
        return bit;
    }

    uint32_t raw(size_t lane, uint32_t, int n_bits) {
        uint64_t& state = states_[lane];
        const auto value = static_cast<uint32_t>(state) & ((1u << n_bits) - 1);
        state >>= n_bits;
        refill(state);
        return value;
    }

private:
    template <class Model>
    uint32_t step(uint64_t& state, const Model& model) {
        const uint32_t symbol = model.find(slot_of(state, model));
        advance(state, model, symbol);
        return symbol;
    }

    template <class Model>
    static uint32_t slot_of(uint64_t state, const Model& model) {
        return static_cast<uint32_t>(state) & ((1u << model.total_bits) - 1);
    }

    template <class Model>
    void advance(uint64_t& state, const Model& model, uint32_t symbol) {
        const uint64_t start = model.start(symbol), end = model.start(symbol + 1);
        state = (end - start) * (state >> model.total_bits) + slot_of(state, model) - start;
        if (state < least) [[unlikely]] refill(state);  // a symbol takes few bits, and then it can be foreseen
    }

    // Without a branch: whether a word is due is as good as random.
    void refill(uint64_t& state) {
        const uint8_t* p = bytes_.data() + at_;
        uint32_t word;
        std::memcpy(&word, p, 4);
        if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap32(word);
        const uint64_t due = 0 - static_cast<uint64_t>(state < least);
        state = state << (word_bits & due) | (word & due);
        at_ += 4 & due;
        at_ = at_ < last_ ? at_ : last_;
    }

    std::vector<uint8_t> bytes_;  // with zeros at the end
    size_t at_, last_;
    std::array<uint64_t, n_lanes> states_;
};

}  // namespace EBZ_INSTRUCTIONS
}  // namespace ebz::ans
