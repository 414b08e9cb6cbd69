#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/time.h"

namespace palp::monitor {

/// What a client may do.
enum class Right : std::uint8_t { None, View, Control };

/// Drawn anew for each run: 32 hexadecimal digits. `control` empty: nobody may do more than look.
struct Tokens {
  std::string view;
  std::string control;
};

/// Whether both are the same text, in a time that tells nothing of where they differ.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view kept) noexcept;

/// The value behind "?token=" in a request's target; empty: there is none.
[[nodiscard]] std::string_view token_in(std::string_view target) noexcept;

/// Who may have what. Loopback is no border between the users of a machine, and a page of anywhere
/// may ask a browser to call this one: so the name by which a request calls this site, the page it
/// comes from and its token are looked at, each by itself. Thread: one.
class Access {
 public:
  /// `origins`: pages from elsewhere that may ask too, as a browser names them.
  Access(Tokens tokens, std::vector<std::string> origins);

  /// Of the Host header, any port: a tunnel may come from another. A name that was made to point
  /// at this machine (DNS rebinding) is none of ours.
  [[nodiscard]] static bool host_allowed(std::string_view host) noexcept;
  /// Of the Origin header; empty: no browser's page. Else the page of this very host, or a listed
  /// one.
  [[nodiscard]] bool origin_allowed(std::string_view origin, std::string_view host) const noexcept;
  /// Counts wrong ones; a right one is never locked out by a stranger's guesses.
  [[nodiscard]] Right right_of(std::string_view token, TimePoint now) noexcept;
  /// Five wrong ones within a minute: they get no answer any more.
  [[nodiscard]] bool weary(TimePoint now) const noexcept;

 private:
  static constexpr std::size_t kGuesses = 5;

  Tokens tokens_;
  std::vector<std::string> origins_;
  std::array<TimePoint, kGuesses> wrong_at_{};
  std::size_t wrong_{};
};

}  // namespace palp::monitor
