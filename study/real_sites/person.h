#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/result.h"
#include "common/io/realtime/steady_clock.h"
#include "study/data_set.h"
#include "study/formula_participant.h"
#include "study/real_sites/site_session.h"
#include "study/real_sites/tray.h"

/// A person who goes through a study at real sites.
namespace palp::study {

/// Where the programs and the study are, and how the person is told.
struct PersonSetting {
  std::string programs{};  ///< folder of palp-surgeon and palp-patient
  DataSet data{};
  HandSetting hand{};
  std::function<void(const std::string&)> say{};  ///< a line for the terminal
};

/// Gives each trial at a session of both sites, one session for each condition. Blocks in answer()
/// until the person has answered. Thread: its maker's.
class Person {
 public:
  /// Two-sided tasks need a tissue under the own finger: bad input.
  [[nodiscard]] static Result<std::unique_ptr<Person>> make(const Study& study,
                                                            const PersonSetting& setting);
  Person(const Person&) = delete;
  Person& operator=(const Person&) = delete;
  /// Ends the session; the page says that it is over.
  ~Person();

  /// As an Observer, which this outlives. An error: a site has ended, or does not start.
  [[nodiscard]] Result<TrialOutcome> answer(const TrialPlace& place, const TrialAsk& ask);

 private:
  Person(const Study& study, const PersonSetting& setting, LevelCurves curves, Tray tray);
  [[nodiscard]] Result<void> meet(const TrialPlace& place);
  [[nodiscard]] Result<void> rest();
  [[nodiscard]] PersonTrialPlan plan_of(const TrialPlace& place, const TrialAsk& ask) const;
  [[nodiscard]] Result<TrialOutcome> give(const TrialAsk& ask, PersonTrial& trial);

  Study study_;
  PersonSetting setting_;
  LevelCurves curves_;
  Tray tray_;
  io::SteadyClock clock_;
  std::optional<SiteSession> session_;
  std::string work_;         ///< folder of what the programs read and say; empty: none yet
  std::size_t condition_{};  ///< of the session
  std::uint32_t trials_{};   ///< given in this run
};

}  // namespace palp::study
