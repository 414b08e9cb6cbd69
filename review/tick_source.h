#pragma once

#include <optional>
#include <variant>

#include "common/record/session_reader.h"
#include "review/site_data.h"

namespace palp::review {

/// The ticks of a session file that lie within the session, and what was true at each tick of a
/// simulation, one by one. Holds one chunk of the file.
class TickSource {
 public:
  /// `site` outlives it.
  explicit TickSource(const SiteData& site) : site_{site}, reader_{site.bytes} {}

  using Item = std::variant<SiteTick, PlantTruth>;
  std::optional<Item> next() {
    while (const auto entry = reader_.next()) {
      if (const auto* truth = std::get_if<PlantTruth>(&entry->record)) return *truth;
      const auto* tick = std::get_if<SiteTick>(&entry->record);
      if (tick != nullptr && tick->at >= site_.from && tick->at < site_.to) return *tick;
    }
    return std::nullopt;
  }
  std::optional<SiteTick> next_tick() {
    while (const auto item = next()) {
      if (const auto* tick = std::get_if<SiteTick>(&*item)) return *tick;
    }
    return std::nullopt;
  }

 private:
  const SiteData& site_;
  record::SessionReader reader_;
};

}  // namespace palp::review
