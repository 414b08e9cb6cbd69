#include "surgeon_site/study_port.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "common/config/json.h"
#include "common/record/mapped_file.h"
#include "common/record/notes.h"
#include "common/record/session_reader.h"
#include "tests/support/own_path.h"

namespace palp::surgeon {
namespace {

using config::Json;

constexpr TimePoint kNow{std::chrono::seconds{50}};

/// A hand that stands still.
struct Still final : HapticDevice {
  Place stands{1e-3, 2e-3};
  [[nodiscard]] HandFacts hand_facts() const noexcept override { return {}; }
  HandState read(TimePoint /*now*/) noexcept override { return {.place = stands}; }
  void apply(double /*force*/) noexcept override {}
  void show(const OperatorView& /*view*/) noexcept override {}
};

/// Nothing is there yet.
std::string fresh_file() {
  const std::string path = test::own_path("study_port.mcap");
  std::filesystem::remove(path);
  return path;
}

/// A site, and the study at the other end.
struct Rig {
  explicit Rig(std::string session = {}) : file{std::move(session)} {}

  std::string file;  ///< of the session; empty: none
  site_program::Recording recording{{.file = file}, {.site = link::Role::Surgeon}, 1};
  std::pair<io::MessagePipe, io::MessagePipe> ends{std::move(*io::MessagePipe::make())};
  std::optional<io::MessagePipe> study{std::move(ends.first)};
  Still hand;
  StudyPort port{std::move(ends.second), hand};

  bool look(const SurgeonStatus& status = {}) { return port.look(status, recording, kNow); }
  Place place() { return port.hand().read(kNow).place; }
  std::vector<std::pair<std::uint16_t, double>> notes() {
    (void)recording.stop();
    std::vector<std::pair<std::uint16_t, double>> out;
    const auto mapped = record::MappedFile::open(file);
    record::SessionReader reader{mapped->bytes()};
    while (const auto entry = reader.next()) {
      const auto* note = std::get_if<Note>(&entry->record);
      if (note != nullptr) out.emplace_back(note->code, note->detail);
    }
    return out;
  }
};

TEST(StudyPortTest, TheStudySaysWhereTheHandStandsAndWhatIsShown) {
  Rig rig;
  EXPECT_TRUE(rig.look());
  EXPECT_EQ(rig.place(), (Place{1e-3, 2e-3}));
  EXPECT_TRUE(rig.study->send(R"({"place":{"x_mm":-7,"y_mm":4.5}})"));
  EXPECT_TRUE(rig.study->send(R"({"show":{"stage":"touch"}})"));
  EXPECT_TRUE(rig.look());
  EXPECT_NEAR(rig.place().x, -7e-3, 1e-12);
  EXPECT_NEAR(rig.place().y, 4.5e-3, 1e-12);
  EXPECT_TRUE(rig.study->send(R"({"place":{"x_mm":10,"y_mm":0,"reach_mm":20}})"));
  EXPECT_TRUE(rig.look());
  EXPECT_NEAR(rig.place().x, 10e-3, 1e-12);
  rig.hand.stands.x += 6e-3;
  EXPECT_NEAR(rig.place().x, 16e-3, 1e-12) << "where it may, the hand moves on";
  std::string shown;
  ASSERT_TRUE(rig.port.screen().shown.try_dequeue(shown));
  EXPECT_EQ(shown, R"({"stage":"touch"})");
}

TEST(StudyPortTest, NonsenseAndPlacesBeyondTheTravelMoveNothing) {
  Rig rig{fresh_file()};
  for (const char* wrong : {"",
                            "x",
                            "[]",
                            "7",
                            R"({"place":{"x_mm":251,"y_mm":0}})",
                            R"({"place":{"x_mm":1}})",
                            R"({"place":3})",
                            R"({"note":2,"detail":1})",
                            R"({"note":56.5,"detail":1})",
                            R"({"note":59,"detail":1})",
                            R"({"note":56})"}) {
    (void)rig.study->send(wrong);
  }
  EXPECT_TRUE(rig.look());
  EXPECT_EQ(rig.place(), (Place{1e-3, 2e-3}));
  EXPECT_TRUE(rig.notes().empty());
}

TEST(StudyPortTest, TheSiteSaysHowItIsWhereThePageIsAndWhatWasAnswered) {
  Rig rig;
  rig.port.tell_page("http://here");
  EXPECT_TRUE(rig.port.screen().answers.try_enqueue({.trial = 4, .choice = 2, .at = kNow}));
  SurgeonStatus status;
  status.at = kNow;
  status.state = status.peer_state = SiteState::Engaged;
  status.contact_force = 0.4;
  status.peer_place = {3e-3, -1e-3};
  EXPECT_TRUE(rig.look(status));
  EXPECT_EQ(Json::parse(*rig.study->receive())["page"].text(), "http://here");
  const Json answer = Json::parse(*rig.study->receive());
  EXPECT_EQ(answer["answer"].number(), 2);
  EXPECT_EQ(answer["trial"].number(), 4);
  EXPECT_EQ(answer["at_ns"].number(), 50e9);
  const Json news = Json::parse(*rig.study->receive());
  EXPECT_EQ(news["engaged"].truth(), true);
  EXPECT_DOUBLE_EQ(news["contact_n"].number().value(), 0.4);
  EXPECT_DOUBLE_EQ(news["x_mm"].number().value(), 3);
  status.peer_state = SiteState::Clutched;
  EXPECT_TRUE(rig.look(status));
  EXPECT_EQ(Json::parse(*rig.study->receive())["engaged"].truth(), false);
}

TEST(StudyPortTest, AButtonIsAnAnswerToNoTrialByName) {
  Rig rig;
  rig.port.tell_answer(2, kNow);
  const Json answer = Json::parse(*rig.study->receive());
  EXPECT_EQ(answer["answer"].number(), 2);
  EXPECT_FALSE(answer.contains("trial")) << "the study knows which one asks";
  EXPECT_EQ(answer["at_ns"].number(), 50e9);
}

TEST(StudyPortTest, NotesOfTheStudyAreInTheSessionFile) {
  Rig rig{fresh_file()};
  EXPECT_TRUE(rig.study->send(R"({"note":56,"detail":3})"));
  EXPECT_TRUE(rig.study->send(R"({"note":58,"detail":2,"at_ns":49000000000})"));
  EXPECT_TRUE(rig.look());
  const std::vector<std::pair<std::uint16_t, double>> expected{{56, 3}, {58, 2}};
  EXPECT_EQ(rig.notes(), expected);
}

TEST(StudyPortTest, AStudyThatIsGoneEndsTheSite) {
  Rig rig;
  EXPECT_TRUE(rig.look());
  rig.study.reset();
  EXPECT_FALSE(rig.look());
}

}  // namespace
}  // namespace palp::surgeon
