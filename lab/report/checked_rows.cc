#include "lab/report/checked_rows.h"

#include "lab/run/digest.h"

namespace palp::lab {
namespace {

std::string check_of(std::string_view row) {
  Digest digest;
  for (const char one : row)
    digest.add(static_cast<std::uint64_t>(static_cast<unsigned char>(one)));
  return hexadecimal(digest.value()).substr(0, 8);
}

}  // namespace

std::string with_check(const std::string& row) { return row + ',' + check_of(row); }

bool holds_check(std::string_view row) {
  const std::size_t comma = row.rfind(',');
  return comma != std::string_view::npos && row.substr(comma + 1) == check_of(row.substr(0, comma));
}

std::string sound_rows(std::string_view text) {
  std::string sound;
  bool header = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;
    if (header || holds_check(text.substr(0, end))) sound.append(text.substr(0, end + 1));
    header = false;
    text.remove_prefix(end + 1);
  }
  return sound;
}

Result<void> check_all_there(const std::vector<std::uint64_t>& indices, std::uint64_t count) {
  if (indices.empty()) return fail("there is no case in these files");
  const auto of = [&](std::uint64_t index) {
    return "case " + std::to_string(index) + " of " + std::to_string(count);
  };
  std::uint64_t next = 0;
  for (const std::uint64_t index : indices) {
    if (index < next) return fail(of(index) + " is given twice");
    if (index >= count) return fail(of(index) + " is none of them");
    if (index > next) break;
    ++next;
  }
  if (next == count) return {};
  return fail(of(next) + " is missing: merge the cases of all shards of one plan");
}

}  // namespace palp::lab
