#include "study/report_command.h"

#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "common/plot/pdf.h"
#include "study/compare_command.h"
#include "study/journal.h"
#include "study/study_report.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;

ExitStatus closed(const Error& fault) {
  return {ExitCode::CannotOpen, "palp-study: " + fault.text};
}

/// That somebody looked, and how much was answered by then, stays in the folder.
Result<void> log_unblinding(const PlannedStudy& planned, const StudyFit& fit) {
  std::size_t trials = 0;
  for (const FittedBlock& one : fit.blocks) trials += one.trials;
  const std::string path = planned.data.code("unblinded.txt");
  const std::string before = read_whole_file(path).value_or(std::string{});
  auto log = Journal::open(path, before.size());
  if (!log) return tl::unexpected(log.error());
  return log->add("unblinded after " + std::to_string(trials) + " answers of " +
                  std::to_string(fit.participants) + " participants\n");
}

/// As SVG and, where asked for, as PDF, in the width of a journal's page.
Result<void> write_figure(const DataSet& data,
                          const std::string& name,
                          const plot::Figure& figure,
                          bool pdf) {
  const std::string svg = figure_svg(figure, *plot::style_of("double"));
  auto written = config::write_whole_file(data.derived(name + ".svg"), svg);
  if (!written || !pdf) return written;
  const auto page = plot::pdf_of(svg);
  if (!page) return tl::unexpected(page.error());
  return config::write_whole_file(data.derived(name + ".pdf"), *page);
}

/// The conditions that each answer's kind shows; one kind is all there is.
std::string kind_of(const std::vector<ParticipantRows>& rows) {
  for (const ParticipantRows& of : rows) {
    if (!of.rows.empty()) return of.rows.front().kind;
  }
  return {};
}

}  // namespace

void declare_report(config::CommandLine& line, StudyReportFlags& flags) {
  line.argument("FOLDER", flags.folder, "of a study whose participants answered");
  line.required();
  line.output("--out", flags.out, "the page; otherwise derivatives/palp-study/report.html");
  line.toggle("--unblind", flags.unblind, "name the conditions; that it was done is written down");
  line.toggle("--pdf", flags.pdf, "the figures as PDF too");
  line.footer("One page of HTML with everything inside; the figures as SVG beside it.");
}

ExitStatus run_report(const StudyReportFlags& flags) {
  const auto planned = open_study(flags.folder);
  if (!planned) return config::refusal("palp-study", planned.error());
  const auto rows = read_rows(*planned);
  if (!rows) return config::refusal("palp-study", rows.error());
  const Study& study = planned->study;
  const StudyFit fit = fit_study(study, *rows);
  if (fit.blocks.empty()) {
    return {ExitCode::BadInput, "palp-study: " + flags.folder + " holds no answered trial"};
  }
  ReportParts parts{
      .standing = standing(*planned, fit),
      .preregistration =
          read_whole_file(planned->data.code("PREREGISTRATION.md")).value_or("missing"),
      .names = condition_codes(study),
      .kind = kind_of(*rows)};
  if (flags.unblind) {
    if (auto logged = log_unblinding(*planned, fit); !logged) return closed(logged.error());
    for (std::size_t i = 0; i < parts.names.size(); ++i) parts.names[i] = study.conditions[i].name;
  }
  const std::string out = flags.out.empty() ? planned->data.derived("report.html") : flags.out;
  for (const auto& written :
       {config::write_whole_file(out, report_html(study, fit, parts)),
        write_figure(planned->data, "jnd", jnd_figure(study, fit, parts.names), flags.pdf),
        write_figure(
            planned->data, "answers", answers_figure(study, fit, parts.names), flags.pdf)}) {
    if (!written) return closed(written.error());
  }
  return {ExitCode::Done, "written: " + out + "\n"};
}

}  // namespace palp::study
