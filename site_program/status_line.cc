#include "site_program/status_line.h"

#include <cstdio>

#include "common/io/process/diagnostics.h"
#include "common/io/process/terminal.h"

namespace palp::site_program {
namespace {

constexpr Duration kPlainEvery = std::chrono::seconds{2};

void print(std::string_view text) { (void)std::fwrite(text.data(), 1, text.size(), stdout); }

}  // namespace

StatusLine::StatusLine() : over_itself_{io::Terminal::output_is_terminal()} {}
StatusLine::~StatusLine() { end(); }

void StatusLine::show(std::string_view text, TimePoint now) {
  if (over_itself_) {
    // A line that wraps could not be written over.
    const std::size_t columns = io::Terminal::output_columns();
    print("\r");
    print(columns > 1 ? text.substr(0, columns - 1) : text);
    print("\x1b[K");  // clears what is left of a longer one
    open_ = true;
  } else {
    if (printed_at_ && now - *printed_at_ < kPlainEvery) return;
    printed_at_ = now;
    print(text);
    print("\n");
  }
  (void)std::fflush(stdout);
}

std::size_t StatusLine::room_behind(std::string_view before) const {
  const std::size_t columns = over_itself_ ? io::Terminal::output_columns() : 0;
  if (columns <= 1) return 0;
  return columns > before.size() + 2 ? columns - 1 - before.size() : 1;
}

void StatusLine::info(std::string_view sentence) {
  end();
  io::info(sentence);
}

void StatusLine::warn(std::string_view sentence) {
  end();
  io::warn(sentence);
}

void StatusLine::end() {
  if (!open_) return;
  open_ = false;
  print("\n");
  (void)std::fflush(stdout);
}

}  // namespace palp::site_program
