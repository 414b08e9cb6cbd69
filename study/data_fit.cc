#include "study/data_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/conventions.h"
#include "common/core/formatted.h"
#include "study/orders.h"
#include "study/schedule.h"

namespace palp::study {
namespace {

constexpr double kErrorLeast = 0.1e-3;  // [m], of which a logarithm is taken
constexpr double kTimeLeast = 0.1;      // [s], likewise

/// Of differences [as the measure]. Posteriors that are hardly narrower than the prior are alike
/// whatever people can do: above it nothing is called equal.
constexpr double kKnownSd = 0.5;

double mean_sd(const std::vector<Measured>& differences) {
  double sum = 0;
  for (const Measured& one : differences) sum += one.sd;
  return sum / static_cast<double>(differences.size());
}

/// Nothing: the block has no such measure.
std::optional<Measured> measured(const FittedBlock& block, Measure measure) noexcept {
  switch (measure) {
    case Measure::Jnd:
      return Measured{block.ln_jnd.mean, block.ln_jnd.sd};
    case Measure::Pse:
      return Measured{block.pse.mean, block.pse.sd};
    case Measure::Tau:
      return block.kendall_tau;
    case Measure::Error:
    case Measure::Time:
      break;
  }
  if (!block.search) return std::nullopt;
  return measure == Measure::Error ? block.search->ln_error : block.search->ln_time;
}

/// The condition of a code.
std::size_t condition_of(const Study& study, const std::string& code) {
  const auto codes = condition_codes(study);
  return static_cast<std::size_t>(std::ranges::find(codes, code) - codes.begin());
}

YesNoCounts counts_of(const std::vector<Answers>& answers) {
  YesNoCounts counts;
  for (const Answers& at : answers) {
    (at.level > 0 ? counts.hits : counts.false_alarms) += at.yes;
    (at.level > 0 ? counts.signals : counts.blanks) += at.trials;
  }
  return counts;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// The mean of a value of each of the rows, of which there are some.
template <class Value>
Measured mean_of_rows(const std::vector<const TrialRow*>& rows, Value value) {
  constexpr double kSdLeast = 1e-3;  // [-], of values that are all alike
  const auto n = static_cast<double>(rows.size());
  double sum = 0;
  double squares = 0;
  for (const TrialRow* row : rows) {
    sum += value(*row);
    squares += value(*row) * value(*row);
  }
  const double variance = std::max(0.0, squares - sum * sum / n) / std::max(1.0, n - 1);
  return {sum / n, std::max(kSdLeast, std::sqrt(variance / n))};
}

/// `rows`: not none.
SearchFigures search_figures(const std::vector<const TrialRow*>& rows) {
  const auto median_of = [&rows](auto value) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const TrialRow* row : rows) values.push_back(value(row->outcome));
    return median(std::move(values));
  };
  return {.path = median_of([](const TrialOutcome& one) { return one.path; }),
          .contacts = median_of([](const TrialOutcome& one) { return one.taps; }),
          .force_mean = median_of([](const TrialOutcome& one) { return one.force_mean; }),
          .force_max = median_of([](const TrialOutcome& one) { return one.force_max; }),
          .ln_error = mean_of_rows(rows,
                                   [](const TrialRow& row) {
                                     return std::log(std::max(kErrorLeast, row.outcome.error));
                                   }),
          .ln_time = mean_of_rows(rows, [](const TrialRow& row) {
            return std::log(std::max(kTimeLeast, row.outcome.response_time));
          })};
}

FittedBlock fit_block(const Study& study,
                      const AnswerTable& table,
                      std::size_t condition,
                      const ParticipantRows& of) {
  FittedBlock out{.id = of.id, .condition = condition};
  AnswerPosterior posterior{table};
  std::vector<const TrialRow*> trials;
  for (const TrialRow& row : of.rows) {
    if (condition_of(study, row.condition) != condition || row.ask.kind == TrialKind::Practice) {
      continue;
    }
    posterior.told(table.nearest(row.ask.level), row.yes());
    out.answers.push_back({row.ask.level, row.yes() ? std::size_t{1} : 0, 1});
    ++out.trials;
    if (row.ask.kind == TrialKind::Trial) trials.push_back(&row);
  }
  out.answers = pooled(out.answers);
  out.complete = trials.size() >= study.trials;
  out.ln_jnd = posterior.ln_jnd();
  out.pse = posterior.pse();
  out.lapse = posterior.lapse_mean();
  if (study.task.yes_no) out.sensitivity = sensitivity(counts_of(out.answers));
  if (study.task.ranks && !trials.empty()) {
    out.kendall_tau = mean_of_rows(trials, [](const TrialRow& row) {
      return kendall_tau(row.ask.stronger, row.outcome.chosen);
    });
  }
  if (study.task.places > 0 && !trials.empty()) out.search = search_figures(trials);
  return out;
}

/// Empty: nobody says so.
std::string why_excluded(const Study& study, const ParticipantRows& of) {
  double catches = 0;
  double right = 0;
  for (const TrialRow& row : of.rows) {
    if (row.ask.kind != TrialKind::Catch) continue;
    ++catches;
    right += row.yes() == (study.task.two_sided ? row.ask.level > 0 : true) ? 1 : 0;
  }
  if (catches > 0 && right / catches < study.catch_right_min) {
    return "too few catch trials right";
  }
  for (std::size_t block = 1; block <= study.conditions.size(); ++block) {
    const auto in_block = [&](const TrialRow& row) { return row.block == block; };
    const auto practised = [&](const TrialRow& row) {
      return in_block(row) && row.ask.kind == TrialKind::Practice;
    };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(of.rows, practised));
    const auto all = static_cast<std::size_t>(std::ranges::count_if(of.rows, in_block));
    if (count > 0 && count == all && count >= study.practice.trials_max) {
      return "practice did not help";
    }
  }
  return {};
}

