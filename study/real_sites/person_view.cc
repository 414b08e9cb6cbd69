#include "study/real_sites/person_view.h"

#include "common/config/json.h"
#include "common/core/conventions.h"
#include "study/orders.h"

namespace palp::study {
namespace {

using config::Json;

std::string_view name_of(PersonStage stage) noexcept {
  switch (stage) {
    case PersonStage::Press:
      return "press";
    case PersonStage::Lift:
      return "lift";
    case PersonStage::Travel:
      return "travel";
    case PersonStage::Touch:
      return "touch";
    case PersonStage::Answer:
      return "answer";
    case PersonStage::Told:
      return "told";
    case PersonStage::Done:
      return "done";
  }
  return "?";
}

std::string_view text_of(PersonNotice notice) noexcept {
  switch (notice) {
    case PersonNotice::None:
      return "";
    case PersonNotice::LetGo:
      return "The hand was let go of: this trial begins anew.";
    case PersonNotice::HeldUp:
      return "The stage was held up: lift before it travels. This trial begins anew.";
    case PersonNotice::Untouched:
      return "The tissue was never touched. This trial begins anew.";
  }
  return "";
}

Json choices(const Study& study) {
  if (study.task.yes_no) return Json{"no", "yes"};
  Json out = Json::array();
  if (study.task.places > 0) {
    out.push_back("it is here");
    return out;
  }
  if (study.task.ranks) {
    for (std::size_t i = 0; i < kOrders.size(); ++i) out.push_back(order_name(i));
    return out;
  }
  if (study.task.intervals == 2) return Json{"the first", "the second"};
  for (int i = 1; i <= study.task.intervals; ++i) out.push_back("number " + std::to_string(i));
  return out;
}

std::string_view question(const Study& study) noexcept {
  switch (study.asks) {
    case StudyTask::Detect:
      return "Is there something hard?";
    case StudyTask::Detect2:
      return "Over which place is something hard?";
    case StudyTask::Rank:
      return "Softest first: in which order are the places?";
    case StudyTask::Delay:
      return "Which place answered late?";
    case StudyTask::Locate:
      return "Time is over. Where you were is taken.";
    case StudyTask::Stiffness:
    case StudyTask::Bias:
      break;
  }
  return study.task.intervals == 2 ? "Which was stiffer?" : "Which was stiffest?";
}

}  // namespace

std::string trial_view(const Study& study,
                       const TrialAsk& ask,
                       const PersonTrial& trial,
                       const ViewSetting& setting) {
  const bool practice = ask.kind == TrialKind::Practice;
  Json view{{"stage", name_of(trial.stage())},
            {"trial", setting.number},
            {"practice", practice},
            {"place", practice ? ask.number + 1 : ask.before + 1},
            {"count", practice ? std::size_t{0} : ask.count},
            {"interval", trial.interval() + 1},
            {"intervals", felt_intervals(study.task)},
            {"taps", trial.taps_wanted()},
            {"instructions", study.instructions},
            {"question", question(study)},
            {"choices", choices(study)},
            {"notice", text_of(trial.notice())},
            {"draws_force", setting.draws_force}};
  if (study.task.places > 0) view["side_mm"] = study.search.side / kMillimetre;
  if (trial.stage() == PersonStage::Told) view["right"] = setting.right;
  return view.dump();
}

std::string rest_view(int seconds_left) {
  return Json{{"stage", "rest"}, {"seconds", seconds_left}}.dump();
}

std::string end_view() { return Json{{"stage", "over"}}.dump(); }

}  // namespace palp::study
