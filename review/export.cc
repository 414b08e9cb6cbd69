#include "review/export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "common/core/printable.h"
#include "common/record/session_encoder.h"
#include "common/record/session_reader.h"
#include "review/lack.h"
#include "review/record_numbers.h"
#include "review/text.h"

namespace palp::review {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
};
using OutFile = std::unique_ptr<std::FILE, CloseFile>;

/// Over the entries of a file's topics in the interval.
class Selection {
 public:
  Selection(const record::FileBytes& file, const ExportAsk& ask) : file_{file}, ask_{ask} {}

  /// act(topic, record, instant, stamp) for each. @returns what the file lacks there.
  std::string for_each(const auto& act) const {
    record::SessionReader reader{file_};
    std::optional<TimePoint> began;
    std::map<link::Role, record::SessionEncoder> encoders;
    while (const auto entry = reader.next()) {
      auto& encoder = encoders.try_emplace(entry->site, entry->site).first->second;
      const auto prepared = encoder.prepare(entry->record, 0);
      if (!prepared) continue;
      if (!began) {
        began = reader.began_at();
        if (ask_.from > 0 || ask_.to) look_only_between(reader, *began);
      }
      const double t = seconds(elapsed(*began, prepared->at));
      if (t < ask_.from || (ask_.to && t >= *ask_.to)) continue;
      const std::string& topic = name(entry->site, prepared->topic);
      if (std::ranges::find(ask_.topics, topic) == ask_.topics.end()) continue;
      act(topic, *entry, t, reader.clock().stamp(prepared->at));
    }
    return lack_of(reader);
  }

 private:
  /// What lies outside of the interval need not be unpacked.
  void look_only_between(record::SessionReader& reader, TimePoint began) const {
    constexpr double kLongest = 1e9;      // [s]
    const auto instant = [&](double t) {  // a file may begin at any time
      return TimePoint{elapsed(TimePoint{-from_seconds(std::clamp(t, 0.0, kLongest))}, began)};
    };
    reader.only_between(instant(ask_.from), instant(ask_.to.value_or(kLongest)));
  }
  [[nodiscard]] const std::string& name(link::Role site, record::Topic topic) const {
    static const std::array<std::vector<record::TopicFormat>, 2> all{
        record::topics_of(link::Role::Surgeon), record::topics_of(link::Role::Patient)};
    const auto& topics = all[site == link::Role::Patient ? 1 : 0];
    return std::ranges::find(topics, topic, &record::TopicFormat::topic)->name;
  }

  record::FileBytes file_;
  const ExportAsk& ask_;
};

/// The columns of a topic: the fields of all its messages, in the order in which they first came.
struct Columns {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> places;
  std::uint64_t rows{};

  void see(const NamedNumbers& numbers) {
    for (const NamedNumber& number : numbers) {
      if (number.name == "at_ns" || !places.try_emplace(number.name, names.size()).second) continue;
      names.push_back(number.name);
    }
    ++rows;
  }
};

struct Survey {
  std::map<std::string, Columns> topics;  ///< with what they have in the file
  std::string lack;
};

Survey survey(const Selection& selection) {
  Survey found;
  found.lack = selection.for_each(
      [&](const std::string& topic, const record::SessionEntry& entry, double, auto) {
        found.topics[topic].see(numbers_of(entry.record, entry.site));
      });
  return found;
}

std::uint64_t write_csv(const Selection& selection, const Columns& columns, std::FILE* out) {
  std::string line{"t_s,stamp_ns"};
  for (const std::string& name : columns.names) line += ',' + name;
  line += '\n';
  (void)std::fputs(line.c_str(), out);
  std::vector<std::string> cells(columns.names.size());
  std::uint64_t rows = 0;
  (void)selection.for_each(
      [&](const std::string&, const record::SessionEntry& entry, double t, std::uint64_t stamp) {
        std::ranges::fill(cells, std::string{});
        for (const NamedNumber& number : numbers_of(entry.record, entry.site)) {
          const auto place = columns.places.find(number.name);
          if (place != columns.places.end() && number.name != "at_ns") {
            cells[place->second] = number.text();
          }
        }
        line = fixed(t, 9) + ',' + std::to_string(stamp);
        for (const std::string& cell : cells) line += ',' + cell;
        line += '\n';
        (void)std::fputs(line.c_str(), out);
        ++rows;
      });
  return rows;
}

/// One column vector of a MAT-file of level 4, filled in pieces where its rows lie.
class MatColumn {
 public:
  static constexpr std::size_t kPiece = 1024;  ///< [rows]

