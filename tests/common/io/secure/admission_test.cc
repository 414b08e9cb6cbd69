// Goal: a stranger who shows his address cannot spend our time on handshakes, nor crowd others out.
// Method: the bookkeeping alone, then real ClientHellos with a real cookie, passed by hand.
#include "common/io/secure/admission.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/io/secure/associations.h"
#include "tests/common/io/secure/keys_folder.h"

namespace palp::io {
namespace {

using link::Role;
using std::chrono::milliseconds;
using test::KeysFolder;

Endpoint host(int number, int port = 1000) {
  return *resolve_endpoint("192.0.2." + std::to_string(number) + ":" + std::to_string(port));
}

TEST(AdmissionTest, WhoFinishesBeginsAFewInASecondWhateverItsPorts) {
  Admission admission;
  TimePoint now{};
  for (int i = 0; i < static_cast<int>(Admission::kOfOneHost); ++i, now += milliseconds{1}) {
    ASSERT_TRUE(admission.open_to(host(1, 1000 + i), now));
    admission.note(host(1, 1000 + i), now);
    admission.finished(host(1, 1000 + i));
  }
  EXPECT_FALSE(admission.open_to(host(1, 999), now));
  EXPECT_TRUE(admission.open_to(host(2), now));
  EXPECT_FALSE(admission.open_to(host(1), TimePoint{milliseconds{999}}));
  EXPECT_TRUE(admission.open_to(host(1), TimePoint{milliseconds{1000}}));
}

TEST(AdmissionTest, WhoDoesNotFinishBeginsOneASecondUntilThatIsForgotten) {
  Admission admission;
  admission.note(host(1), TimePoint{});
  EXPECT_FALSE(admission.open_to(host(1, 999), TimePoint{milliseconds{999}}));
  EXPECT_TRUE(admission.open_to(host(1, 999), TimePoint{milliseconds{1000}}));
  admission.note(host(1, 999), TimePoint{milliseconds{1000}});
  EXPECT_EQ(admission.debt(host(1)), 2U);
  EXPECT_EQ(admission.debt(host(2)), 0U);
  EXPECT_TRUE(admission.open_to(host(1), TimePoint{Admission::kMemory}));
  EXPECT_EQ(admission.debt(host(1)), 1U);
  admission.finished(host(1, 5));
  EXPECT_EQ(admission.debt(host(1)), 0U);
}

TEST(AdmissionTest, HostsWithUnfinishedOnesLeaveRoomForOthers) {
  Admission admission;
  TimePoint now{};
  for (int i = 0; i < 100; ++i, now += milliseconds{100}) admission.note(host(i), now);
  std::size_t begun = 0;
  for (int i = 0; i < 100; ++i) {
    if (!admission.open_to(host(i), now)) continue;
    admission.note(host(i), now);
    ++begun;
  }
  EXPECT_GE(begun, 1U);
  EXPECT_LE(begun, Admission::kOfDebtors + 1) << "one is forgotten by then";
  EXPECT_TRUE(admission.open_to(host(200), now));
}

TEST(AdmissionTest, AllHostsTogetherBeginNotManyMore) {
  Admission admission;
  for (int i = 0; i < static_cast<int>(Admission::kOfAll); ++i) {
    ASSERT_TRUE(admission.open_to(host(i), TimePoint{}));
    admission.note(host(i), TimePoint{});
  }
  EXPECT_FALSE(admission.open_to(host(200), TimePoint{}));
  EXPECT_TRUE(admission.open_to(host(200), TimePoint{std::chrono::seconds{1}}));
}

/// A patient, and strangers who have each been given a cookie.
class Door {
 public:
  Door()
      : surgeon_keys_{keys_.credentials(Role::Surgeon)},
        patient_keys_{keys_.credentials(Role::Patient)},
        patient{*patient_keys_} {}

