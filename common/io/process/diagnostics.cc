#include "common/io/process/diagnostics.h"

#include <cstdlib>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "common/core/printable.h"

namespace palp::io {
namespace {

/// Parts of a sentence come from the peer, its certificate or a file: none may act on the terminal
/// or look like a sentence of its own.
void say(spdlog::level::level_enum level, std::string_view sentence) {
  const std::string line = harmless_line(sentence);
  spdlog::default_logger_raw()->log(level, spdlog::string_view_t{line.data(), line.size()});
}

/// https://no-color.org: a terminal gets colours unless this is set to anything.
spdlog::color_mode colours() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): before any thread
  const char* const unwanted = std::getenv("NO_COLOR");
  const bool given = unwanted != nullptr && *unwanted != '\0';
  return given ? spdlog::color_mode::never : spdlog::color_mode::automatic;
}

}  // namespace

void start_diagnostics(std::string_view program) {
  spdlog::drop_all();
  const auto logger = spdlog::stderr_color_mt(std::string{program}, colours());
  logger->set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
  logger->set_level(spdlog::level::info);
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

void info(std::string_view sentence) { say(spdlog::level::info, sentence); }
void warn(std::string_view sentence) { say(spdlog::level::warn, sentence); }
void error(std::string_view sentence) { say(spdlog::level::err, sentence); }

}  // namespace palp::io
