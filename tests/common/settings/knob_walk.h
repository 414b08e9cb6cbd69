#pragma once

#include <functional>
#include <string>

#include <google/protobuf/descriptor.h>

#include "common/config/number.h"
#include "proto/config.pb.h"

/// Every knob of a schema with a value that is not its default.
namespace palp::settings_test {

inline std::string other_value(const google::protobuf::FieldDescriptor& field) {
  using Field = google::protobuf::FieldDescriptor;
  const auto& knob = field.options().GetExtension(proto::config::knob);
  switch (field.cpp_type()) {
    case Field::CPPTYPE_BOOL:
      return field.default_value_bool() ? "false" : "true";
    case Field::CPPTYPE_STRING:
      for (const std::string& choice : knob.one_of()) {
        if (choice != field.default_value_string()) return choice;
      }
      return knob.one_of().empty() ? "other" : "";
    case Field::CPPTYPE_DOUBLE:
      return config::number_text(knob.max() != field.default_value_double() ? knob.max()
                                                                            : knob.min());
    default:
      return config::number_text(knob.max());
  }
}

/// Calls `visit(path, value)`; a knob whose only value is its default is left out.
inline void for_each_knob(const google::protobuf::Descriptor& schema,
                          const std::string& prefix,
                          const std::function<void(std::string, std::string)>& visit) {
  for (int i = 0; i < schema.field_count(); ++i) {
    const auto& field = *schema.field(i);
    const std::string path = prefix + field.name();
    if (const auto* group = field.message_type()) {
      for_each_knob(*group, path + ".", visit);
    } else if (const std::string value = other_value(field); !value.empty()) {
      visit(path, value);
    }
  }
}

}  // namespace palp::settings_test
