#include "study/exports.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "common/config/number.h"

namespace palp::study {
namespace {

using config::number_text;

/// The rows of a participant that count, by condition in order of its letter.
std::vector<std::pair<std::string, std::vector<TrialRow>>> by_condition(const ParticipantRows& of) {
  std::vector<std::pair<std::string, std::vector<TrialRow>>> out;
  for (const TrialRow& row : of.rows) {
    if (row.ask.kind == TrialKind::Practice) continue;
    auto at =
        std::ranges::find_if(out, [&](const auto& one) { return one.first == row.condition; });
    if (at == out.end()) at = out.insert(out.end(), {row.condition, {}});
    at->second.push_back(row);
  }
  std::ranges::sort(out, {}, [](const auto& one) { return one.first; });
  return out;
}

std::vector<Answers> pooled_rows(const std::vector<TrialRow>& rows) {
  std::vector<Answers> out;
  for (const TrialRow& row : rows) {
    out.push_back({row.ask.level, row.yes() ? std::size_t{1} : 0, 1});
  }
  return pooled(out);
}

std::string psignifit(const std::vector<ParticipantRows>& rows, const std::vector<Exclusion>&) {
  std::string text;
  for (const ParticipantRows& of : rows) {
    for (const auto& [condition, trials] : by_condition(of)) {
      text += "# " + of.id + " " + condition + ": level_" + level_suffix(trials.front().task) +
              ", right, all\n";
      for (const Answers& at : pooled_rows(trials)) {
        text += number_text(at.level) + ' ' + std::to_string(at.yes) + ' ' +
                std::to_string(at.trials) + '\n';
      }
    }
  }
  return text;
}

std::string palamedes(const std::vector<ParticipantRows>& rows, const std::vector<Exclusion>&) {
  std::string text = "% Rows: a participant under a condition, as in `who`.\n";
  std::size_t row = 0;
  for (const ParticipantRows& of : rows) {
    for (const auto& [condition, trials] : by_condition(of)) {
      const std::string at = "{" + std::to_string(++row) + "} = ";
      std::string levels;
      std::string right;
      std::string all;
      for (const Answers& one : pooled_rows(trials)) {
        levels += ' ' + number_text(one.level);
        right += ' ' + std::to_string(one.yes);
        all += ' ' + std::to_string(one.trials);
      }
      text += "who" + at + "'" + of.id + " " + condition + "';\n";
      text += "StimLevels" + at + "[" + levels + " ];\nNumPos" + at + "[" + right +
              " ];\nOutOfNum" + at + "[" + all + " ];\n";
    }
  }
  return text;
}

/// A row a trial, in the order in which they were answered.
template <class RowText>
std::string a_row_each(const std::string& columns,
                       const std::vector<ParticipantRows>& rows,
                       const std::vector<Exclusion>& excluded,
                       RowText row) {
  std::string text = columns + ",excluded\n";
  for (const ParticipantRows& of : rows) {
    const bool out = std::ranges::find(excluded, of.id, &Exclusion::id) != excluded.end();
    std::size_t number = 0;
    for (const TrialRow& one : of.rows) {
      if (one.ask.kind != TrialKind::Practice)
        text += row(of.id, number++, one) + (out ? ",1\n" : ",0\n");
    }
  }
  return text;
}

std::string quickpsy(const std::vector<ParticipantRows>& rows,
                     const std::vector<Exclusion>& excluded) {
  return a_row_each("participant,condition,level,response",
                    rows,
                    excluded,
                    [](const std::string& id, std::size_t, const TrialRow& row) {
                      return id + ',' + row.condition + ',' + number_text(row.ask.level) + ',' +
                             (row.yes() ? "1" : "0");
                    });
}

std::string psychopy(const std::vector<ParticipantRows>& rows,
                     const std::vector<Exclusion>& excluded) {
  return a_row_each(
      "participant,session,trials.thisN,trials.intensity,trials.response,trials.rt,condition",
      rows,
      excluded,
      [](const std::string& id, std::size_t number, const TrialRow& row) {
        return id + ",01," + std::to_string(number) + ',' + number_text(row.ask.level) + ',' +
               (row.yes() ? "1" : "0") + ',' + number_text(row.outcome.response_time) + ',' +
               row.condition;
      });
}

std::string lme4(const std::vector<ParticipantRows>& rows, const std::vector<Exclusion>& excluded) {
  return a_row_each("participant,condition,level,correct,trial",
                    rows,
                    excluded,
                    [](const std::string& id, std::size_t number, const TrialRow& row) {
                      return id + ',' + row.condition + ',' + number_text(row.ask.level) + ',' +
                             (row.yes() ? "1" : "0") + ',' + std::to_string(number + 1);
                    });
}

}  // namespace

std::optional<std::string> export_text(std::string_view format,
                                       const std::vector<ParticipantRows>& rows,
                                       const std::vector<Exclusion>& excluded) {
  using Export =
      std::string (*)(const std::vector<ParticipantRows>&, const std::vector<Exclusion>&);
  constexpr std::array<std::pair<std::string_view, Export>, 5> kExports{{{"psignifit", psignifit},
                                                                         {"quickpsy", quickpsy},
                                                                         {"palamedes", palamedes},
                                                                         {"psychopy", psychopy},
                                                                         {"lme4", lme4}}};
  for (const auto& [name, write] : kExports) {
    if (name == format) return write(rows, excluded);
  }
  return std::nullopt;
}

}  // namespace palp::study
