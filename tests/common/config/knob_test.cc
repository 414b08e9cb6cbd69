// The schema itself: what every field of proto/config.proto must carry, and that the checks hold
// each of them to it on both sides of each border.
#include "common/config/knob.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include "common/config/number.h"
#include "common/config/settings_text.h"
#include "proto/config.pb.h"

namespace palp::config {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using testing::HasSubstr;

const proto::config::Knob& knob_of(const FieldDescriptor& field) {
  return field.options().GetExtension(proto::config::knob);
}

bool is_number(const FieldDescriptor& field) {
  return field.type() == FieldDescriptor::TYPE_DOUBLE ||
         field.type() == FieldDescriptor::TYPE_UINT32 ||
         field.type() == FieldDescriptor::TYPE_UINT64;
}

double default_of(const FieldDescriptor& field) {
  switch (field.type()) {
    case FieldDescriptor::TYPE_DOUBLE:
      return field.default_value_double();
    case FieldDescriptor::TYPE_UINT32:
      return field.default_value_uint32();
    default:
      return static_cast<double>(field.default_value_uint64());
  }
}

/// Every settings message, the groups in groups too, each type once.
void for_each_message(const std::function<void(const Descriptor&)>& visit) {
  const auto& file = *proto::config::LabScenario::descriptor()->file();
  for (int i = 0; i < file.message_type_count(); ++i) {
    if (file.message_type(i) != proto::config::Knob::descriptor()) {
      visit(*file.message_type(i));
    }
  }
}

void for_each_field(const std::function<void(const FieldDescriptor&)>& visit) {
  for_each_message([&visit](const Descriptor& type) {
    for (int i = 0; i < type.field_count(); ++i) {
      visit(*type.field(i));
    }
  });
}

std::unique_ptr<Message> empty_message(const Descriptor& type) {
  return std::unique_ptr<Message>{
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(&type)->New()};
}

/// The unit and the end of the name that says so.
const std::map<std::string, std::string>& suffixes() {
  static const std::map<std::string, std::string> table{{"mm", "_mm"},
                                                        {"um", "_um"},
                                                        {"s", "_s"},
                                                        {"ms", "_ms"},
                                                        {"us", "_us"},
                                                        {"N", "_n"},
                                                        {"mN", "_mn"},
                                                        {"Hz", "_hz"},
                                                        {"kPa", "_kpa"},
                                                        {"kg", "_kg"},
                                                        {"N/m", "_n_per_m"},
                                                        {"N/mm", "_n_per_mm"},
                                                        {"N/s", "_n_per_s"},
                                                        {"um/N", "_um_per_n"},
                                                        {"mJ", "_mj"},
                                                        {"N/m^1.5", "_n_per_m15"},
                                                        {"N s/m", "_n_s_per_m"},
                                                        {"m/s", "_m_per_s"},
                                                        {"m/s^2", "_m_per_s2"},
                                                        {"s/m", "_s_per_m"},
                                                        {"1/N", "_per_n"},
                                                        {"ppm", "_ppm"},
                                                        {"kbit/s", "_kbps"},
                                                        {"records", "_records"},
                                                        {"1", ""}};
  return table;
}

TEST(SchemaTest, EveryFieldSaysWhatItMeans) {
  for_each_field([](const FieldDescriptor& field) {
    EXPECT_FALSE(knob_of(field).means().empty()) << field.full_name();
    EXPECT_NE(knob_of(field).means().back(), '.') << field.full_name();
    EXPECT_TRUE(field.is_optional() || field.is_repeated())
        << field.full_name() << ": an absent field means its default";
  });
}

TEST(SchemaTest, EveryNumberHasUnitRangeAndADefaultInside) {
  for_each_field([](const FieldDescriptor& field) {
    const auto& knob = knob_of(field);
    EXPECT_EQ(knob.has_unit(), is_number(field)) << field.full_name();
    EXPECT_EQ(knob.has_min(), is_number(field)) << field.full_name();
    EXPECT_EQ(knob.has_max(), is_number(field)) << field.full_name();
    if (is_number(field)) {
      EXPECT_TRUE(field.has_default_value()) << field.full_name();
      EXPECT_LT(knob.min(), knob.max()) << field.full_name();
      EXPECT_GE(default_of(field), knob.min()) << field.full_name();
      EXPECT_LE(default_of(field), knob.max()) << field.full_name();
      EXPECT_TRUE(std::isfinite(knob.min()) && std::isfinite(knob.max())) << field.full_name();
    } else {
      EXPECT_EQ(field.has_default_value(), field.message_type() == nullptr) << field.full_name();
    }
  });
}

TEST(SchemaTest, NamesEndInTheirUnit) {
  for_each_field([](const FieldDescriptor& field) {
    if (!is_number(field)) {
      return;
    }
    std::string unit = "1";  // of the longest ending the name has
    std::size_t longest = 0;
    for (const auto& [candidate, suffix] : suffixes()) {
      if (suffix.size() > longest && field.name().ends_with(suffix)) {
        unit = candidate;
        longest = suffix.size();
      }
    }
    const std::string given = knob_of(field).unit();
    EXPECT_EQ(given == "share" ? "1" : given, unit) << field.full_name();
  });
}

TEST(SchemaTest, RangesOfWholeNumbersAreExact) {
  for_each_field([](const FieldDescriptor& field) {
    if (is_number(field) && field.type() != FieldDescriptor::TYPE_DOUBLE) {
      EXPECT_GE(knob_of(field).min(), 0) << field.full_name();
      EXPECT_LT(knob_of(field).max(), std::pow(2.0, 53)) << field.full_name();
    }
  });
}

TEST(SchemaTest, RelationsNameANumberOfTheSameUnitBesideThem) {
  for_each_field([](const FieldDescriptor& field) {
    if (knob_of(field).has_not_above()) {
      const auto* bound = field.containing_type()->FindFieldByName(knob_of(field).not_above());
      ASSERT_NE(bound, nullptr) << field.full_name();
      EXPECT_EQ(knob_of(*bound).unit(), knob_of(field).unit()) << field.full_name();
      EXPECT_LE(default_of(field), default_of(*bound)) << field.full_name();
    }
  });
}

TEST(SchemaTest, DefaultsAreAllowedChoices) {
  for_each_message([](const Descriptor& type) {
    const auto checked = check_settings(*empty_message(type));
    EXPECT_TRUE(checked) << type.name() << ": " << checked.error().text;
  });
}

/// Sets `field` alone, to `value`.
Result<void> check_with(const FieldDescriptor& field, double value) {
  const auto settings = empty_message(*field.containing_type());
  const auto& writer = *settings->GetReflection();
  if (field.type() == FieldDescriptor::TYPE_DOUBLE) {
    writer.SetDouble(settings.get(), &field, value);
  } else if (field.type() == FieldDescriptor::TYPE_UINT32) {
    writer.SetUInt32(settings.get(), &field, static_cast<std::uint32_t>(value));
  } else {
    writer.SetUInt64(settings.get(), &field, static_cast<std::uint64_t>(value));
  }
  return check_value(*settings, field, -1, "x");
}

TEST(SchemaTest, EveryRangeHoldsOnBothSidesOfBothBorders) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for_each_field([](const FieldDescriptor& field) {
    if (!is_number(field)) {
      return;
    }
    const double min = knob_of(field).min();
    const double max = knob_of(field).max();
    EXPECT_TRUE(check_with(field, min)) << field.full_name();
    EXPECT_TRUE(check_with(field, max)) << field.full_name();
    if (field.type() == FieldDescriptor::TYPE_DOUBLE) {
      EXPECT_FALSE(check_with(field, std::nextafter(min, -kInfinity))) << field.full_name();
      EXPECT_FALSE(check_with(field, std::nextafter(max, kInfinity))) << field.full_name();
      EXPECT_FALSE(check_with(field, kInfinity)) << field.full_name();
      EXPECT_FALSE(check_with(field, -kInfinity)) << field.full_name();
      EXPECT_FALSE(check_with(field, std::nan(""))) << field.full_name();
    } else {
      EXPECT_FALSE(check_with(field, max + 1)) << field.full_name();
      EXPECT_TRUE(min == 0 || !check_with(field, min - 1)) << field.full_name();
    }
  });
}

