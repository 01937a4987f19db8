// Text, byte after byte, by what followed the same bytes before: in a text that both sides know, then in itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ebz {

std::vector<uint8_t> encode_text(std::span<const uint8_t> prior, std::span<const uint8_t> text);
// text: as long as what was encoded; whatever the bytes are, it is filled.
void decode_text(std::span<const uint8_t> prior, std::span<const uint8_t> bytes, std::span<uint8_t> text);

}  // namespace ebz
