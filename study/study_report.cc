#include "study/study_report.h"

#include <algorithm>
#include <cmath>

#include "study/compare_command.h"

namespace palp::study {
namespace {

constexpr double kReach = 1.96;  // [-], standard deviations of a 95 % interval

/// Foreign text inside of HTML.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      default:
        out += letter;
    }
  }
  return out;
}

/// Mean of ln JND and its 95 % interval over those who count.
struct GroupMean {
  double mean{};   // [-]
  double reach{};  // [-]
};
GroupMean group_mean(const std::vector<FittedBlock>& blocks) {
  std::vector<Measured> values;
  values.reserve(blocks.size());
  for (const FittedBlock& one : blocks) values.push_back({one.ln_jnd.mean, one.ln_jnd.sd});
  if (values.size() < 2) return {values.empty() ? 0 : values[0].value, 0};
  double mean = 0;
  for (const Measured& one : values) mean += one.value / static_cast<double>(values.size());
  double squares = 0;
  for (const Measured& one : values) squares += (one.value - mean) * (one.value - mean);
  const auto n = static_cast<double>(values.size());
  return {mean, kReach * std::sqrt(squares / (n - 1) / n)};
}

/// Answers of all who count under a condition.
std::vector<Answers> all_answers(const StudyFit& fit, std::size_t condition) {
  std::vector<Answers> out;
  for (const FittedBlock& one : counted(fit, condition)) {
    out.insert(out.end(), one.answers.begin(), one.answers.end());
  }
  return pooled(out);
}

plot::Curve shares_of(const std::vector<Answers>& answers) {
  plot::Curve curve{.name = "answers, 95 % interval", .mark = plot::Mark::Intervals};
  for (const Answers& at : answers) {
    const auto n = static_cast<double>(at.trials);
    const double share = static_cast<double>(at.yes) / n;
    const double z2 = kReach * kReach;
    const double middle = (share + z2 / (2 * n)) / (1 + z2 / n);
    const double reach =
        kReach * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n)) / (1 + z2 / n);
    curve.x.push_back(at.level);
    curve.y.push_back(share);
    curve.low.push_back(std::min(share, middle - reach));
    curve.high.push_back(std::max(share, middle + reach));
  }
  return curve;
}

/// Of an observer with the means of those who count.
plot::Curve function_of(const Study& study, const std::vector<FittedBlock>& blocks) {
  const auto mean = [&](auto value) {
    double sum = 0;
    for (const FittedBlock& one : blocks) sum += value(one);
    return sum / static_cast<double>(blocks.size());
  };
  const ObserverTraits traits{
      .jnd = std::exp(mean([](const FittedBlock& one) { return one.ln_jnd.mean; })),
      .pse = study.task.two_sided ? mean([](const FittedBlock& one) { return one.pse.mean; }) : 0,
      .lapse = mean([](const FittedBlock& one) { return one.lapse; })};
  plot::Curve curve{.name = "mean observer", .colour = plot::kOrange};
  for (int i = 0; i <= 100; ++i) {
    const double from = study.task.two_sided ? study.levels.front() : 0;
    const double level = from + (study.levels.back() - from) * i / 100;
    curve.x.push_back(level);
    curve.y.push_back(answer_share(study.task, traits, level));
  }
  return curve;
}

/// What a reader of the field asks for; what nobody said is called missing.
std::string checklist(const Study& study, const StudyFit& fit, const ReportParts& parts) {
  const auto row = [](const std::string& what, const std::string& is) {
    return "<tr><td>" + what + "</td><td>" + (is.empty() ? "missing" : escaped(is)) +
           "</td></tr>\n";
  };
  const bool simulated = parts.kind == "simulated";
  std::string text = "<table>\n";
  text += row("Who answered", parts.kind);
  text +=
      row("Ethics",
          study.ethics.body.empty() ? (simulated ? "none needed: nobody but programs answered" : "")
                                    : study.ethics.body + ", " + study.ethics.number);
  for (const char* what : {"Consent, recruitment",
                           "Ages and handedness, as ranges",
                           "Device, its workspace, rate, peak and continuous force",
                           "Measured transparency of the device",
                           "Posture; sight and sound masked"}) {
    text += row(what, simulated ? "no people, no device: simulated in virtual time" : "");
  }
  text += row("Participants",
              std::to_string(fit.participants) + " of " + std::to_string(study.participants) +
                  " registered, " + std::to_string(fit.excluded.size()) + " excluded");
  text += row("Instructions", study.instructions);
  text += row("Trials",
              std::to_string(study.trials) + " a condition and participant, " +
                  std::string{to_string(study.method.kind)});
  text += row("Data and code", "in this folder: tables of trials, study file, schedule, commit");
  return text + "</table>\n";
}

