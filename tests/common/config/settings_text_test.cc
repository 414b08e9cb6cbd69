#include "common/config/settings_text.h"

#include <cmath>
#include <functional>
#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "proto/config.pb.h"

namespace palp::config {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::util::MessageDifferencer;
using proto::config::LabScenario;
using proto::config::PatientConfig;
using testing::HasSubstr;
using testing::StartsWith;

std::string error_of(const std::string& text, Message& settings) {
  const auto merged = merge_text(text, "a.conf", settings);
  return merged ? "" : merged.error().text;
}

TEST(SettingsTextTest, LaysTheFileOverWhatWasThere) {
  PatientConfig patient;
  patient.mutable_motion_gate()->set_force_stop_n(4);
  patient.mutable_motion_gate()->set_force_limit_n(2);
  ASSERT_TRUE(merge_text("motion_gate { force_limit_n: 2.5 }  # gentle\n", "a.conf", patient));
  EXPECT_EQ(patient.motion_gate().force_limit_n(), 2.5);
  EXPECT_EQ(patient.motion_gate().force_stop_n(), 4);
}

TEST(SettingsTextTest, NamesPlaceValueAndRangeOfWhatIsOutOfRange) {
  LabScenario scenario;
  EXPECT_EQ(error_of("seed: 3\npatient {\n  motion_gate { force_limit_n: 12 }\n}\n", scenario),
            "a.conf:3:17: patient.motion_gate.force_limit_n = 12 is out of range: 0.1 to 10 N");
  EXPECT_EQ(error_of("surgeon { hand { grip: 'soft' } }", scenario),
            "a.conf:1:18: surgeon.hand.grip = \"soft\" is not one of: light, mid, firm, arm");
}

TEST(SettingsTextTest, NamesPlaceAndFieldsOfAnUnknownField) {
  PatientConfig patient;
  EXPECT_EQ(error_of("link {\n  hold_ms: 3\n}", patient),
            "a.conf:2:10: no field \"hold_ms\" in Link, which has: hold_after_ms, lost_after_ms, "
            "round_trip_max_ms, closed_after_s, stale_after_ms, insecure, identity, rekey_after_s, "
            "through, room");
}

TEST(SettingsTextTest, AFileMadeOfAnotherSaysSoAndIsReadBack) {
  PatientConfig patient;
  ASSERT_TRUE(merge_text("motion_gate { force_limit_n: 2.5 }  # gentle\n", "a.conf", patient));
  const std::string text = changed_settings_text(patient, "my\nrig: 1");
  EXPECT_THAT(text,
              StartsWith("# Written by a program, from my?rig: 1. Comments of that file were "
                         "not kept.\nmotion_gate {"));
  EXPECT_THAT(text, testing::Not(HasSubstr("force_stop_n"))) << "only what was given";
  PatientConfig again;
  ASSERT_TRUE(merge_text(text, "written", again));
  EXPECT_TRUE(MessageDifferencer::Equals(patient, again));
}

TEST(SettingsTextTest, RefusesWhatIsNotAFiniteNumber) {
  PatientConfig patient;
  for (const char* value :
       {"nan", "-nan", "inf", "-inf", "infinity", "1e999", "'3'", "three", ""}) {
    const std::string text = std::string{"motion_gate { force_limit_n: "} + value + " }";
    EXPECT_THAT(error_of(text, patient), StartsWith("a.conf:1:")) << value;
  }
}

TEST(SettingsTextTest, RefusesAFieldGivenTwice) {
  PatientConfig patient;
  EXPECT_THAT(error_of("seed: 1\nseed: 2", patient), HasSubstr("multiple times"));
}

TEST(SettingsTextTest, ChangesNothingOnAnError) {
  PatientConfig patient;
  EXPECT_NE(error_of("seed: 7 motion_gate { force_limit_n: 12 }", patient), "");
  EXPECT_NE(error_of("seed: 7 nonsense", patient), "");
  EXPECT_FALSE(patient.has_seed());
}

TEST(SettingsTextTest, RefusesAZeroByteInAText) {
  PatientConfig patient;
  EXPECT_THAT(error_of("record { file: 'a\\000b' }", patient), HasSubstr("zero byte"));
}

TEST(SettingsTextTest, ChecksRelationsOfTheWhole) {
  PatientConfig patient;
  // Alone each is in range; the bound may still come from --set.
  ASSERT_TRUE(merge_text("link { hold_after_ms: 600 }", "a.conf", patient));
  const auto checked = check_settings(patient);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().text, "link.hold_after_ms = 600 is above link.lost_after_ms = 500 ms");
  patient.mutable_link()->set_lost_after_ms(600);
  EXPECT_TRUE(check_settings(patient));
}

