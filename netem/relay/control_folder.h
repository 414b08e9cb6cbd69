#pragma once

#include <string>

#include "common/core/result.h"
#include "common/io/process/descriptor.h"
#include "netem/syntax/impairment_text.h"

namespace palp::netem {

/// The one folder whose files live control may name. It is opened once and everything is found from
/// there: no name, no "..", no symbolic link leads out of it. Thread: any one.
class ControlFolder {
 public:
  /// No folder: only the tables and traces that come with the programs can be named.
  ControlFolder() = default;
  /// @returns or the sentence that says why the folder cannot be opened (unreachable).
  [[nodiscard]] static Result<ControlFolder> open(const std::string& path);

  /// The content of a regular file of at most 64 MiB in the folder, or of one that comes with the
  /// programs. Never waits for a device or a pipe.
  [[nodiscard]] Result<std::string> read(const std::string& name) const;
  /// A new file in the folder, for its owner to read and write; what is there already is refused.
  [[nodiscard]] Result<io::Descriptor> create(const std::string& name) const;
  /// read(), for the words of an impairment; this object outlives it.
  [[nodiscard]] FileReader reader() const;

 private:
  [[nodiscard]] Result<io::Descriptor> open_below(const std::string& name, int flags) const;

  io::Descriptor folder_;
  std::string path_;  ///< absolute; empty: no folder
};

}  // namespace palp::netem
