#include "study/data_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "study/schedule.h"

namespace palp::study {
namespace {

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

FittedBlock fit_block(const Study& study,
                      const AnswerTable& table,
                      std::size_t condition,
                      const ParticipantRows& of) {
  FittedBlock out{.id = of.id, .condition = condition};
  AnswerPosterior posterior{table};
  std::size_t done = 0;
  for (const TrialRow& row : of.rows) {
    if (condition_of(study, row.condition) != condition || row.ask.kind == TrialKind::Practice) {
      continue;
    }
    posterior.told(table.nearest(row.ask.level), row.yes());
    out.answers.push_back({row.ask.level, row.yes() ? std::size_t{1} : 0, 1});
    ++out.trials;
    done += row.ask.kind == TrialKind::Trial ? 1 : 0;
  }
  out.answers = pooled(out.answers);
  out.complete = done >= study.trials;
  out.ln_jnd = posterior.ln_jnd();
  out.pse = posterior.pse();
  out.lapse = posterior.lapse_mean();
  if (study.task.yes_no) out.sensitivity = sensitivity(counts_of(out.answers));
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

}  // namespace

std::vector<std::string> condition_codes(const Study& study) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < study.conditions.size(); ++i) out.push_back(condition_code(study, i));
  return out;
}

StudyFit fit_study(const Study& study, const std::vector<ParticipantRows>& rows) {
  const AnswerTable table{study.task, {}, {.jnd_count = 121}, study.levels};
  StudyFit out;
  for (const ParticipantRows& of : rows) {
    if (of.rows.empty()) continue;
    ++out.participants;
    if (const std::string why = why_excluded(study, of); !why.empty()) {
      out.excluded.push_back({of.id, why});
    }
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

std::vector<ConditionPair> compare_study(const Study& study, const StudyFit& fit, bool bias) {
  std::vector<ConditionPair> out;
  for (std::size_t first = 0; first < study.conditions.size(); ++first) {
    for (std::size_t second = first + 1; second < study.conditions.size(); ++second) {
      ConditionPair pair{.first = first, .second = second};
      std::vector<double> differences;
      const auto others = counted(fit, second);
      for (const FittedBlock& one : counted(fit, first)) {
        const auto other = std::ranges::find(others, one.id, &FittedBlock::id);
        if (other == others.end()) continue;
        const Marginal& a = bias ? one.pse : one.ln_jnd;
        const Marginal& b = bias ? other->pse : other->ln_jnd;
        differences.push_back(b.mean - a.mean);
        pair.differences.push_back({b.mean - a.mean, std::hypot(a.sd, b.sd)});
      }
      pair.participants = differences.size();
      if (pair.participants < 2) continue;
      pair.test = paired_test(differences, study.margin);
      pair.group = group_posterior(pair.differences);
      out.push_back(std::move(pair));
    }
  }
  std::vector<double> p;
  for (const ConditionPair& pair : out) p.push_back(pair.test.p);
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].p_holm = adjusted[i];
  return out;
}

std::string fit_table(const Study& study,
                      const StudyFit& fit,
                      const std::vector<std::string>& names) {
  std::string text =
      "participant_id\tcondition\ttrials\tcomplete\texcluded\tjnd_ln\tjnd_ln_low\tjnd_ln_high\t"
      "ln_jnd_mean\tln_jnd_sd\tpse_ln\tpse_ln_low\tpse_ln_high\tlapse_mean\td_prime\t"
      "d_prime_sd\tcriterion\tcriterion_sd\tdepth_mm\tdepth_mm_low\tdepth_mm_high\n";
  for (const FittedBlock& block : fit.blocks) {
    const auto why = std::ranges::find(fit.excluded, block.id, &Exclusion::id);
    const auto number = [&](double value) {
      std::array<char, 32> digits{};
      std::snprintf(digits.data(), digits.size(), "\t%.6g", value);
      text += digits.data();
    };
    text += block.id + '\t' + names[block.condition] + '\t' + std::to_string(block.trials) + '\t' +
            (block.complete ? "1" : "0") + '\t' + (why == fit.excluded.end() ? "n/a" : why->why);
    for (const double ln : {block.ln_jnd.median, block.ln_jnd.low, block.ln_jnd.high}) {
      number(std::exp(ln));
    }
    number(block.ln_jnd.mean);
    number(block.ln_jnd.sd);
    if (study.task.two_sided) {
      for (const double pse : {block.pse.median, block.pse.low, block.pse.high}) number(pse);
    } else {
      text += "\tn/a\tn/a\tn/a";
    }
    number(block.lapse);
    if (const auto& found = block.sensitivity) {
      for (const double value :
           {found->d_prime, found->d_prime_sd, found->criterion, found->criterion_sd}) {
        number(value);
      }
    } else {
      text += "\tn/a\tn/a\tn/a\tn/a";
    }
    // The smaller the JND, the deeper is found what is found.
    for (const double ln : {block.ln_jnd.median, block.ln_jnd.high, block.ln_jnd.low}) {
      const auto depth = depth_found(study, std::exp(ln));
      depth ? number(1e3 * *depth) : static_cast<void>(text += "\tn/a");
    }
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
  std::array<char, 128> line{};
  std::snprintf(line.data(),
                line.size(),
                "condition %s: %zu participants, JND %.1f %% (geometric mean)",
                name.c_str(),
                blocks.size(),
                100 * std::expm1(jnd));
  std::string text{line.data()};
  if (!study.depths.empty()) {
    const auto depth = depth_found(study, jnd);
    std::snprintf(line.data(),
                  line.size(),
                  depth ? ", found down to %.1f mm" : ", found beyond the depths of the study",
                  1e3 * depth.value_or(0));
    text += line.data();
  }
  if (study.task.yes_no) {
    std::snprintf(line.data(),
                  line.size(),
                  ", d' %.2f, criterion %.2f",
                  mean_of([](const FittedBlock& one) { return one.sensitivity->d_prime; }),
                  mean_of([](const FittedBlock& one) { return one.sensitivity->criterion; }));
    text += line.data();
  }
  return text + '\n';
}

}  // namespace palp::study