TEST(SettingsTextTest, RefusesNumbersBesideTheWordsThatReplaceThem) {
  PatientConfig patient;
  ASSERT_TRUE(merge_text("impairment { spec: 'loss 1%' delay_ms: 5 }", "a.conf", patient));
  const auto checked = check_settings(patient);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().text,
            "impairment.delay_ms = 5 counts nothing beside impairment.spec = \"loss 1%\": give one "
            "of them");
}

TEST(SettingsTextTest, ChecksValuesThatDidNotComeFromText) {
  PatientConfig patient;
  patient.mutable_motion_gate()->set_force_limit_n(std::nan(""));
  ASSERT_FALSE(check_settings(patient));
  EXPECT_EQ(check_settings(patient).error().text,
            "motion_gate.force_limit_n = nan is out of range: 0.1 to 10 N");
}

TEST(SettingsTextTest, EffectiveTextNamesEveryDefaultAndReadsBack) {
  PatientConfig patient;
  patient.set_seed(42);
  patient.mutable_simulated_phantom()->set_phantom("file:a \"b\".csv");
  patient.mutable_motion_gate()->set_force_limit_n(1.0 / 3.0);
  const std::string text = settings_text(patient);
  EXPECT_THAT(text, HasSubstr("sensor_quantum_mn: 50"));
  PatientConfig read;
  ASSERT_TRUE(merge_text(text, "a.conf", read));
  fill_defaults(patient);
  EXPECT_TRUE(MessageDifferencer::Equals(read, patient));
  EXPECT_EQ(settings_text(read), text);
}

TEST(SettingsTextTest, FillingDefaultsKeepsWhatWasSet) {
  PatientConfig patient;
  patient.mutable_loop()->set_lock_memory(false);
  patient.mutable_impairment()->set_delay_ms(7);
  fill_defaults(patient);
  EXPECT_FALSE(patient.loop().lock_memory());
  EXPECT_EQ(patient.impairment().delay_ms(), 7);
  EXPECT_TRUE(patient.estimator().has_filter_hz());
}

/// Visits every single field below `settings`, all groups being there.
void for_each_leaf(Message& settings,
                   const std::function<void(Message&, const FieldDescriptor&)>& visit) {
  const auto& type = *settings.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const auto& field = *type.field(i);
    if (field.message_type() != nullptr) {
      for_each_leaf(*settings.GetReflection()->MutableMessage(&settings, &field), visit);
    } else {
      visit(settings, field);
    }
  }
}

/// The smallest change of a field.
void nudge(Message& group, const FieldDescriptor& field) {
  const auto& access = *group.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      access.SetDouble(&group, &field, std::nextafter(access.GetDouble(group, &field), 1e9));
      break;
    case FieldDescriptor::CPPTYPE_UINT32:
      access.SetUInt32(&group, &field, access.GetUInt32(group, &field) + 1);
      break;
    case FieldDescriptor::CPPTYPE_UINT64:
      access.SetUInt64(&group, &field, access.GetUInt64(group, &field) + 1);
      break;
    case FieldDescriptor::CPPTYPE_BOOL:
      access.SetBool(&group, &field, !access.GetBool(group, &field));
      break;
    default:
      access.SetString(&group, &field, access.GetString(group, &field) + "x");
  }
}

