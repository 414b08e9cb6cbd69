#include "common/record/link_events.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::record {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What is noted of one link after the other.
class Journal {
 public:
  std::vector<NoteCode> look(LinkState state, std::uint64_t session, std::uint8_t key = 0) {
    std::vector<NoteCode> noted;
    LinkHealth health;
    health.state = state;
    health.session_id = session;
    health.key = key;
    events_.look(health, [&](NoteCode code, double) { noted.push_back(code); });
    return noted;
  }

 private:
  LinkEvents events_;
};

TEST(LinkEventsTest, EachChangeOfStateIsNotedOnce) {
  Journal journal;
  EXPECT_THAT(journal.look(LinkState::Down, 0), IsEmpty());
  EXPECT_THAT(journal.look(LinkState::Live, 1), ElementsAre(NoteCode::LinkIsLive));
  EXPECT_THAT(journal.look(LinkState::Live, 1), IsEmpty());
  EXPECT_THAT(journal.look(LinkState::Hold, 1), ElementsAre(NoteCode::LinkHolds));
  EXPECT_THAT(journal.look(LinkState::Lost, 1), ElementsAre(NoteCode::LinkIsLost));
  EXPECT_THAT(journal.look(LinkState::Live, 1), ElementsAre(NoteCode::LinkIsLive));
  EXPECT_THAT(journal.look(LinkState::Down, 0), ElementsAre(NoteCode::LinkIsDown));
}

TEST(LinkEventsTest, OtherKeysAreNotedWithinASessionOnly) {
  Journal journal;
  EXPECT_THAT(journal.look(LinkState::Live, 1, 0), ElementsAre(NoteCode::LinkIsLive));
  EXPECT_THAT(journal.look(LinkState::Live, 1, 1), ElementsAre(NoteCode::KeysReplaced));
  EXPECT_THAT(journal.look(LinkState::Live, 1, 1), IsEmpty());
  EXPECT_THAT(journal.look(LinkState::Live, 2, 0), IsEmpty()) << "another session, its first keys";
}

}  // namespace
}  // namespace palp::record
