#include "video/media_wire.h"

namespace palp::video {
namespace {

enum Kind : std::uint8_t { kFragment = 1, kReport = 3, kQuestion = 4, kWord = 5 };
constexpr std::uint8_t kKeyFlag = 0x10;
constexpr std::uint8_t kJpegFlag = 0x20;
constexpr std::size_t kFragmentHead = 24;
constexpr std::size_t kReportSize = 29;
constexpr std::size_t kQuestionSize = 9;
constexpr std::size_t kWordSize = 2;

class Writer {
 public:
  explicit Writer(std::size_t size) { bytes_.reserve(size); }
  Writer& put(std::uint64_t value, unsigned size) {
    for (unsigned i = size; i-- > 0;) {
      bytes_.push_back(static_cast<std::byte>(value >> (8U * i) & 0xFFU));
    }
    return *this;
  }
  Writer& put(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) noexcept : rest_{bytes} {}
  /// There are so many.
  template <class Number>
  Number take(unsigned size = sizeof(Number)) noexcept {
    std::uint64_t value = 0;
    for (const std::byte byte : rest_.first(size)) {
      value = value << 8U | std::to_integer<std::uint64_t>(byte);
    }
    rest_ = rest_.subspan(size);
    return static_cast<Number>(value);
  }
  [[nodiscard]] std::span<const std::byte> rest() const noexcept { return rest_; }

 private:
  std::span<const std::byte> rest_;
};

/// Whether all its numbers go together.
bool coheres(const Fragment& one) noexcept {
  if (one.size == 0 || one.size > kFrameSizeMax) return false;
  if (one.data_count == 0 || one.data_count > kDataFragmentsMax) return false;
  const std::size_t count = std::size_t{one.data_count} + one.parity_count;
  if (count > kFragmentsMax || one.index >= count) return false;
  if (one.key != (one.refers_back == 0) || one.refers_back > one.frame) return false;
  const std::size_t each = (one.size + one.data_count - 1U) / one.data_count;
  return each <= kFragmentDataMax && one.data.size() == each;
}

std::optional<MediaMessage> read_fragment(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() <= kFragmentHead) return std::nullopt;
  Reader reader{bytes.subspan(1)};
  const auto flags = reader.take<std::uint8_t>();
  if ((flags & ~(kKeyFlag | kJpegFlag)) != 0) return std::nullopt;
  Fragment one;
  one.key = (flags & kKeyFlag) != 0;
  one.jpeg = (flags & kJpegFlag) != 0;
  one.frame = reader.take<std::uint32_t>();
  one.refers_back = reader.take<std::uint16_t>();
  one.captured_ns = reader.take<std::uint64_t>();
  one.size = reader.take<std::uint32_t>(3);
  one.data_count = reader.take<std::uint8_t>();
  one.parity_count = reader.take<std::uint8_t>();
  one.index = reader.take<std::uint8_t>();
  one.offset_us = reader.take<std::uint16_t>();
  one.data = reader.rest();
  if (!coheres(one)) return std::nullopt;
  return one;
}

std::optional<MediaMessage> read_report(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kReportSize) return std::nullopt;
  Reader reader{bytes.subspan(1)};
  const auto flags = reader.take<std::uint8_t>();
  if (flags > 7) return std::nullopt;
  Report one;
  one.wants_recovery = (flags & 1U) != 0;
  one.wants_key = (flags & 2U) != 0;
  one.unwatched = (flags & 4U) != 0;
  one.newest_delivered = reader.take<std::uint32_t>();
  one.delivered_before = reader.take<std::uint32_t>();
  one.standing_10us = reader.take<std::int16_t>();
  one.lost = reader.take<std::uint16_t>();
  one.span_ratio = reader.take<std::uint16_t>();
  one.rate_kbps = reader.take<std::uint32_t>();
  one.fragments_lost = reader.take<std::uint8_t>();
  one.echo = reader.take<std::uint64_t>();
  return one;
}

}  // namespace

std::string_view to_string(VideoState state) noexcept {
  switch (state) {
    case VideoState::Sending:
      return "picture";
    case VideoState::PathFull:
      return "video stopped: the path carries force only";
    case VideoState::NoCamera:
      return "no camera";
    case VideoState::NoEncoder:
      return "no video encoder at the patient's site";
    case VideoState::Silent:
      return "no picture comes";
  }
  return "";
}

Bytes write(const Fragment& one) {
  const unsigned flags = (one.key ? kKeyFlag : 0U) | (one.jpeg ? kJpegFlag : 0U);
  return Writer{kFragmentHead + one.data.size()}
      .put(kFragment, 1)
      .put(flags, 1)
      .put(one.frame, 4)
      .put(one.refers_back, 2)
      .put(one.captured_ns, 8)
      .put(one.size, 3)
      .put(one.data_count, 1)
      .put(one.parity_count, 1)
      .put(one.index, 1)
      .put(one.offset_us, 2)
      .put(one.data)
      .take();
}

Bytes write(const Report& one) {
  const unsigned flags =
      (one.wants_recovery ? 1U : 0U) | (one.wants_key ? 2U : 0U) | (one.unwatched ? 4U : 0U);
  return Writer{kReportSize}
      .put(kReport, 1)
      .put(flags, 1)
      .put(one.newest_delivered, 4)
      .put(one.delivered_before, 4)
      .put(static_cast<std::uint16_t>(one.standing_10us), 2)
      .put(one.lost, 2)
      .put(one.span_ratio, 2)
      .put(one.rate_kbps, 4)
      .put(one.fragments_lost, 1)
      .put(one.echo, 8)
      .take();
}

Bytes write(const Question& one) {
  return Writer{kQuestionSize}.put(kQuestion, 1).put(one.challenge, 8).take();
}

Bytes write(const Word& one) {
  return Writer{kWordSize}.put(kWord, 1).put(static_cast<std::uint8_t>(one.state), 1).take();
}

std::optional<MediaMessage> read_media(std::span<const std::byte> bytes) noexcept {
  if (bytes.empty()) return std::nullopt;
  switch (std::to_integer<std::uint8_t>(bytes[0])) {
    case kFragment:
      return read_fragment(bytes);
    case kReport:
      return read_report(bytes);
    case kQuestion:
      if (bytes.size() != kQuestionSize) return std::nullopt;
      return Question{Reader{bytes.subspan(1)}.take<std::uint64_t>()};
    case kWord: {
      if (bytes.size() != kWordSize) return std::nullopt;
      const auto state = std::to_integer<std::uint8_t>(bytes[1]);
      if (state > kVideoStateSentMax) return std::nullopt;
      return Word{static_cast<VideoState>(state)};
    }
    default:
      return std::nullopt;
  }
}

}  // namespace palp::video
