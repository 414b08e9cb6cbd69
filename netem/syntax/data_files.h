#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"

/// Where the traces, histograms and tables lie that words name. Not for a control thread.
namespace palp::netem {

/// The content of the file of that name: a path, else a trace that comes with the programs, else
/// (names that end in .dist) a table of tc as the Debian package iproute2 installs it. At most 64
/// MiB.
[[nodiscard]] Result<std::string> read_data_file(const std::string& name);

/// The folders that are searched, in this order.
[[nodiscard]] std::vector<std::string> data_folders();

}  // namespace palp::netem
