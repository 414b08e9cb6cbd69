#include "lab/partial_rows.h"

#include <filesystem>

#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "lab/report/checked_rows.h"

namespace palp::lab {
namespace {

constexpr std::size_t kPartialSizeMax = std::size_t{1} << 30;  // [bytes], as of a cases file

constexpr const char* kPartialEnding = ".partial";

}  // namespace

Result<PartialRows> PartialRows::open(const std::string& path, bool resume) {
  namespace fs = std::filesystem;
  PartialRows rows;
  std::error_code ignored;
  const bool elsewhere = fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
  if (path.empty() || elsewhere) {
    if (resume) return fail("--resume needs the file that --cases names");
    return rows;
  }
  rows.name_ = path + kPartialEnding;
  if (!resume) return rows;
  if (const auto text = read_whole_file(rows.name_, kPartialSizeMax)) {
    rows.before_ = sound_rows(*text);
  }
  return rows;
}

Result<void> PartialRows::begin(const std::string& header) {
  if (name_.empty()) return {};
  auto written = config::write_whole_file(name_, before_.empty() ? header : before_);
  if (!written) return written;
  file_.reset(std::fopen(name_.c_str(), "a"));
  if (!file_) return fail_to_reach("cannot write " + name_);
  return {};
}

void PartialRows::add(const std::string& row) {
  if (!file_) return;
  (void)std::fputs(row.c_str(), file_.get());
  (void)std::fflush(file_.get());
}

void remove_partial_rows(const std::string& path) {
  std::error_code ignored;
  if (!path.empty()) std::filesystem::remove(path + kPartialEnding, ignored);
}

}  // namespace palp::lab
