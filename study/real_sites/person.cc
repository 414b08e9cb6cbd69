#include "study/real_sites/person.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "study/real_sites/person_view.h"
#include "study/withdrawn.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using record::NoteCode;
using std::chrono::milliseconds;

constexpr Duration kFarewell = milliseconds{500};  ///< the page reads that it is over

/// A folder for the owner alone.
Result<std::string> own_folder() {
  std::string name = fs::temp_directory_path() / "palp-study-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) return fail_to_reach("cannot make the folder " + name);
  return name;
}

/// "run-01_part-2": each session has files of its own, also after a crash.
std::string free_traces(const std::string& folder, std::size_t block) {
  for (int part = 1;; ++part) {
    std::string name = folder + "/run-" + (block < 10 ? "0" : "") + std::to_string(block) +
                       "_part-" + std::to_string(part);
    std::error_code ignored;
    if (!fs::exists(name + "_surgeon.mcap", ignored)) return name;
  }
}

/// Which of the participant's blocks a condition is, from 1.
std::size_t block_of(const Study& study, const TrialPlace& place) {
  const auto plan = participant_plan(study, place.participant);
  const auto at = std::ranges::find(plan, place.condition, &BlockPlan::condition);
  return static_cast<std::size_t>(at - plan.begin()) + 1;
}

}  // namespace

Person::Person(const Study& study, const PersonSetting& setting, LevelCurves curves, Tray tray)
    : study_{study}, setting_{setting}, curves_{std::move(curves)}, tray_{std::move(tray)} {}

Result<std::unique_ptr<Person>> Person::make(const Study& study, const PersonSetting& setting) {
  if (study.asks == StudyTask::Bias) {
    return fail("task bias compares with the own finger, and real sites have no tissue under it");
  }
  for (const Condition& one : study.conditions) {
    if (one.feedback == Feedback::Depth) {
      return fail("condition " + one.name +
                  ": feedback depth is of simulated observers, for the estimator of a session "
                  "remembers each place, and so the answers of earlier trials");
    }
  }
  auto curves = LevelCurves::make(study);
  if (!curves) return tl::unexpected(curves.error());
  auto tray = make_tray(study);
  if (!tray) return tl::unexpected(tray.error());
  return std::unique_ptr<Person>{new Person{study, setting, std::move(*curves), std::move(*tray)}};
}

Person::~Person() {
  if (session_) {
    session_->show(end_view());
    clock_.pass(kFarewell);
    session_->stop();
  }
  std::error_code ignored;
  if (!work_.empty()) fs::remove_all(work_, ignored);
}

/// A session of the condition: the one there is, or a new one after a rest.
Result<void> Person::meet(const TrialPlace& place) {
  if (session_ && place.condition == condition_) return {};
  if (session_) {
    if (auto rested = rest(); !rested) return rested;
    // No further page is opened for who withdrew meanwhile.
    const std::string id = participant_id(place.participant);
    const auto gone = has_withdrawn(setting_.data, id);
    if (!gone) return tl::unexpected(gone.error());
    if (*gone) return fail(id + " has withdrawn");
    session_->stop();
    session_.reset();
  }
  if (work_.empty()) {
    auto made = own_folder();
    if (!made) return tl::unexpected(made.error());
    work_ = *made;
  }
  const std::string folder = setting_.data.traces_folder(participant_id(place.participant));
  if (auto made = make_folder(folder); !made) return made;
  auto session = SiteSession::start(study_.conditions[place.condition],
                                    {.programs = setting_.programs,
                                     .work = work_,
                                     .tissue = tissue_text(tray_, study_, curves_),
                                     .changes_delay = study_.task.delays,
                                     .traces = free_traces(folder, block_of(study_, place)),
                                     .hand = setting_.hand});
  if (!session) return tl::unexpected(session.error());
  session_ = std::move(*session);
  condition_ = place.condition;
  setting_.say("the participant's page: " + session_->page() + "\n");
  return {};
}

Result<void> Person::rest() {
  const TimePoint end = clock_.now() + from_seconds(study_.rest);
  for (int shown = -1; clock_.now() < end;) {
    const int left = static_cast<int>(std::ceil(seconds(end - clock_.now())));
    if (std::exchange(shown, left) != left) session_->show(rest_view(left));
    session_->listen();
    if (auto fault = session_->fault()) return tl::unexpected(*fault);
  }
  return {};
}

PersonTrialPlan Person::plan_of(const TrialPlace& place, const TrialAsk& ask) const {
  PersonTrialPlan plan{.places = places_of(tray_, study_, ask),
                       .choices = choices(study_.task),
                       .decoy = tray_.decoys[ask.decoy % tray_.decoys.size()],
                       .taps = study_.conditions[place.condition].taps,
                       .practice = ask.kind == TrialKind::Practice};
  plan.times.travel = from_seconds(study_.travel);
  if (study_.task.places == 0) return plan;
  plan.choices = 1;
  plan.times.searches = true;
  plan.times.explore_max = from_seconds(study_.search.limit);
  plan.hidden = {.axis = axis_of(tray_, ask.level),
                 .reach = study_.search.side / 2,
                 .within = study_.search.within};
  return plan;
}

Result<TrialOutcome> Person::answer(const TrialPlace& place, const TrialAsk& ask) {
  if (auto met = meet(place); !met) return tl::unexpected(met.error());
  PersonTrial trial{plan_of(place, ask)};
  ++trials_;
  session_->note(NoteCode::StudyTrial, static_cast<double>(ask.number + 1), clock_.now());
  return give(ask, trial);
}

Result<TrialOutcome> Person::give(const TrialAsk& ask, PersonTrial& trial) {
  std::string shown;
  std::optional<StagePlace> sent;
  const std::vector<Stimulus> stimuli = stimuli_of(ask, study_.task);
  PersonStage before = trial.stage();
  std::optional<SiteAnswer> last;
  while (true) {
    session_->listen();
    if (auto fault = session_->fault()) return tl::unexpected(*fault);
    const TimePoint now = clock_.now();
    std::optional<std::size_t> chosen;
    const auto heard = session_->take_answer();
    if (heard && trial.asks() && (heard->trial == trials_ || heard->trial == 0)) {
      last = heard;
      chosen = heard->choice - 1;
    }
    trial.tick(now, session_->news(), chosen);
    if (trial.place() != sent) session_->send_place(*(sent = trial.place()));
    // A law may refuse to engage behind a delay, so there is none where the hand may be let go of.
    if (trial.stage() == PersonStage::Travel) {
      session_->delay(stimuli[trial.interval()].delay);
    } else if (trial.stage() != PersonStage::Touch) {
      session_->delay(0);
    }
    const PersonStage stage = std::exchange(before, trial.stage());
    const bool told = trial.stage() == PersonStage::Told || trial.stage() == PersonStage::Done;
    if (told && stage != PersonStage::Told)
      session_->note(NoteCode::StudyAnswer, last->choice, last->at);
    if (stage != PersonStage::Touch && trial.stage() == PersonStage::Touch) {
      session_->note(NoteCode::StudyInterval, static_cast<double>(trial.interval() + 1), now);
    }
    if (trial.stage() == PersonStage::Done) return trial.outcome(now);
    const bool right = told && trial.outcome(now).chosen == ask.stronger;
    std::string view =
        trial_view(study_,
                   ask,
                   trial,
                   {.number = trials_,
                    .right = right,
                    .draws_force = draws_force(study_.conditions[condition_].feedback)});
    if (view != shown) session_->show(shown = std::move(view));
  }
}

}  // namespace palp::study