/// Cells of a search.
template <class Number>
void add_search(const std::optional<SearchFigures>& search, bool blind, Number number) {
  const auto figure = [&](double value) { number(search ? std::optional{value} : std::nullopt); };
  const SearchFigures of = search.value_or(SearchFigures{});
  figure(std::exp(of.ln_error.value) / kMillimetre);
  figure(std::exp(of.ln_time.value));
  figure(of.path / kMillimetre);
  if (blind) return;
  figure(of.contacts);
  figure(of.force_mean);
  figure(of.force_max);
}

/// Where balls lie that are told in order, or down to where one is found.
std::string depths_text(const Study& study, double jnd) {
  const auto found = depth_found(study, jnd);
  if (!study.task.ranks) {
    return found ? formatted(", found down to %.1f mm", *found / kMillimetre)
                 : ", found beyond the depths of the study";
  }
  const double middle = middle_contrast(study);
  const auto deepest = depth_of(study, middle - jnd);
  if (!found || !deepest) return ", in order at no depths of the study";
  return formatted(", in order at %.1f, %.1f and %.1f mm",
                   *found / kMillimetre,
                   *depth_of(study, middle) / kMillimetre,
                   *deepest / kMillimetre);
}

}  // namespace

std::vector<std::string> condition_codes(const Study& study) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < study.conditions.size(); ++i) out.push_back(condition_code(i));
  return out;
}

std::vector<Exclusion> exclusions(const Study& study, const std::vector<ParticipantRows>& rows) {
  std::vector<Exclusion> out;
  for (const ParticipantRows& of : rows) {
    if (const std::string why = why_excluded(study, of); !why.empty()) out.push_back({of.id, why});
  }
  return out;
}

StudyFit fit_study(const Study& study, const std::vector<ParticipantRows>& rows) {
  const AnswerTable table{study.task, {}, {.jnd_count = 121}, study.levels};
  StudyFit out{.blocks = {}, .excluded = exclusions(study, rows), .participants = 0};
  for (const ParticipantRows& of : rows) {
    if (of.rows.empty()) continue;
    ++out.participants;
    for (std::size_t i = 0; i < study.conditions.size(); ++i) {
      out.blocks.push_back(fit_block(study, table, i, of));
    }
  }
  return out;
}

std::vector<FittedBlock> counted(const StudyFit& fit, std::size_t condition) {
  std::vector<FittedBlock> out;
  for (const FittedBlock& block : fit.blocks) {
    const bool excluded =
        std::ranges::find(fit.excluded, block.id, &Exclusion::id) != fit.excluded.end();
    if (block.condition == condition && block.complete && !excluded) out.push_back(block);
  }
  return out;
}

std::vector<Measure> measures_of(const Task& task) {
  if (task.places > 0) return {Measure::Jnd, Measure::Error, Measure::Time};
  if (task.ranks) return {Measure::Jnd, Measure::Tau};
  if (task.two_sided) return {Measure::Jnd, Measure::Pse};
  return {Measure::Jnd};
}

std::string_view to_string(Measure measure) noexcept {
  switch (measure) {
    case Measure::Jnd:
      return "jnd";
    case Measure::Pse:
      return "pse";
    case Measure::Tau:
      return "tau";
    case Measure::Error:
      return "error";
    case Measure::Time:
      return "time";
  }
  return "?";
}

std::vector<ConditionPair> compare_study(const Study& study, const StudyFit& fit, Measure measure) {
  std::vector<ConditionPair> out;
  for (std::size_t first = 0; first < study.conditions.size(); ++first) {
    for (std::size_t second = first + 1; second < study.conditions.size(); ++second) {
      ConditionPair pair{.first = first, .second = second};
      std::vector<double> differences;
      const auto others = counted(fit, second);
      for (const FittedBlock& one : counted(fit, first)) {
        const auto other = std::ranges::find(others, one.id, &FittedBlock::id);
        if (other == others.end()) continue;
        const auto a = measured(one, measure);
        const auto b = measured(*other, measure);
        if (!a || !b) continue;
        differences.push_back(b->value - a->value);
        pair.differences.push_back({b->value - a->value, std::hypot(a->sd, b->sd)});
      }
      pair.participants = differences.size();
      if (pair.participants < 2) continue;
      pair.test = paired_test(differences, study.margin);
      if (mean_sd(pair.differences) > kKnownSd) {
        pair.test.equivalent = std::numeric_limits<double>::quiet_NaN();
      }
      pair.group = group_posterior(pair.differences);
      out.push_back(std::move(pair));
    }
  }
  std::vector<double> p;
  p.reserve(out.size());
  for (const ConditionPair& pair : out) p.push_back(pair.test.p);
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].p_holm = adjusted[i];
  return out;
}

