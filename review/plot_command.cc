#include "review/plot_command.h"

#include "review/session_figure.h"
#include "review/session_metrics.h"
#include "review/time_line.h"

namespace palp::review {

void declare_plot(config::CommandLine& line, PlotFlags& flags) {
  line.text("--surgeon", flags.sessions.surgeon, "FILE", "session file of the surgeon's site");
  line.required();
  line.text("--patient", flags.sessions.patient, "FILE", "session file of the patient's site");
  line.required();
  plot::declare_picture(line, flags.picture, "a picture; written over");
  const config::NumberRange span{.min = 0, .max = 1e9, .unit = "s"};
  line.number("--from", flags.from, span, "since the session began");
  line.number("--to", flags.to, span, "since the session began; it is left out");
}

config::ExitStatus run_plot(const PlotFlags& flags) {
  using config::ExitCode;
  const auto refused = [](const Error& error) { return config::refusal("palp-review", error); };
  if (!flags.picture.asked()) return refused({"plot needs --svg or --pdf"});
  if (const auto can = plot::can_write_picture(flags.picture); !can) {
    return {ExitCode::CannotOpen, "palp-review: " + can.error().text};
  }
  const auto session = load_pair(flags.sessions.surgeon, flags.sessions.patient);
  if (!session) return refused(session.error());
  const auto tissue = tissue_of(session->patient, flags.sessions.patient);
  if (!tissue) return refused(tissue.error());
  FigureSpan span;
  span.from = flags.from.value_or(span.from);
  span.to = flags.to.value_or(span.to);
  SessionFigure seen{span};
  static_cast<void>(judge_session(*session, *tissue ? &**tissue : nullptr, &seen));
  const plot::Figure figure = seen.figure();
  if (figure.panels.empty()) return refused({"the session has no tick between --from and --to"});
  if (const auto drawn = plot::write_picture(figure, flags.picture); !drawn) {
    return {ExitCode::CannotOpen, "palp-review: " + drawn.error().text};
  }
  return {ExitCode::Done, lack_lines(*session)};
}

}  // namespace palp::review
