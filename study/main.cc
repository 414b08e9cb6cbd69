/// palp-study: what observers tell apart.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "common/config/command_line.h"
#include "common/config/program_run.h"
#include "common/io/process/entropy.h"
#include "common/io/process/parallel.h"
#include "site_program/build_info.h"
#include "study/closed_loop/contrast_command.h"
#include "study/closed_loop/felt_observer.h"
#include "study/closed_loop/foretell_command.h"
#include "study/compare_command.h"
#include "study/data_set.h"
#include "study/fit_command.h"
#include "study/keep_command.h"
#include "study/plan_command.h"
#include "study/real_sites/person.h"
#include "study/report_command.h"
#include "study/run_command.h"
#include "study/simulate_command.h"

namespace palp::study {
namespace {

using config::ExitStatus;

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  io::for_each_index(count, io::processors(), work);
}

/// The folder of this program, where its sisters lie.
std::string own_folder() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path().string();
}

PersonSetting person_setting(const RunFlags& flags,
                             const std::function<void(const std::string&)>& say) {
  return {.programs = own_folder(),
          .data = {flags.folder},
          .hand = {.master = flags.hand.master,
                   .devices = flags.hand.devices,
                   .monitor_port = static_cast<std::uint16_t>(flags.hand.monitor_port)},
          .say = say};
}

ExitStatus run(const RunFlags& flags) {
  std::mutex one_line;
  const auto say = [&](const std::string& line) {
    const std::lock_guard lock{one_line};
    (void)std::fputs(line.c_str(), stdout);
    (void)std::fflush(stdout);
  };
  std::optional<FeltParticipants> felt;
  std::unique_ptr<Person> person;
  return run_run(
      flags,
      [&](const Study& study) -> Result<Observer> {
        if (flags.observer == kPerson) {
          auto made = Person::make(study, person_setting(flags, say));
          if (!made) return tl::unexpected(made.error());
          person = std::move(*made);
          return [&person](const TrialPlace& place, const TrialAsk& ask) {
            return person->answer(place, ask);
          };
        }
        if (flags.observer != "felt") return formula_participants(study, flags.people);
        auto made = FeltParticipants::make(study, flags.people);
        if (!made) return tl::unexpected(made.error());
        felt = std::move(*made);
        return [&felt](const TrialPlace& place, const TrialAsk& ask) {
          return felt->answer(place, ask);
        };
      },
      for_each_index,
      say);
}

int run_program(int argc, char** argv) {
  config::CommandLine line{
      "palp-study", "Just noticeable differences: studies planned, simulated, fitted, reported."};
  PlanFlags plan;
  declare_plan(line.verb("plan", "schedule and pre-registration of a study"), plan);
  RunFlags run_flags;
  declare_run(line.verb("run", "simulated participants go through a study"), run_flags);
  SimulateFlags simulate;
  declare_simulate(line.verb("simulate", "does a method find a known truth?"), simulate);
  ForetellFlags foretold;
  declare_foretell(line.verb("foretell", "what a study's conditions will do to JND and bias"),
                   foretold);
  ContrastFlags contrast;
  declare_contrast(line.verb("contrast", "how much stiffer balls make tissue, by depth"), contrast);
  FitFlags fit;
  declare_fit(line.verb("fit", "JND and bias from a table of trials, or of a study"), fit);
  std::string compared;
  declare_compare(line.verb("compare", "do a study's conditions differ?"), compared);
  StudyReportFlags report;
  declare_report(line.verb("report", "a study as one page of HTML"), report);
  KeepFlags exported;
  declare_export(line.verb("export", "a study's answers for other tools"), exported);
  KeepFlags checked;
  declare_check(line.verb("check", "is a study as it was registered?"), checked);
  KeepFlags withdrawn;
  declare_withdraw(line.verb("withdraw", "deletes a participant"), withdrawn);
  PowerFlags power;
  declare_power(line.verb("power", "how many participants a comparison needs"), power);
  const std::string made_by =
      std::string{site_program::version()} + ", commit " + std::string{site_program::git_commit()};
  const auto body = [&]() -> config::ExitStatus {
    const std::string verb = line.chosen_verb();
    if (verb == "plan") return run_plan(plan, made_by, io::draw_entropy);
    if (verb == "run") return run(run_flags);
    if (verb == "foretell") return run_foretell(foretold, for_each_index);
    if (verb == "contrast") return run_contrast(contrast);
    if (verb == "fit") return run_fit(fit);
    if (verb == "compare") return run_compare(compared);
    if (verb == "report") return run_report(report);
    if (verb == "export") return run_export(exported);
    if (verb == "check") return run_check(checked);
    if (verb == "withdraw") return run_withdraw(withdrawn);
    if (verb == "power") return run_power(power);
    return run_simulate(simulate, for_each_index);
  };
  return config::run_program(line, argc, argv, body, beside_studies);
}

}  // namespace
}  // namespace palp::study

int main(int argc, char** argv) { return palp::study::run_program(argc, argv); }
