#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/core/time.h"
#include "common/io/net/detour.h"
#include "common/io/net/endpoint.h"
#include "common/io/secure/address_cookie.h"

namespace palp::io {

/// A message of type `path` (WIRE.md). Both kinds name the address that was asked.
struct PathMessage {
  using Nonce = std::array<std::byte, 8>;
  static constexpr std::size_t kSize = 1 + sizeof(Nonce) + sizeof(Endpoint::Bytes);  ///< [bytes]
  enum class Kind : std::uint8_t { Question, Answer };

  Kind kind{};
  Nonce nonce{};
  Endpoint::Bytes asked{};

  /// nullopt: another size, or another kind.
  [[nodiscard]] static std::optional<PathMessage> parse(std::span<const std::byte> content);
  /// As PlainProtection would have it, with that packet number.
  [[nodiscard]] std::vector<std::byte> framed(std::uint64_t number) const;
};

/// A question and whom to put it to.
struct PathQuestion {
  PathMessage message;
  Endpoint to;
};

/// The patient's: at which address the surgeon is. It moves to where telegrams come from that are
/// newer than all, if whoever is there answers, and only when the present address has been silent
/// for a while: somebody who copies telegrams and is faster than their sender cannot silence him.
/// If an address that was left delivers after all, it is the peer's again. Each telegram that
/// counts may draw a question to where it came from, and what is asked can be known again without
/// being kept: so nobody takes the sender's turn, from however many addresses he copies telegrams.
/// A value. Thread: io.
class Roaming {
 public:
  /// Without a telegram over the present address, before the peer is taken to have left.
  static constexpr Duration kSilence = std::chrono::milliseconds{50};
  /// Between two moves, and between two questions to an address.
  static constexpr Duration kPause = std::chrono::seconds{1};

  /// What io knows of the telegrams on rt.
  struct Straight {
    std::uint64_t newest_number{};  ///< of all that rt has taken
    TimePoint heard_at{};           ///< a telegram over the present address
  };

  /// A new session, with a peer at that address.
  void begin(const Endpoint& peer);
  /// No session any more.
  void end() { *this = Roaming{}; }
  [[nodiscard]] const Endpoint& peer() const noexcept { return peer_; }
  /// The address that was left, if the peer may still be there.
  [[nodiscard]] const Endpoint& former() const noexcept { return former_; }

  /// Whether a telegram from elsewhere tells of an address, should it prove to be authentic.
  [[nodiscard]] bool counts(std::uint64_t number,
                            const Endpoint& from,
                            const Straight& straight) const;
  /// It did. `size`: [bytes]. @returns what to ask there.
  [[nodiscard]] std::optional<PathQuestion> note(std::uint64_t number,
                                                 const Endpoint& from,
                                                 std::size_t size,
                                                 const Straight& straight,
                                                 TimePoint now);
  /// Often. The question to the first address of a session, from which the surgeon learns whether
  /// it is seen under its own address. nullopt: nothing to ask.
  [[nodiscard]] std::optional<PathQuestion> survey(TimePoint now);
  /// @returns false: nobody asked for that.
  [[nodiscard]] bool answer(const PathMessage& message, const Endpoint& from, TimePoint now);
  /// Often. @returns the peer's new address, which peer() is from now on.
  [[nodiscard]] std::optional<Endpoint> move(const Straight& straight, TimePoint now);

 private:
  static constexpr std::size_t kAskedMax = 16;    ///< addresses whose last question is remembered
  static constexpr std::size_t kAnsweredMax = 4;  ///< only keys of the session answer

  struct Asked {
    Endpoint address;
    TimePoint at{};
  };
  struct Answered {
    Endpoint address;
    TimePoint at{};
    TimePoint heard_at{};
  };

  [[nodiscard]] bool is_newest(std::uint64_t number, const Straight& straight) const;
  /// The address that was left is alive after all.
  [[nodiscard]] bool came_back(const Endpoint& address, TimePoint now) const;
  [[nodiscard]] bool may_ask(const Endpoint& address, TimePoint now);
  [[nodiscard]] PathQuestion question(const Endpoint& to, TimePoint now) const;
  [[nodiscard]] bool asked(const PathMessage& answer, const Endpoint& from, TimePoint now) const;

  AddressCookie cookie_;
  Endpoint peer_;
  Endpoint former_;
  std::optional<TimePoint> moved_at_;
  std::optional<std::uint64_t> newest_;  ///< number of the telegrams from elsewhere
  std::array<Asked, kAskedMax> asked_;   ///< the oldest is forgotten first, and may be asked again
  std::size_t asked_next_{};
  std::array<Answered, kAnsweredMax> answered_;
  int surveys_left_{};
  TimePoint survey_at_{};
};

/// The surgeon's: which questions it answers. Only those that come from the patient's address, and,
/// once it has been seen under its own address, only those put to that address. A value. Thread:
/// io.
class PathAnswers {
 public:
  /// The site's own address on the way to the peer, as the kernel has it.
  void set_own(const Endpoint& own) { own_ = own; }
  /// nullopt: not answered.
  [[nodiscard]] std::optional<PathMessage> answer(const PathMessage& question,
                                                  const Endpoint& from,
                                                  const Endpoint& peer);

 private:
  Endpoint own_;
  Endpoint seen_as_;  ///< an address of our own that the patient has seen us under
};

}  // namespace palp::io
