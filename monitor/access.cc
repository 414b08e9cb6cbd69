#include "monitor/access.h"

#include <algorithm>
#include <utility>

namespace palp::monitor {
namespace {

constexpr Duration kGuessingTime = std::chrono::minutes{1};
constexpr std::array<std::string_view, 3> kOwnNames{"127.0.0.1", "localhost", "[::1]"};
constexpr std::size_t kPortDigitsMax = 5;

bool is_port(std::string_view text) noexcept {
  return !text.empty() && text.size() <= kPortDigitsMax &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool same_secret(std::string_view given, std::string_view kept) noexcept {
  if (kept.empty()) return false;
  unsigned differences = given.size() == kept.size() ? 0 : 1;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const char other = i < given.size() ? given[i] : '\0';
    differences |= static_cast<unsigned>(static_cast<unsigned char>(kept[i])) ^
                   static_cast<unsigned>(static_cast<unsigned char>(other));
  }
  return differences == 0;
}

std::string_view token_in(std::string_view target) noexcept {
  constexpr std::string_view kName = "token=";
  const auto query = target.find('?');
  if (query == target.npos) return {};
  std::string_view rest = target.substr(query + 1);
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find('&'));
    if (one.starts_with(kName)) return one.substr(kName.size());
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
  }
  return {};
}

Access::Access(Tokens tokens, std::vector<std::string> origins)
    : tokens_{std::move(tokens)}, origins_{std::move(origins)} {}

bool Access::host_allowed(std::string_view host) noexcept {
  return std::ranges::any_of(kOwnNames, [host](std::string_view name) {
    if (!host.starts_with(name)) return false;
    const std::string_view rest = host.substr(name.size());
    return rest.empty() || (rest.front() == ':' && is_port(rest.substr(1)));
  });
}

bool Access::origin_allowed(std::string_view origin, std::string_view host) const noexcept {
  constexpr std::string_view kScheme = "http://";
  if (origin.empty()) return true;
  if (origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host) return true;
  return std::ranges::find(origins_, origin) != origins_.end();
}

Right Access::right_of(std::string_view token, TimePoint now) noexcept {
  // Both are looked at, whatever the first says.
  const bool control = same_secret(token, tokens_.control);
  const bool view = same_secret(token, tokens_.view);
  if (control) return Right::Control;
  if (view) return Right::View;
  wrong_at_[wrong_++ % kGuesses] = now;
  return Right::None;
}

bool Access::weary(TimePoint now) const noexcept {
  return wrong_ > kGuesses && now - wrong_at_[wrong_ % kGuesses] < kGuessingTime;
}

}  // namespace palp::monitor
