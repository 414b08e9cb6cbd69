#include "common/config/knob.h"

#include <algorithm>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include "common/config/number.h"
#include "common/core/check.h"
#include "common/core/printable.h"
#include "proto/config.pb.h"

namespace palp::config {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const proto::config::Knob& knob_of(const FieldDescriptor& field) {
  return field.options().GetExtension(proto::config::knob);
}

bool is_number(const FieldDescriptor& field) {
  return field.cpp_type() != FieldDescriptor::CPPTYPE_BOOL &&
         field.cpp_type() != FieldDescriptor::CPPTYPE_STRING &&
         field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE;
}

/// A numeric value; whole ones are exact up to 2^53, beyond which no range reaches.
double number_of(const Message& settings, const FieldDescriptor& field, int index) {
  const auto& reader = *settings.GetReflection();
  const bool one = index < 0;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return one ? reader.GetDouble(settings, &field)
                 : reader.GetRepeatedDouble(settings, &field, index);
    case FieldDescriptor::CPPTYPE_UINT32:
      return one ? reader.GetUInt32(settings, &field)
                 : reader.GetRepeatedUInt32(settings, &field, index);
    case FieldDescriptor::CPPTYPE_UINT64:
      return static_cast<double>(one ? reader.GetUInt64(settings, &field)
                                     : reader.GetRepeatedUInt64(settings, &field, index));
    default:
      PALP_CHECK(false, "a number in proto/config.proto is double, uint32 or uint64");
      return 0;
  }
}

std::string text_of(const Message& settings, const FieldDescriptor& field, int index) {
  const auto& reader = *settings.GetReflection();
  return index < 0 ? reader.GetString(settings, &field)
                   : reader.GetRepeatedString(settings, &field, index);
}

bool flag_of(const Message& settings, const FieldDescriptor& field, int index) {
  const auto& reader = *settings.GetReflection();
  return index < 0 ? reader.GetBool(settings, &field)
                   : reader.GetRepeatedBool(settings, &field, index);
}

std::string choices(const proto::config::Knob& knob) {
  std::string text;
  for (const std::string& choice : knob.one_of()) {
    text += text.empty() ? choice : ", " + choice;
  }
  return text;
}

std::string default_text(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return number_text(field.default_value_double());
    case FieldDescriptor::CPPTYPE_UINT32:
      return std::to_string(field.default_value_uint32());
    case FieldDescriptor::CPPTYPE_UINT64:
      return std::to_string(field.default_value_uint64());
    case FieldDescriptor::CPPTYPE_BOOL:
      return field.default_value_bool() ? "true" : "false";
    default:
      return field.default_value_string();
  }
}

const FieldDescriptor& sibling(const FieldDescriptor& field, const std::string& name) {
  const FieldDescriptor* const found = field.containing_type()->FindFieldByName(name);
  PALP_CHECK(found != nullptr, "a relation names a field of the same message");
  return *found;
}

}  // namespace

std::string value_text(const Message& settings, const FieldDescriptor& field, int index) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_STRING:
      return '"' + printable(text_of(settings, field, index)) + '"';
    case FieldDescriptor::CPPTYPE_BOOL:
      return flag_of(settings, field, index) ? "true" : "false";
    case FieldDescriptor::CPPTYPE_UINT64:  // all digits
      return std::to_string(
          index < 0 ? settings.GetReflection()->GetUInt64(settings, &field)
                    : settings.GetReflection()->GetRepeatedUInt64(settings, &field, index));
    default:
      return number_text(number_of(settings, field, index));
  }
}

Result<void> check_value(const Message& settings,
                         const FieldDescriptor& field,
                         int index,
                         const std::string& name) {
  const proto::config::Knob& knob = knob_of(field);
  if (is_number(field)) {
    const double value = number_of(settings, field, index);
    if (!(value >= knob.min() && value <= knob.max())) {  // nan is in no range
      return fail(name + " = " + value_text(settings, field, index) +
                  " is out of range: " + range_text(knob.min(), knob.max(), knob.unit()));
    }
  } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
    const std::string value = text_of(settings, field, index);
    if (value.find('\0') != std::string::npos) {
      return fail(name + " = " + value_text(settings, field, index) + " contains a zero byte");
    }
    if (knob.one_of_size() > 0 &&
        std::find(knob.one_of().begin(), knob.one_of().end(), value) == knob.one_of().end()) {
      return fail(name + " = " + value_text(settings, field, index) +
                  " is not one of: " + choices(knob));
    }
  }
  return {};
}

Result<void> check_relation(const Message& settings,
                            const FieldDescriptor& field,
                            const std::string& name) {
  const proto::config::Knob& knob = knob_of(field);
  const auto dot = name.rfind('.');
  const std::string group = dot == std::string::npos ? "" : name.substr(0, dot + 1);
  if (knob.has_not_above()) {
    const FieldDescriptor& bound = sibling(field, knob.not_above());
    if (number_of(settings, field, -1) > number_of(settings, bound, -1)) {
      return fail(name + " = " + value_text(settings, field) + " is above " + group + bound.name() +
                  " = " + value_text(settings, bound) +
                  (knob.unit() == "1" ? "" : ' ' + knob.unit()));
    }
  }
  if (knob.has_instead_of()) {
    const FieldDescriptor& other = sibling(field, knob.instead_of());
    if (!text_of(settings, other, -1).empty() &&
        number_of(settings, field, -1) != field.default_value_double()) {
      return fail(name + " = " + value_text(settings, field) + " counts nothing beside " + group +
                  other.name() + " = " + value_text(settings, other) + ": give one of them");
    }
  }
  return {};
}

bool is_share(const FieldDescriptor& field) { return knob_of(field).unit() == "share"; }

std::string describe_knob(const FieldDescriptor& field) {
  const proto::config::Knob& knob = knob_of(field);
  std::string text = knob.means();
  if (is_number(field)) {
    const bool bare = knob.unit() == "1" || knob.unit() == "share";
    text += bare ? ", " : " [" + knob.unit() + "], ";
    text += range_text(knob.min(), knob.max(), bare ? knob.unit() : "");
  } else if (knob.one_of_size() > 0) {
    text += ": " + choices(knob);
  }
  if (!field.is_repeated() && !default_text(field).empty()) {
    text += ", default " + default_text(field);
  }
  return text;
}

std::string describe_knobs(const Descriptor& schema, const std::string& prefix) {
  std::string text;
  for (int i = 0; i < schema.field_count(); ++i) {
    const FieldDescriptor& field = *schema.field(i);
    const std::string path = prefix + field.name();
    if (field.message_type() != nullptr) {
      text += describe_knobs(*field.message_type(), path + '.');
    } else {
      text += "  " + path + "\n      " + describe_knob(field) + '\n';
    }
  }
  return text;
}

}  // namespace palp::config