std::string fit_table(const Study& study,
                      const StudyFit& fit,
                      const std::vector<std::string>& names,
                      bool blind) {
  const std::string jnd = "\tjnd_" + level_suffix(study.task);
  std::string text = "participant_id\tcondition\ttrials\tcomplete\texcluded" + jnd + jnd + "_low" +
                     jnd +
                     "_high\tln_jnd_mean\tln_jnd_sd\tpse_ln\tpse_ln_low\tpse_ln_high\tlapse_mean"
                     "\td_prime\td_prime_sd\tcriterion\tcriterion_sd\tdepth_mm\tdepth_mm_low"
                     "\tdepth_mm_high";
  if (study.task.ranks) text += "\tkendall_tau";
  if (study.task.places > 0) {
    text += "\terror_mm\tsearch_s\tpath_mm";
    if (!blind) text += "\tcontacts\tforce_mean_n\tforce_max_n";
  }
  text += '\n';
  for (const FittedBlock& block : fit.blocks) {
    const auto why = std::ranges::find(fit.excluded, block.id, &Exclusion::id);
    const auto number = [&](std::optional<double> value) {
      text += '\t' + (value ? formatted("%.6g", *value) : "n/a");
    };
    text += block.id + '\t' + names[block.condition] + '\t' + std::to_string(block.trials) + '\t' +
            (block.complete ? "1" : "0") + '\t' + (why == fit.excluded.end() ? "n/a" : why->why);
    // Without an answer the posterior is the prior.
    const auto known = [&](double value) {
      number(block.trials > 0 ? std::optional{value} : std::nullopt);
    };
    for (const double ln : {block.ln_jnd.median, block.ln_jnd.low, block.ln_jnd.high}) {
      known(std::exp(ln));
    }
    known(block.ln_jnd.mean);
    known(block.ln_jnd.sd);
    for (const double pse : {block.pse.median, block.pse.low, block.pse.high}) {
      study.task.two_sided ? known(pse) : number(std::nullopt);
    }
    known(block.lapse);
    for (double Sensitivity::*const value : {&Sensitivity::d_prime,
                                             &Sensitivity::d_prime_sd,
                                             &Sensitivity::criterion,
                                             &Sensitivity::criterion_sd}) {
      number(block.sensitivity ? std::optional{(*block.sensitivity).*value} : std::nullopt);
    }
    // The smaller the JND, the deeper is found what is found.
    for (const double ln : {block.ln_jnd.median, block.ln_jnd.high, block.ln_jnd.low}) {
      const auto depth = depth_found(study, std::exp(ln));
      depth ? known(*depth / kMillimetre) : number(std::nullopt);
    }
    if (study.task.ranks) {
      number(block.kendall_tau ? std::optional{block.kendall_tau->value} : std::nullopt);
    }
    if (study.task.places > 0) add_search(block.search, blind, number);
    text += '\n';
  }
  return text;
}

std::string condition_text(const Study& study,
                           const StudyFit& fit,
                           std::size_t condition,
                           const std::string& name) {
  const auto blocks = counted(fit, condition);
  if (blocks.empty()) return {};
  const auto mean_of = [&blocks](auto value) {
    double sum = 0;
    for (const FittedBlock& one : blocks) sum += value(one);
    return sum / static_cast<double>(blocks.size());
  };
  const double jnd = std::exp(mean_of([](const FittedBlock& one) { return one.ln_jnd.mean; }));
  std::string text = "condition " + name + ": " + std::to_string(blocks.size()) + " participants" +
                     formatted(", JND %.1f ", said_level(study.task, jnd)) + said_unit(study.task) +
                     " (geometric mean)";
  if (jnd > study.levels.back()) text += ", beyond the levels that were asked";
  if (!study.depths.empty()) text += depths_text(study, jnd);
  if (study.task.yes_no) {
    text += formatted(", d' %.2f",
                      mean_of([](const FittedBlock& one) { return one.sensitivity->d_prime; })) +
            formatted(", criterion %.2f",
                      mean_of([](const FittedBlock& one) { return one.sensitivity->criterion; }));
  }
  if (study.task.ranks) {
    text += formatted(", Kendall's tau %.2f",
                      mean_of([](const FittedBlock& one) { return one.kendall_tau->value; }));
  }
  if (study.task.places > 0) {
    const double error =
        std::exp(mean_of([](const FittedBlock& one) { return one.search->ln_error.value; }));
    const double time =
        std::exp(mean_of([](const FittedBlock& one) { return one.search->ln_time.value; }));
    text += formatted(", error %.1f mm", error / kMillimetre) +
            formatted(" in %.1f s (geometric means)", time);
  }
  return text + '\n';
}

}  // namespace palp::study
