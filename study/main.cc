/// palp-study: what observers tell apart.

#include "common/config/command_line.h"
#include "common/config/program_run.h"
#include "common/io/process/parallel.h"
#include "study/fit_command.h"
#include "study/simulate_command.h"

int main(int argc, char** argv) {
  palp::config::CommandLine line{
      "palp-study", "Just noticeable differences: methods tried on known observers, fits."};
  palp::study::SimulateFlags simulate;
  declare_simulate(line.verb("simulate", "does a method find a known truth?"), simulate);
  palp::study::FitFlags fit;
  declare_fit(line.verb("fit", "JND and bias from a table of trials"), fit);
  palp::study::PowerFlags power;
  declare_power(line.verb("power", "how many participants a comparison needs"), power);
  return palp::config::run_program(line, argc, argv, [&]() -> palp::config::ExitStatus {
    const std::string verb = line.chosen_verb();
    if (verb == "fit") return run_fit(fit);
    if (verb == "power") return run_power(power);
    return run_simulate(simulate, [](std::size_t count, const auto& work) {
      palp::io::for_each_index(count, palp::io::processors(), work);
    });
  });
}
