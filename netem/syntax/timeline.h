#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "netem/model/path_plan.h"
#include "netem/syntax/data_files.h"

namespace palp::netem {

/// A timeline as read: the message Timeline of proto/timeline.proto, understood.
struct Timeline {
  std::string means;
  std::vector<std::string> sources;
  Mode mode{Mode::Exact};
  std::optional<std::uint64_t> seed;
  std::string preset;
  PathPlan up;
  PathPlan down;
};

/// Finds the text of a preset by its name.
using PresetFinder = std::function<Result<Timeline>(const std::string& name)>;

/// Reads text format. The sentence of a refusal begins "NAME:LINE:COLUMN: ".
[[nodiscard]] Result<Timeline> parse_timeline(std::string_view name,
                                              std::string_view text,
                                              const PresetFinder& find_preset,
                                              const FileReader& read = read_data_file);

/// One line of live control.
struct ControlRequest {
  enum class Kind : std::uint8_t { Change, Stats, Quit, Record };
  Kind kind{Kind::Change};
  bool up{true};
  bool down{true};
  bool now{true};        ///< the change has no time of its own
  bool stands_on_law{};  ///< the change keeps part of the law: it is to be read when it is due
  Change change_up{};
  Change change_down{};
  std::string prefix;  ///< of a recording
};

/// What the relay does now, for requests that change a part of it; each direction has its mode.
struct ControlContext {
  Impairment up{};
  Impairment down{};
};

/// Reads one JSON object: a TimelineEvent. The change of a direction that is not asked is empty.
[[nodiscard]] Result<ControlRequest> parse_control_line(std::string_view line,
                                                        const ControlContext& context,
                                                        const FileReader& read = read_data_file);

}  // namespace palp::netem
