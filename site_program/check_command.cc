#include "site_program/check_command.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/host_and_port.h"
#include "common/io/secure/path_check.h"
#include "common/settings/site_settings.h"

namespace palp::site_program {

CheckCommand::CheckCommand(config::CommandLine& line, link::Role role) : role_{role} {
  config::CommandLine& verb = line.verb(
      "check", "Looks whether this machine can run a site on time, and says what to change.");
  verb.number("--seconds", seconds_, {.min = 0.1, .max = 3600, .unit = "s"}, "of an idle loop");
  verb.report(report_, "palp.check/1");
  verb.text("--identity", identity_, "FOLDER", "also whether this site's certificate is in order");
  verb.text("--through", relay_, "HOST:PORT", "also the way to the relay where both sites meet");
  if (role != link::Role::Surgeon) return;
  verb.text("--peer", peer_, "HOST:PORT", "also the way to the patient site, which runs there");
}

/// Of what the command line names besides the machine.
Result<std::vector<io::MachineFinding>> CheckCommand::beyond_the_machine() const {
  std::vector<io::MachineFinding> findings;
  if (!relay_.empty()) {
    const auto relay = parse_host_and_port(relay_, 1);
    if (!relay) return fail("--through: " + relay.error().text);
    const auto facts = io::read_relay_path(*relay);
    if (!facts) return fail_to_reach(facts.error().text);
    findings.push_back(io::judge_path(*facts, io::PathGoal::Relay));
  }
  if (identity_.empty()) {
    if (!peer_.empty()) return fail("--peer needs --identity: strangers are not answered");
    return findings;
  }
  const auto credentials = io::Credentials::read(identity_, role_);
  if (!credentials) return tl::unexpected{credentials.error()};
  findings.push_back(judge_identity(**credentials));
  if (peer_.empty()) return findings;
  const auto place = parse_host_and_port(peer_, 1);
  if (!place) return fail("--peer: " + place.error().text);
  const auto facts = io::read_path(*place, **credentials);
  if (!facts) {
    Error error = facts.error();
    error.unreachable = true;
    return tl::unexpected{error};
  }
  findings.push_back(io::judge_path(*facts));
  if (facts->round_trips.empty()) return findings;  // nobody is there to prove anything to
  const auto handshake = io::try_handshake(*place, **credentials);
  if (!handshake) return fail_to_reach(handshake.error().text);
  findings.push_back(*handshake);
  return findings;
}

ExitStatus CheckCommand::run() const {
  const settings::LoopSettings site;
  const io::LoopConfig loop{.period = site.period,
                            .spin = site.spin,
                            .priority = site.priority,
                            .lock_memory = site.lock_memory};
  const auto beyond = beyond_the_machine();
  if (!beyond) return exit_status_of(beyond.error());
  auto findings = io::judge_machine(io::read_machine(loop, from_seconds(seconds_)), loop.period);
  findings.insert(findings.end(), beyond->begin(), beyond->end());
  std::fputs(check_text(findings).c_str(), stdout);
  if (!report_.empty()) {
    const auto written = config::write_whole_file(report_, check_json(findings));
    if (!written) return exit_status_of(written.error());
  }
  const bool good = std::all_of(
      findings.begin(), findings.end(), [](const io::MachineFinding& one) { return one.good; });
  return {good ? config::ExitCode::Done : config::ExitCode::Missed, "completed", ""};
}

io::MachineFinding judge_identity(const io::Credentials& credentials) {
  const std::vector<std::string>& cautions = credentials.cautions();
  std::string advice;
  for (const std::string& one : cautions) advice += (advice.empty() ? "" : "; ") + one;
  return {"identity", credentials.name(), cautions.empty(), advice};
}

std::string check_text(const std::vector<io::MachineFinding>& findings) {
  std::string text;
  for (const io::MachineFinding& one : findings) {
    std::string what = one.what;
    what.resize(std::max<std::size_t>(what.size(), 20), ' ');
    text += std::string{one.good ? "good    " : "change  "} + what + "  " + one.found + '\n';
    if (!one.good) text += std::string(30, ' ') + "-> " + one.advice + '\n';
  }
  return text;
}

std::string check_json(const std::vector<io::MachineFinding>& findings) {
  config::Json json;
  json["schema"] = "palp.check/1";
  json["findings"] = config::Json::array();
  for (const io::MachineFinding& one : findings) {
    json["findings"].push_back(
        {{"what", one.what}, {"good", one.good}, {"found", one.found}, {"advice", one.advice}});
  }
  return json.dump(2) + "\n";
}

}  // namespace palp::site_program
