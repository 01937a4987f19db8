// Text, byte after byte, by what followed the same bytes before: in a text that both sides know, then in itself.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ebz {

class TextModel;

// What has read a prior is kept: reading it takes longer than coding a few words.  Any number of
// threads may use one.
class TextCoder {
public:
    explicit TextCoder(std::span<const uint8_t> prior);
    ~TextCoder();

    std::vector<uint8_t> encode(std::span<const uint8_t> text) const;
    // text: as long as what was encoded; whatever the bytes are, it is filled.
    void decode(std::span<const uint8_t> bytes, std::span<uint8_t> text) const;

private:
    std::vector<uint8_t> prior_;
    std::unique_ptr<const TextModel> model_;
};

}  // namespace ebz