  MatColumn(std::FILE* out, const std::string& name, std::uint64_t rows, std::uint64_t& end)
      : out_{out} {
    const std::array<std::int32_t, 5> head{0,  // little-endian doubles
                                           static_cast<std::int32_t>(rows),
                                           1,
                                           0,
                                           static_cast<std::int32_t>(name.size() + 1)};
    (void)std::fseek(out_, static_cast<long>(end), SEEK_SET);
    (void)std::fwrite(head.data(), sizeof(std::int32_t), head.size(), out_);
    (void)std::fwrite(name.c_str(), 1, name.size() + 1, out_);
    next_ = end + sizeof(head) + name.size() + 1;
    end = next_ + rows * sizeof(double);
    piece_.reserve(kPiece);
  }
  void add(double value) {
    piece_.push_back(value);
    if (piece_.size() == kPiece) flush();
  }
  void flush() {
    (void)std::fseek(out_, static_cast<long>(next_), SEEK_SET);
    (void)std::fwrite(piece_.data(), sizeof(double), piece_.size(), out_);
    next_ += piece_.size() * sizeof(double);
    piece_.clear();
  }

 private:
  std::FILE* out_;
  std::uint64_t next_{};  ///< [bytes], where the next piece goes
  std::vector<double> piece_;
};

std::string variable_of(const std::string& topic, const std::string& column) {
  std::string name = topic + '_' + column;
  std::ranges::replace(name, '/', '_');
  return name.substr(0, 63);  // what MATLAB reads of a name
}

std::uint64_t write_mat(const Selection& selection, const Survey& found, std::FILE* out) {
  std::uint64_t end = 0;
  std::map<std::string, std::vector<MatColumn>> files;
  for (const auto& [topic, columns] : found.topics) {
    std::vector<MatColumn>& list = files[topic];
    for (const char* name : {"t_s", "utc_s"}) {
      list.emplace_back(out, variable_of(topic, name), columns.rows, end);
    }
    for (const std::string& name : columns.names) {
      list.emplace_back(out, variable_of(topic, name), columns.rows, end);
    }
  }
  std::uint64_t rows = 0;
  std::vector<double> values;
  (void)selection.for_each([&](const std::string& topic,
                               const record::SessionEntry& entry,
                               double t,
                               std::uint64_t stamp) {
    const Columns& columns = found.topics.at(topic);
    values.assign(columns.names.size(), std::nan(""));
    for (const NamedNumber& number : numbers_of(entry.record, entry.site)) {
      const auto place = columns.places.find(number.name);
      if (place != columns.places.end()) values[place->second] = number.number();
    }
    std::vector<MatColumn>& list = files.at(topic);
    list[0].add(t);
    list[1].add(1e-9 * static_cast<double>(stamp));
    for (std::size_t i = 0; i < values.size(); ++i) list[2 + i].add(values[i]);
    ++rows;
  });
  for (auto& [topic, list] : files) {
    for (MatColumn& column : list) column.flush();
  }
  return rows;
}

Result<void> check_topics(const Survey& found, const ExportAsk& ask) {
  if (ask.format == ExportFormat::Csv && ask.topics.size() != 1) {
    return fail("a CSV file holds one topic; --format mat holds several");
  }
  for (const std::string& topic : ask.topics) {
    const auto one = found.topics.find(topic);
    if (one == found.topics.end()) {
      return fail("topic " + printable(topic) + " has no message there; palp-review info lists " +
                  "the file's topics");
    }
    if (one->second.rows > 100'000'000) {
      return fail("topic " + printable(topic) + " has more than 100 million messages; choose an " +
                  "interval with --from and --to");
    }
  }
  return {};
}

}  // namespace

Result<Exported> export_file(const record::FileBytes& file,
                             const ExportAsk& ask,
                             const std::string& path) {
  const Selection selection{file, ask};
  const Survey found = survey(selection);
  if (const auto fine = check_topics(found, ask); !fine) return tl::unexpected(fine.error());
  const OutFile out{std::fopen(path.c_str(), "wbx")};  // never over an existing file
  if (!out) return fail_to_reach(path + " cannot be made, or is there already");
  const std::uint64_t rows = ask.format == ExportFormat::Csv
                                 ? write_csv(selection, found.topics.begin()->second, out.get())
                                 : write_mat(selection, found, out.get());
  if (std::fflush(out.get()) != 0 || std::ferror(out.get()) != 0) {
    return fail_to_reach(path + " could not be written whole: is the disk full?");
  }
  return Exported{.messages = rows, .lack = found.lack};
}

}  // namespace palp::review