TEST(SchemaTest, EveryRelationHoldsUpToEquality) {
  for_each_field([](const FieldDescriptor& field) {
    if (!knob_of(field).has_not_above()) {
      return;
    }
    const auto& bound = *field.containing_type()->FindFieldByName(knob_of(field).not_above());
    const auto settings = empty_message(*field.containing_type());
    const auto& writer = *settings->GetReflection();
    const double value = default_of(field);
    writer.SetDouble(settings.get(), &field, value);
    writer.SetDouble(settings.get(), &bound, value);
    EXPECT_TRUE(check_relation(*settings, field, "x")) << field.full_name();
    writer.SetDouble(settings.get(), &bound, std::nextafter(value, 0));
    EXPECT_FALSE(check_relation(*settings, field, "x")) << field.full_name();
  });
}

TEST(SchemaTest, WhatIsSaidInAnotherWayIsNotSaidTwice) {
  int seen = 0;
  for_each_field([&seen](const FieldDescriptor& field) {
    if (!knob_of(field).has_instead_of()) {
      return;
    }
    ++seen;
    const auto& other = *field.containing_type()->FindFieldByName(knob_of(field).instead_of());
    const auto settings = empty_message(*field.containing_type());
    const auto& writer = *settings->GetReflection();
    writer.SetString(settings.get(), &other, "words");
    EXPECT_TRUE(check_relation(*settings, field, "x")) << field.full_name();
    writer.SetDouble(settings.get(), &field, default_of(field) + 1);
    EXPECT_FALSE(check_relation(*settings, field, "x")) << field.full_name();
    writer.SetString(settings.get(), &other, "");
    EXPECT_TRUE(check_relation(*settings, field, "x")) << field.full_name();
  });
  EXPECT_EQ(seen, 3);
}

