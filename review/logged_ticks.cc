#include "review/logged_ticks.h"

#include <variant>

#include "common/record/notes.h"
#include "review/lack.h"

namespace palp::review {
namespace {

/// Said by the estimator's thread, by the lab, by the recording itself, or by who sat there.
bool of_no_tick(const record::SessionEntry& entry) {
  using palp::record::NoteCode;
  const Record& record = entry.record;
  if (const auto* note = std::get_if<Note>(&record)) {
    return !palp::record::is_of_a_tick(static_cast<NoteCode>(note->code));
  }
  return std::holds_alternative<DepthEstimate>(record) ||
         std::holds_alternative<MapEstimate>(record) ||
         std::holds_alternative<PlantTruth>(record) ||
         (std::holds_alternative<MapCell>(record) && entry.site == link::Role::Patient);
}

/// No site makes more in one tick; a file may hold any number.
constexpr std::size_t kTickRecordsMax = 4096;

std::uint64_t torn_in(const record::SessionReader& reader) {
  return reader.report().chunks_damaged + reader.missing() + reader.disordered();
}

}  // namespace

std::uint64_t LoggedTicks::damaged() const { return damaged_ + (reader_ ? torn_in(*reader_) : 0); }

std::optional<LoggedTick> LoggedTicks::next() {
  LoggedTick tick;
  while (const auto entry = next_entry()) {
    if (of_no_tick(*entry)) continue;
    if (const auto* status = std::get_if<LinkStatus>(&entry->record)) {
      dropped_ = status->records_dropped;
    }
    if (tick.records.size() == kTickRecordsMax) {
      tick = {};
      ++damaged_;
    }
    tick.add(entry->record);
    if (!tick.heard) continue;
    began_at_ = began_at_.value_or(tick.heard->at);
    return tick;
  }
  return std::nullopt;
}

std::uint64_t LoggedTicks::dropped_up_to_the_next_status() {
  while (const auto entry = next_entry()) {
    if (const auto* status = std::get_if<LinkStatus>(&entry->record)) {
      return dropped_ = status->records_dropped;
    }
  }
  return dropped_;
}

std::optional<record::SessionEntry> LoggedTicks::next_entry() {
  while (present_ < files_.size()) {
    if (!reader_) reader_.emplace(files_[present_]);
    if (auto entry = reader_->next()) return entry;
    damaged_ += torn_in(*reader_);
    if (lack_.empty()) lack_ = lack_of(*reader_);
    reader_.reset();
    ++present_;
  }
  return std::nullopt;
}

}  // namespace palp::review
