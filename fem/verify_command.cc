#include "fem/verify_command.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/config/report.h"

namespace palp::fem {
namespace {

using config::ExitCode;
using config::ExitStatus;

std::size_t missed(const Checks& checks) {
  return static_cast<std::size_t>(
      std::count_if(checks.begin(), checks.end(), [](const Check& c) { return !c.passed(); }));
}

}  // namespace

void declare_verify(config::CommandLine& line, VerifyFlags& flags) {
  line.toggle("--quick", flags.quick, "coarser meshes, the same laws");
  line.report(flags.report, "palp.verify/1");
}

std::string verify_table(const Checks& checks) {
  std::string text;
  char line[256];
  std::snprintf(line,
                sizeof line,
                "%-4s  %-58s  %-44s  %12s  %12s  %9s\n",
                "",
                "law",
                "quantity",
                "found",
                "wanted",
                "+-");
  text += line;
  for (const Check& check : checks) {
    std::snprintf(line,
                  sizeof line,
                  "%-4s  %-58s  %-44s  %12.6g  %12.6g  %9.2g\n",
                  check.passed() ? "ok" : "MISS",
                  check.law.c_str(),
                  check.quantity.c_str(),
                  check.found,
                  check.wanted,
                  check.tolerance);
    text += line;
  }
  return text;
}

std::string verify_report(const Checks& checks) {
  nlohmann::ordered_json out;
  out["schema"] = "palp.verify/1";
  out["count"] = checks.size();
  out["missed"] = missed(checks);
  out["checks"] = nlohmann::ordered_json::array();
  for (const Check& check : checks) {
    nlohmann::ordered_json row;
    row["law"] = check.law;
    row["quantity"] = check.quantity;
    row["found"] = check.found;
    row["wanted"] = check.wanted;
    row["tolerance"] = check.tolerance;
    row["passed"] = check.passed();
    out["checks"].push_back(row);
  }
  return out.dump(2) + "\n";
}

ExitStatus run_verify(const VerifyFlags& flags) {
  const Checks checks = verification(flags.quick ? Extent::Quick : Extent::Full);
  std::fputs(verify_table(checks).c_str(), stdout);
  if (!flags.report.empty()) {
    if (const auto written = config::write_whole_file(flags.report, verify_report(checks));
        !written) {
      return {ExitCode::CannotOpen, "palp-fem: " + written.error().text};
    }
  }
  const std::string count = std::to_string(checks.size());
  if (const std::size_t wrong = missed(checks); wrong > 0) {
    return {ExitCode::Missed,
            "palp-fem: " + std::to_string(wrong) + " of " + count + " checks missed"};
  }
  return {ExitCode::Done, "all " + count + " checks hold\n"};
}

}  // namespace palp::fem
