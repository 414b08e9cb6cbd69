#include "common/record/mcap_compression.h"

#include <zlib.h>
#include <zstd.h>

namespace palp::record {

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t so_far) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib speaks of unsigned char
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(::crc32_z(so_far, data, bytes.size()));
}

std::uint32_t crc32_in_pieces(const FileBytes& bytes, std::uint32_t so_far) {
  bytes.in_pieces([&](std::span<const std::byte> piece) { so_far = crc32(piece, so_far); });
  return so_far;
}

struct ChunkCompressor::Context {
  explicit Context(int compression_level) : level{compression_level} {}
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { ZSTD_freeCCtx(zstd); }

  ZSTD_CCtx* zstd{ZSTD_createCCtx()};
  int level;
};

ChunkCompressor::ChunkCompressor(int level) : context_{std::make_unique<Context>(level)} {}
ChunkCompressor::~ChunkCompressor() = default;

bool ChunkCompressor::compress(std::span<const std::byte> records, Bytes& out) {
  const std::size_t at = out.size();
  out.resize(at + ZSTD_compressBound(records.size()));
  const std::size_t size = ZSTD_compressCCtx(context_->zstd,
                                             out.data() + at,
                                             out.size() - at,
                                             records.data(),
                                             records.size(),
                                             context_->level);
  if (ZSTD_isError(size) != 0) {
    out.resize(at);
    return false;
  }
  out.resize(at + size);
  return true;
}

ChunkDecompressor::Answer ChunkDecompressor::decompress(std::string_view compression,
                                                        std::span<const std::byte> bytes,
                                                        std::uint64_t uncompressed_size) {
  if (uncompressed_size > size_max_) {
    return {.records = {}, .error = "claims more uncompressed bytes than the limit"};
  }
  if (bytes.size() > size_max_) return {.records = {}, .error = "has more bytes than the limit"};
  if (compression.empty()) {
    return bytes.size() == uncompressed_size
               ? Answer{.records = bytes, .error = {}}
               : Answer{.records = {}, .error = "has another size than it claims"};
  }
  if (compression != "zstd") {
    return {.records = {}, .error = "is compressed in a way this reader does not know"};
  }
  if (uncompressed_size > capacity_) {
    buffer_.reset();
    buffer_ = std::make_unique_for_overwrite<std::byte[]>(uncompressed_size);
    capacity_ = uncompressed_size;
  }
  const std::size_t size =
      ZSTD_decompress(buffer_.get(), uncompressed_size, bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0 || size != uncompressed_size) {
    return {.records = {}, .error = "cannot be decompressed to the size it claims"};
  }
  return {.records = {buffer_.get(), uncompressed_size}, .error = {}};
}

}  // namespace palp::record