std::string fits_html(const Study& study, const StudyFit& fit, const ReportParts& parts) {
  return "<details><summary>Every participant's estimates</summary><pre>" +
         escaped(fit_table(study, fit, parts.names, parts.blind)) + "</pre></details>\n";
}

}  // namespace

plot::Figure jnd_figure(const Study& study,
                        const StudyFit& fit,
                        const std::vector<std::string>& names) {
  plot::Panel panel{.axes = {.title = "",
                             .x_name = "condition",
                             .y_name = std::string{"JND, "} + said_unit(study.task),
                             .x_classes = names}};
  plot::Curve people{.name = "participants, 95 % interval",
                     .mark = plot::Mark::Intervals,
                     .colour = plot::kGrey,
                     .opacity = 0.7};
  plot::Curve means{.name = "geometric mean, 95 % interval",
                    .mark = plot::Mark::Intervals,
                    .colour = plot::kBlue};
  for (std::size_t i = 0; i < study.conditions.size(); ++i) {
    const auto blocks = counted(fit, i);
    if (blocks.empty()) continue;
    const auto x = static_cast<double>(i);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const Marginal& one = blocks[k].ln_jnd;
      people.x.push_back(x - 0.1 +
                         0.4 * static_cast<double>(k + 1) / static_cast<double>(blocks.size()));
      people.y.push_back(said_level(study.task, std::exp(one.median)));
      people.low.push_back(said_level(study.task, std::exp(one.low)));
      people.high.push_back(said_level(study.task, std::exp(one.high)));
    }
    const GroupMean group = group_mean(blocks);
    means.x.push_back(x - 0.2);
    means.y.push_back(said_level(study.task, std::exp(group.mean)));
    means.low.push_back(said_level(study.task, std::exp(group.mean - group.reach)));
    means.high.push_back(said_level(study.task, std::exp(group.mean + group.reach)));
  }
  panel.curves = {people, means};
  return {.title = "JND by condition", .panels = {panel}};
}

plot::Figure answers_figure(const Study& study,
                            const StudyFit& fit,
                            const std::vector<std::string>& names) {
  plot::Figure figure{.title = "Answers by level", .panels = {}};
  for (std::size_t i = 0; i < study.conditions.size(); ++i) {
    const auto blocks = counted(fit, i);
    if (blocks.empty()) continue;
    plot::Panel panel{
        .axes = {.title = "condition " + names[i],
                 .x_name = study.task.delays ? "delay, ms" : "ln of the ratio of stiffnesses",
                 .y_name = study.task.yes_no       ? "share \"yes\""
                           : study.task.two_sided  ? "share \"the second\""
                           : study.task.places > 0 ? "share found"
                                                   : "share right",
                 .y_from = 0,
                 .y_to = 1}};
    panel.curves = {shares_of(all_answers(fit, i)), function_of(study, blocks)};
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

std::string report_html(const Study& study, const StudyFit& fit, const ReportParts& parts) {
  const plot::Style& style = plot::kStyles.front();
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>" +
      escaped(study.name) +
      "</title>\n<style>body{font:16px sans-serif;max-width:60em;margin:2em auto;padding:0 1em}"
      "table{border-collapse:collapse}td{border:1px solid #ccc;padding:.3em .6em}"
      "pre{overflow:auto;background:#f4f4f4;padding:.6em}.said{white-space:pre-wrap}svg{max-width:"
      "100%;height:auto}</style>"
      "</head><body>\n<h1>" +
      escaped(study.name) + "</h1>\n<p>" + escaped(study.question) + "</p>\n<p><strong>" +
      escaped(parts.standing) + "</strong></p>\n";
  page += "<h2>Results</h2>\n<pre class=\"said\">";
  for (std::size_t i = 0; i < study.conditions.size(); ++i) {
    page += escaped(condition_text(study, fit, i, parts.names[i]));
  }
  page += "</pre>\n" + figure_svg(jnd_figure(study, fit, parts.names), style);
  for (const Measure measure : measures_of(study.task)) {
    page += "<pre>" +
            escaped(pairs_text(compare_study(study, fit, measure), parts.names, measure)) +
            "</pre>\n";
  }
  page += figure_svg(answers_figure(study, fit, parts.names), style);
  page += fits_html(study, fit, parts);
  page += "<h2>Excluded</h2>\n<ul>\n";
  for (const Exclusion& one : fit.excluded)
    page += "<li>" + escaped(one.id) + ": " + escaped(one.why) + "</li>\n";
  if (fit.excluded.empty()) page += "<li>nobody</li>\n";
  page += "</ul>\n<h2>What a reader asks for</h2>\n" + checklist(study, fit, parts);
  page += "<h2>As it was registered</h2>\n<pre>" + escaped(parts.preregistration) +
          "</pre>\n</body></html>\n";
  return page;
}

}  // namespace palp::study
