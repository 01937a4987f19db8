// Rows of bytes: each byte in the context of its column and of the byte above it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ebz {

// rows: n times `stride` bytes.
std::vector<uint8_t> encode_rows(std::span<const uint8_t> rows, size_t stride);
void decode_rows(std::span<const uint8_t> bytes, size_t stride, std::span<uint8_t> rows);

}  // namespace ebz
