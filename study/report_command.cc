#include "study/report_command.h"

#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "common/plot/pdf.h"
#include "study/standing.h"
#include "study/study_report.h"
#include "study/who_answers.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;

ExitStatus closed(const Error& fault) {
  return {ExitCode::CannotOpen, "palp-study: " + fault.text};
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

/// One kind is all there is, or something is wrong.
std::string kinds_text(const std::vector<ParticipantRows>& rows) {
  std::string text;
  for (const std::string& kind : kinds_of(rows)) text += (text.empty() ? "" : ", ") + kind;
  return text;
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
  if (auto may = planned->data.may_write(flags.out); !flags.out.empty() && !may) {
    return config::refusal("palp-study", may.error());
  }
  const Study& study = planned->study;
  const StudyFit fit = fit_study(study, *rows);
  if (fit.blocks.empty()) {
    return {ExitCode::BadInput, "palp-study: " + flags.folder + " holds no answered trial"};
  }
  if (flags.unblind) {
    if (auto logged = log_unblinding(*planned, *rows); !logged) return closed(logged.error());
  }
  const auto stands = standing(*planned, *rows);
  if (!stands) return config::refusal("palp-study", stands.error());
  ReportParts parts{
      .standing = *stands,
      .preregistration =
          read_whole_file(planned->data.code("PREREGISTRATION.md")).value_or("missing"),
      .names = condition_codes(study),
      .kind = kinds_text(*rows)};
  if (flags.unblind) {
    parts.blind = false;
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
