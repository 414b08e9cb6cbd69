// palp-fem: the finite element solver of indented phantoms as a program.
#include <string>

#include <unistd.h>

#include "common/config/command_line.h"
#include "common/config/program_run.h"
#include "common/config/submission.h"
#include "common/io/process/parallel.h"
#include "common/io/process/process_time.h"
#include "fem/curve_command.h"
#include "fem/database_command.h"
#include "fem/paper_command.h"
#include "fem/verify_command.h"

namespace palp::fem {
namespace {

int run(int argc, char** argv) {
  config::CommandLine line{"palp-fem", "Force of a round tip pressed into a block."};
  CurveFlags curve;
  declare_curve(line.verb("curve", "one force-indentation curve"), curve);
  DatabaseFlags database;
  if (::isatty(STDERR_FILENO) != 0) {
    database.wall = [] { return seconds(io::process_time().wall); };
  }
  database.for_each_index = io::for_each_index;
  declare_database(line.verb("database", "solve the depth database"), database);
  declare_merge(line.verb("merge", "put databases of one grid together"), database);
  declare_info(line.verb("info", "what a database holds"), database);
  VerifyFlags verify;
  declare_verify(line.verb("verify", "the solver against closed solutions"), verify);
  PaperFlags paper;
  declare_paper(line.verb("paper", "the paper's phantoms, hash and formula, beside ours"), paper);
  return config::run_program(line, argc, argv, [&]() -> config::ExitStatus {
    const std::string verb = line.chosen_verb();
    if (!database.submission.engine.empty()) {
      return config::submit(database.submission, argc, argv);
    }
    if (verb == "database") return run_database(database);
    if (verb == "merge") return run_merge(database);
    if (verb == "info") return run_info(database);
    if (verb == "paper") return run_paper(paper);
    if (verb == "verify") return run_verify(verify);
    return run_curve(curve);
  });
}

}  // namespace
}  // namespace palp::fem

int main(int argc, char** argv) { return palp::fem::run(argc, argv); }
