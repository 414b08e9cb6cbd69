#include "study/real_sites/person.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "study/real_sites/person_view.h"

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

Person::Person(const Study& study, const PersonSetting& setting, LevelCurves curves)
    : study_{study}, setting_{setting}, curves_{std::move(curves)}, tray_{make_tray(study)} {}

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
  return std::unique_ptr<Person>{new Person{study, setting, std::move(*curves)}};
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
                                     .tissue = tray_csv(tray_, study_, curves_),
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

Result<TrialOutcome> Person::answer(const TrialPlace& place, const TrialAsk& ask) {
  if (auto met = meet(place); !met) return tl::unexpected(met.error());
  TrialTimes times;
  times.travel = from_seconds(study_.travel);
  PersonTrial trial{{.places = places_of(tray_, study_, ask),
                     .choices = static_cast<std::size_t>(study_.task.intervals),
                     .decoy = tray_.decoys[ask.decoy % tray_.decoys.size()],
                     .taps = study_.conditions[place.condition].taps,
                     .practice = ask.kind == TrialKind::Practice,
                     .times = times}};
  ++trials_;
  session_->note(NoteCode::StudyTrial, static_cast<double>(ask.number + 1), clock_.now());
  return give(ask, trial);
}

Result<TrialOutcome> Person::give(const TrialAsk& ask, PersonTrial& trial) {
  std::string shown;
  std::optional<Place> sent;
  PersonStage before = trial.stage();
  std::optional<SiteAnswer> last;
  while (true) {
    session_->listen();
    if (auto fault = session_->fault()) return tl::unexpected(*fault);
    const TimePoint now = clock_.now();
    std::optional<std::size_t> chosen;
    const auto heard = session_->take_answer();
    const bool asks = trial.stage() == PersonStage::Answer;
    if (heard && asks && (heard->trial == trials_ || heard->trial == 0)) {
      last = heard;
      chosen = heard->choice - 1;
    }
    trial.tick(now, session_->news(), chosen);
    if (trial.place() != sent) session_->send_place(*(sent = trial.place()));
    const PersonStage stage = std::exchange(before, trial.stage());
    const bool answered = stage == PersonStage::Answer && trial.stage() != PersonStage::Answer;
    if (answered) session_->note(NoteCode::StudyAnswer, last->choice, last->at);
    if (stage != PersonStage::Touch && trial.stage() == PersonStage::Touch) {
      session_->note(NoteCode::StudyInterval, static_cast<double>(trial.interval() + 1), now);
    }
    if (trial.stage() == PersonStage::Done) return trial.outcome(now);
    const bool right = last && last->choice == ask.stronger + 1;
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
