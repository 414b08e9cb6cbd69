#include "tests/system/session_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <variant>

#include <gtest/gtest.h>

#include "common/record/mapped_file.h"
#include "common/record/session_reader.h"

namespace palp::system_test {

SessionFile read_session(const std::string& path) {
  SessionFile session;
  const auto file = record::MappedFile::open(path);
  if (!file) {
    ADD_FAILURE() << file.error().text;
    return session;
  }
  record::SessionReader reader{file->bytes()};
  while (const auto entry = reader.next()) {
    if (const auto* tick = std::get_if<SiteTick>(&entry->record)) {
      session.ticks.push_back(*tick);
    } else if (const auto* change = std::get_if<Transition>(&entry->record)) {
      session.transitions.push_back(*change);
    } else if (const auto* arrived = std::get_if<Arrived>(&entry->record)) {
      session.arrivals.push_back(arrived->incoming.arrived_at);
    }
  }
  for (const auto& [name, topic] : reader.topics()) session.messages += topic.messages;
  session.closed = reader.report().closed;
  return session;
}

std::optional<TimePoint> change_to(const SessionFile& file, SiteState state, TimePoint since) {
  const auto found = std::ranges::find_if(file.transitions, [&](const Transition& change) {
    return change.to == state && change.at >= since;
  });
  if (found == file.transitions.end()) return std::nullopt;
  return found->at;
}

TimePoint last_arrival_before(const SessionFile& file, TimePoint instant) {
  TimePoint last{};
  for (const TimePoint at : file.arrivals) {
    if (at < instant) last = std::max(last, at);
  }
  return last;
}

ForceStep largest_force_step(const SessionFile& file, Duration span) {
  ForceStep largest;
  std::size_t oldest = 0;
  for (std::size_t newest = 0; newest < file.ticks.size(); ++newest) {
    const SiteTick& tick = file.ticks[newest];
    while (tick.at - file.ticks[oldest].at > span) ++oldest;
    for (std::size_t other = oldest; other < newest; ++other) {
      const double step = std::abs(tick.command - file.ticks[other].command);
      if (step > largest.force) largest = {step, tick.at, tick.state};
    }
  }
  return largest;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file{path};
  file << text;
  ASSERT_TRUE(file.flush()) << path;
}

}  // namespace palp::system_test
