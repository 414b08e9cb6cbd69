#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "video/parity.h"

/// The messages of type `media` (proto/WIRE.md), inside their protection. Big-endian. Pure; any
/// bytes may come in.
namespace palp::video {

/// Of a fragment's data; with header, tag, UDP and IP below any path's limit.
inline constexpr std::size_t kFragmentDataMax = 1100;  ///< [bytes]
inline constexpr std::size_t kDataFragmentsMax = 96;
inline constexpr std::size_t kFrameSizeMax = kDataFragmentsMax * kFragmentDataMax;  ///< [bytes]

/// A part of a frame, patient to surgeon.
struct Fragment {
  bool jpeg{};                        ///< else H.264
  bool key{};                         ///< the frame refers to none: decoding may begin here
  std::uint32_t frame{};              ///< from 0 with each session
  std::uint16_t refers_back{};        ///< to the frame so many before; 0: a key frame
  std::uint64_t captured_ns{};        ///< since the sender's session began
  std::uint32_t size{};               ///< [bytes] of the frame, 1 to kFrameSizeMax
  std::uint8_t data_count{};          ///< k, 1 to kDataFragmentsMax
  std::uint8_t parity_count{};        ///< m; k + m <= kFragmentsMax
  std::uint8_t index{};               ///< data first
  std::uint16_t offset_us{};          ///< from the frame's first fragment to this one, as sent
  std::span<const std::byte> data{};  ///< ceil(size / k) bytes
};

/// What the surgeon's site says of what it got, 30 times a second.
struct Report {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  bool wants_recovery{};  ///< a frame came whose reference did not
  bool wants_key{};       ///< somebody begins to look
  bool unwatched{};       ///< nobody looks or records: send nothing
  std::uint32_t newest_delivered{kNone};
  std::uint32_t delivered_before{};  ///< bit i: the frame newest_delivered - i
  std::int16_t standing_10us{};      ///< standing delay of the force telegrams
  std::uint16_t lost{};              ///< share of the last 2 s, in 1/65535
  std::uint16_t span_ratio{256};     ///< of a frame on arrival and as sent, in 1/256
  std::uint32_t rate_kbps{};         ///< [kbit/s] seen in a frame
  std::uint8_t fragments_lost{};     ///< of a frame, 99.5 % quantile of late
  std::uint64_t echo{};              ///< of a question; 0: none
};

/// The patient's site asks an address whether the surgeon's is there.
struct Question {
  std::uint64_t challenge{};
};

/// Why no picture comes, or that it does.
enum class VideoState : std::uint8_t {
  Sending,
  PathFull,   ///< the path carries force only
  NoCamera,   ///< there is none, or it was unplugged
  NoEncoder,  ///< neither H.264 nor JPEG can be had
  Silent,     ///< surgeon's own: nothing has come for long
};
inline constexpr std::uint8_t kVideoStateSentMax = 3;
/// For people, without a full stop.
[[nodiscard]] std::string_view to_string(VideoState state) noexcept;

struct Word {
  VideoState state{};
};

using MediaMessage = std::variant<Fragment, Report, Question, Word>;

[[nodiscard]] Bytes write(const Fragment& fragment);
[[nodiscard]] Bytes write(const Report& report);
[[nodiscard]] Bytes write(const Question& question);
[[nodiscard]] Bytes write(const Word& word);

/// nullopt: breaks a rule of form. A fragment's data lies in `bytes`.
[[nodiscard]] std::optional<MediaMessage> read_media(std::span<const std::byte> bytes) noexcept;

}  // namespace palp::video
