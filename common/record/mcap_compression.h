#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "common/record/mcap_format.h"

/// What MCAP borrows from zlib (CRC-32) and from zstd (chunks).
namespace palp::record {

/// CRC-32 of zlib; `so_far` continues an earlier one. "123456789" gives 0xCBF43926.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t so_far = 0);
/// The same of many bytes of a file, of which only a piece at a time is in memory.
[[nodiscard]] std::uint32_t crc32_in_pieces(const FileBytes& bytes, std::uint32_t so_far = 0);

/// One zstd context, kept between chunks.
class ChunkCompressor {
 public:
  explicit ChunkCompressor(int level);
  ~ChunkCompressor();
  ChunkCompressor(const ChunkCompressor&) = delete;
  ChunkCompressor& operator=(const ChunkCompressor&) = delete;
  /// Appends the frame to `out`. @returns false: zstd refused, `out` is as it was.
  bool compress(std::span<const std::byte> records, Bytes& out);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// The records of a chunk, or an empty span and a sentence in `error`. Memory is bounded by
/// `size_max` whatever the bytes claim.
class ChunkDecompressor {
 public:
  explicit ChunkDecompressor(std::uint64_t size_max) : size_max_{size_max} {}
  struct Answer {
    std::span<const std::byte> records;  ///< valid until the next call, or as long as `bytes`
    std::string_view error;              ///< empty: all is well
  };
  Answer decompress(std::string_view compression,
                    std::span<const std::byte> bytes,
                    std::uint64_t uncompressed_size);

 private:
  std::uint64_t size_max_;  ///< [bytes]
  std::unique_ptr<std::byte[]> buffer_;
  std::uint64_t capacity_{};  ///< [bytes]
};

}  // namespace palp::record