TEST(SettingsHashTest, ChangesWithEveryField) {
  LabScenario scenario;
  fill_defaults(scenario);
  std::set<std::uint64_t> hashes{settings_hash(scenario)};
  std::size_t leaves = 0;
  for_each_leaf(scenario, [&](Message& group, const FieldDescriptor& field) {
    const std::unique_ptr<Message> kept{group.New()};
    kept->CopyFrom(group);
    nudge(group, field);
    EXPECT_TRUE(hashes.insert(settings_hash(scenario)).second) << field.full_name();
    group.CopyFrom(*kept);
    ++leaves;
  });
  EXPECT_EQ(hashes.size(), leaves + 1);
}

TEST(SettingsHashTest, DoesNotCareWhetherADefaultIsWrittenOut) {
  LabScenario absent;
  LabScenario written;
  fill_defaults(written);
  EXPECT_EQ(settings_hash(absent), settings_hash(written));
  absent.mutable_up()->set_delay_ms(0);
  written.mutable_up()->set_delay_ms(-0.0);
  EXPECT_EQ(settings_hash(absent), settings_hash(written));
}

TEST(SettingsHashTest, IsTheSameOnEveryMachine) {
  proto::config::Knob knob;  // any message will do: this one has no defaults that could change
  knob.set_means("a");
  knob.set_max(0.1);
  knob.add_one_of("b");
  // FNV-1a by another program over (path, value) pairs, each behind its length in eight bytes.
  EXPECT_EQ(settings_hash(knob), 0x8af3f7257020b1d5U);
}

/// Words of the schema, numbers and brackets: gets further into the reader than plain noise.
rc::Gen<std::string> almost_settings() {
  const auto word = rc::gen::element<std::string>("motion_gate",
                                                  "link",
                                                  "{",
                                                  "}",
                                                  "<",
                                                  ">",
                                                  ":",
                                                  "[",
                                                  "]",
                                                  ";",
                                                  ",",
                                                  "#",
                                                  "\n",
                                                  "seed",
                                                  "1",
                                                  "-",
                                                  "nan",
                                                  "1e400",
                                                  "force_limit_n",
                                                  "hold_after_ms",
                                                  "record",
                                                  "file",
                                                  "\"",
                                                  "'x'",
                                                  "0x7",
                                                  "[palp.proto.config.knob]",
                                                  "true",
                                                  "18446744073709551616",
                                                  "\\",
                                                  std::string(1, '\0'));
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(word), [](const auto& words) {
    std::string text;
    for (const std::string& one : words) {
      text += one + ' ';
    }
    return text;
  });
}

void expect_orderly(const std::string& text) {
  PatientConfig patient;
  const auto merged = merge_text(text, "a.conf", patient);
  if (merged) {
    RC_ASSERT(merge_text(settings_text(patient), "b.conf", patient));
  } else {
    RC_ASSERT(!patient.ByteSizeLong());
    RC_ASSERT(merged.error().text.rfind("a.conf", 0) == 0);
    RC_ASSERT(merged.error().text.find('\n') == std::string::npos);
  }
}

RC_GTEST_PROP(SettingsTextTest, NoiseGetsOneSentence, (const std::string& text)) {
  expect_orderly(text);
}

RC_GTEST_PROP(SettingsTextTest, AlmostSettingsGetOneSentence, ()) {
  expect_orderly(*almost_settings());
}

TEST(SettingsTextTest, StopsAtDeepNesting) {
  PatientConfig patient;
  std::string text;
  for (int i = 0; i < 100'000; ++i) {
    text += "link {";
  }
  EXPECT_NE(error_of(text, patient), "");
}

}  // namespace
}  // namespace palp::config
