#include "common/io/process/diagnostics.h"

#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace palp::io {
namespace {

spdlog::string_view_t text(std::string_view sentence) { return {sentence.data(), sentence.size()}; }

}  // namespace

void start_diagnostics(std::string_view program) {
  spdlog::drop_all();
  const auto logger = spdlog::stderr_color_mt(std::string{program});
  logger->set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
  logger->set_level(spdlog::level::info);
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

void info(std::string_view sentence) { spdlog::default_logger_raw()->info(text(sentence)); }
void warn(std::string_view sentence) { spdlog::default_logger_raw()->warn(text(sentence)); }
void error(std::string_view sentence) { spdlog::default_logger_raw()->error(text(sentence)); }

}  // namespace palp::io
