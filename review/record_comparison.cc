#include "review/record_comparison.h"

#include <algorithm>
#include <cstdint>

#include "common/core/number_text.h"
#include "review/record_numbers.h"

namespace palp::review {
namespace {

using Sorted = std::vector<const Record*>;

/// A tick's own message stands behind the others of its instant, and begins with the sample.
int order_of(const Record* one) {
  if (std::holds_alternative<Arrived>(*one)) return 0;
  if (std::holds_alternative<SiteTick>(*one)) return 2;
  const bool reading = std::holds_alternative<HandReading>(*one) ||
                       std::holds_alternative<StageReading>(*one) ||
                       std::holds_alternative<ForceReading>(*one);
  return reading || std::holds_alternative<LinkHeard>(*one) ? 3 : 1;
}

/// However a file tells them: as messages of their own, or within the tick.
Sorted sorted(const std::vector<Record>& records) {
  Sorted list;
  list.reserve(records.size());
  for (const Record& record : records) list.push_back(&record);
  std::stable_sort(list.begin(), list.end(), [](const Record* a, const Record* b) {
    return order_of(a) < order_of(b);
  });
  return list;
}

}  // namespace

RecordComparison::RecordComparison(link::Role site) : site_{site}, encoder_{site} {
  for (const record::TopicFormat& format : record::topics_of(site)) {
    names_[static_cast<std::size_t>(format.topic)] = format.name;
  }
}

std::string RecordComparison::compare(const std::vector<Record>& logged_records,
                                      const std::vector<Record>& again_records,
                                      TimePoint began_at) {
  const Sorted logged = sorted(logged_records);
  const Sorted again = sorted(again_records);
  const auto place = [&](const Encoded& of) {
    return of.topic + number_text(", ", seconds(elapsed(began_at, of.at)), 6, " s, ");
  };
  for (std::size_t i = 0; i < std::min(logged.size(), again.size()); ++i) {
    const Encoded there = encoded(*logged[i]);
    if (there.bytes == encoded(*again[i]).bytes) continue;
    return place(there) + field_of(*logged[i], *again[i]);
  }
  if (logged.size() == again.size()) return {};
  if (logged.size() > again.size()) {
    return place(encoded(*logged[again.size()])) + "the whole record: it did not come again";
  }
  return place(encoded(*again[logged.size()])) + "the whole record: the file has none";
}

RecordComparison::Encoded RecordComparison::encoded(const Record& record) {
  const auto prepared = encoder_.prepare(record, 0);
  if (!prepared) return {};
  Encoded of{.topic = names_[static_cast<std::size_t>(prepared->topic)],
             .at = prepared->at,
             .bytes = std::vector<std::byte>(prepared->size)};
  encoder_.store(of.bytes.data());
  of.bytes.push_back(static_cast<std::byte>(prepared->topic));
  const auto at = static_cast<std::uint64_t>(prepared->at.time_since_epoch().count());
  for (unsigned shift = 0; shift < 64; shift += 8) {
    of.bytes.push_back(static_cast<std::byte>(at >> shift & 0xFFU));
  }
  return of;
}

std::string RecordComparison::field_of(const Record& logged, const Record& again) const {
  if (logged.index() != again.index()) {
    return std::string{"the whole record: it became '"} + kRecordNames[again.index()] + "'";
  }
  const NamedNumbers there = numbers_of(logged, site_);
  const NamedNumbers here = numbers_of(again, site_);
  for (std::size_t i = 0; i < std::min(there.size(), here.size()); ++i) {
    if (there[i] == here[i]) continue;
    const std::string other = there[i].name == here[i].name ? "" : here[i].name + " ";
    return there[i].name + ": " + there[i].text() + " became " + other + here[i].text();
  }
  return "the payload: it became another one";
}

}  // namespace palp::review