  /// A ClientHello that shows the cookie of `from`.
  DtlsDatagram proven_hello(const Endpoint& from) {
    DtlsHandshake caller{*surgeon_keys_};
    patient.hear(caller.take_datagrams().at(0), from, now);
    for (const Letter& answer : patient.take_letters()) caller.hear(answer.bytes);
    return caller.take_datagrams().at(0);
  }
  /// The same with another random, which makes it another attempt. @returns whether it was begun.
  bool begins(DtlsDatagram hello, const Endpoint& from, std::uint64_t number) {
    constexpr std::size_t kRandomAt = 27;
    for (std::size_t i = 0; i < 8; ++i) {
      hello[kRandomAt + i] = static_cast<std::byte>(random_bits(1, 2, number) >> (8 * i));
    }
    patient.hear(hello, from, now);
    return !patient.take_letters().empty();
  }
  /// A surgeon and the patient say what they have to say, once each.
  bool exchange(Associations& surgeon, const Endpoint& from) {
    for (const Letter& one : surgeon.take_letters()) patient.hear(one.bytes, from, now);
    for (const Letter& one : patient.take_letters()) {
      if (one.to == from) surgeon.hear(one.bytes, at, now);
    }
    return !surgeon.take_made().empty();
  }

 private:
  KeysFolder keys_{"door"};

 public:
  std::unique_ptr<Credentials> surgeon_keys_;
  std::unique_ptr<Credentials> patient_keys_;
  Associations patient;
  TimePoint now{};
  Endpoint at{host(100, 2000)};
};

/// Hosts that have each been given a cookie, and show it again and again.
class Idlers {
 public:
  Idlers(Door& door, int hosts) : door_{door} {
    for (int i = 0; i < hosts; ++i) hellos_.push_back(door.proven_hello(host(1 + i)));
  }
  /// @returns how many handshakes they began.
  std::size_t show() {
    std::size_t begun = 0;
    for (int i = 0; i < static_cast<int>(hellos_.size()); ++i) {
      const auto at = static_cast<std::size_t>(i);
      begun += door_.begins(hellos_[at], host(1 + i), ++shown_) ? 1U : 0U;
    }
    return begun;
  }

 private:
  Door& door_;
  std::vector<DtlsDatagram> hellos_;
  std::uint64_t shown_{};
};

TEST(AssociationsTest, ACookieShownAThousandTimesBeginsOneHandshakeAndOthersGetTheirs) {
  Door door;
  Idlers idler{door, 1};
  std::size_t begun = 0;
  for (int i = 0; i < 1000; ++i) begun += idler.show();
  EXPECT_EQ(begun, 1U);
  Associations surgeon{*door.surgeon_keys_};
  surgeon.call(door.at, door.now);
  bool made = false;
  for (int i = 0; i < 5 && !made; ++i) made = door.exchange(surgeon, host(2));
  EXPECT_TRUE(made);
}

TEST(AssociationsTest, HostsThatShowCookiesAndNeverFinishKeepNobodyWaiting) {
  constexpr Duration kStep = milliseconds{50};  // a round trip
  for (const int hosts : {1, 4, 8, 16, 60}) {
    Door door;
    Idlers idlers{door, hosts};
    int honest = 100;
    for (int step = 0; step < 120; ++step, door.now += kStep) {
      (void)idlers.show();
      if (step % 40 != 39) continue;
      Associations surgeon{*door.surgeon_keys_};
      surgeon.call(door.at, door.now);
      bool made = false;
      const Endpoint from = host(++honest);
      for (int trip = 0; trip < 4 && !made; ++trip, door.now += kStep) {
        (void)idlers.show();
        made = door.exchange(surgeon, from);
      }
      EXPECT_TRUE(made) << hosts << " hosts, step " << step;
    }
  }
}

TEST(AssociationsTest, AHandshakeUnderWayIsNotCrowdedOut) {
  Door door;
  Associations surgeon{*door.surgeon_keys_};
  surgeon.call(door.at, door.now);
  const Endpoint from = host(200);
  ASSERT_FALSE(door.exchange(surgeon, from));  // a cookie
  ASSERT_FALSE(door.exchange(surgeon, from));  // the patient's flight; the answer waits
  Idlers idlers{door, 60};
  std::size_t begun = 0;
  for (int i = 0; i < 180; ++i, door.now += milliseconds{50}) begun += idlers.show();
  EXPECT_GT(begun, Associations::kAttemptsMax + 10);
  EXPECT_TRUE(door.exchange(surgeon, from));
}

}  // namespace
}  // namespace palp::io