TEST(SchemaTest, EveryChoiceIsTakenAndNothingElse) {
  for_each_field([](const FieldDescriptor& field) {
    if (knob_of(field).one_of_size() == 0) {
      return;
    }
    const auto settings = empty_message(*field.containing_type());
    const auto& writer = *settings->GetReflection();
    for (const std::string& choice : knob_of(field).one_of()) {
      writer.SetString(settings.get(), &field, choice);
      EXPECT_TRUE(check_value(*settings, field, -1, "x")) << field.full_name() << ' ' << choice;
    }
    for (const char* other : {"", "LIGHT", "nobody"}) {
      writer.SetString(settings.get(), &field, other);
      EXPECT_FALSE(check_value(*settings, field, -1, "x")) << field.full_name() << ' ' << other;
    }
  });
}

TEST(KnobTest, DescribesMeaningUnitRangeAndDefault) {
  const auto& fields = *proto::config::Direct::descriptor();
  EXPECT_EQ(describe_knob(*fields.FindFieldByName("spring_n_per_m")),
            "k_p of eq. (1) [N/m], 0 to 2000, default 200");
  EXPECT_EQ(describe_knob(*proto::config::Hand::descriptor()->FindFieldByName("grip")),
            "how the simulated hand holds the device: light, mid, firm, arm, default mid");
}

TEST(KnobTest, ListsEveryFieldByThePathThatSetTakes) {
  const std::string list = describe_knobs(*proto::config::LabScenario::descriptor());
  EXPECT_THAT(list, HasSubstr("  patient.motion_gate.force_limit_n\n      contact force above"));
  EXPECT_THAT(list, HasSubstr("  surgeon.coupling.direct.spring_n_per_m\n"));
  EXPECT_THAT(list, HasSubstr("  seed\n"));
}

TEST(KnobTest, WritesValuesAsTyped) {
  proto::config::SurgeonConfig surgeon;
  const auto& fields = *surgeon.GetDescriptor();
  surgeon.set_seed(9007199254740993);  // 2^53 + 1 is no double
  EXPECT_EQ(value_text(surgeon, *fields.FindFieldByName("seed")), "9007199254740993");
  surgeon.set_peer("a\nb");
  EXPECT_EQ(value_text(surgeon, *fields.FindFieldByName("peer")), "\"a?b\"");
  EXPECT_EQ(value_text(surgeon, *fields.FindFieldByName("duration_s")), "0");
}

}  // namespace
}  // namespace palp::config
