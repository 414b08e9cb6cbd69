#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/record/file_bytes.h"

/// The bytes of MCAP (https://mcap.dev/spec): opcodes and little-endian building blocks that
/// writer and reader share.
namespace palp::record {

static_assert(std::endian::native == std::endian::little, "MCAP is little-endian, and so are we");

enum class McapOpcode : std::uint8_t {
  Header = 0x01,
  Footer = 0x02,
  Schema = 0x03,
  Channel = 0x04,
  Message = 0x05,
  Chunk = 0x06,
  MessageIndex = 0x07,
  ChunkIndex = 0x08,
  Attachment = 0x09,
  AttachmentIndex = 0x0A,
  Statistics = 0x0B,
  Metadata = 0x0C,
  MetadataIndex = 0x0D,
  SummaryOffset = 0x0E,
  DataEnd = 0x0F,
};

inline constexpr std::array<std::byte, 8> kMcapMagic{std::byte{0x89},
                                                     std::byte{'M'},
                                                     std::byte{'C'},
                                                     std::byte{'A'},
                                                     std::byte{'P'},
                                                     std::byte{'0'},
                                                     std::byte{'\r'},
                                                     std::byte{'\n'}};
inline constexpr std::size_t kMcapPrefixSize = 9;   ///< opcode and content length
inline constexpr std::size_t kMcapFooterSize = 20;  ///< content of the Footer; it never grows

/// A map<string, string> in the order in which it stands in the file.
using McapMap = std::vector<std::pair<std::string, std::string>>;

using Bytes = std::vector<std::byte>;

/// A file within the file. Text and data are somebody else's.
struct McapAttachment {
  std::uint64_t log_time{};     ///< [ns]
  std::uint64_t create_time{};  ///< [ns]
  std::string_view name;
  std::string_view media_type;
  FileBytes data;
};

template <std::integral T>
void append(Bytes& out, T value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &value, sizeof(T));
}

inline void append(Bytes& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

inline void append(Bytes& out, std::string_view text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  append(out, std::as_bytes(std::span{text}));
}

inline void append(Bytes& out, const McapMap& map) {
  std::size_t size = 0;
  for (const auto& [key, value] : map) {
    size += 8 + key.size() + value.size();
  }
  append(out, static_cast<std::uint32_t>(size));
  for (const auto& [key, value] : map) {
    append(out, std::string_view{key});
    append(out, std::string_view{value});
  }
}

/// Begins a record and, when it goes out of scope, writes the length of what was appended.
class RecordScope {
 public:
  RecordScope(Bytes& out, McapOpcode opcode) : out_{out} {
    append(out_, static_cast<std::uint8_t>(opcode));
    append(out_, std::uint64_t{0});
    content_ = out_.size();
  }
  RecordScope(const RecordScope&) = delete;
  RecordScope& operator=(const RecordScope&) = delete;
  ~RecordScope() {
    const std::uint64_t length = out_.size() - content_;
    std::memcpy(out_.data() + content_ - sizeof length, &length, sizeof length);
  }
  [[nodiscard]] std::size_t content() const noexcept { return content_; }  ///< where it begins

 private:
  Bytes& out_;
  std::size_t content_{};
};

/// Reads fields one after the other. After the first field that does not fit, ok() is false and
/// every value is zero or empty: the caller asks once, at the end.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::byte> bytes) noexcept : rest_{bytes} {}

  template <class T>
  T read() noexcept {
    T value{};
    const auto bytes = take(sizeof(T));
    if (!bytes.empty()) {
      std::memcpy(&value, bytes.data(), sizeof(T));
    }
    return value;
  }

  std::span<const std::byte> take(std::uint64_t size) noexcept {
    if (size > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const auto taken = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(static_cast<std::size_t>(size));
    return taken;
  }

  std::string_view text() noexcept {
    const auto bytes = take(read<std::uint32_t>());
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes of a string
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  McapMap map() {
    McapMap entries;
    ByteCursor inner{take(read<std::uint32_t>())};
    while (inner.ok() && !inner.empty()) {
      std::string key{inner.text()};
      std::string value{inner.text()};
      if (inner.ok()) {
        entries.emplace_back(std::move(key), std::move(value));
      }
    }
    ok_ = ok_ && inner.ok();
    return entries;
  }

  [[nodiscard]] std::span<const std::byte> rest() const noexcept { return rest_; }
  [[nodiscard]] bool empty() const noexcept { return rest_.empty(); }
  [[nodiscard]] bool ok() const noexcept { return ok_; }

 private:
  std::span<const std::byte> rest_;
  bool ok_{true};
};

}  // namespace palp::record
