#pragma once

#include <string>

#include "common/core/result.h"

namespace google::protobuf {
class Descriptor;
class FieldDescriptor;
class Message;
}  // namespace google::protobuf

/// The rules a field carries in its (knob) option, read by reflection. The schema's author sees to
/// it that every field has one; tests hold the schema to it.
namespace palp::config {

/// One value of a field, as a person would type it: a number in its shortest form, true or false,
/// a text between quotes. `index`: of a repeated field, else -1; an absent one gives the default.
[[nodiscard]] std::string value_text(const google::protobuf::Message& settings,
                                     const google::protobuf::FieldDescriptor& field,
                                     int index = -1);

/// Range and choice of one value; the sentence calls the field `name`. Relations between fields are
/// not looked at.
[[nodiscard]] Result<void> check_value(const google::protobuf::Message& settings,
                                       const google::protobuf::FieldDescriptor& field,
                                       int index,
                                       const std::string& name);

/// The relations not_above and instead_of of one field, if it has them; `name` as above.
[[nodiscard]] Result<void> check_relation(const google::protobuf::Message& settings,
                                          const google::protobuf::FieldDescriptor& field,
                                          const std::string& name);

/// The field is a fraction of a whole.
[[nodiscard]] bool is_share(const google::protobuf::FieldDescriptor& field);

/// "k_p of eq. (1) [N/m], 0 to 2000, default 200": what --help says about a field.
[[nodiscard]] std::string describe_knob(const google::protobuf::FieldDescriptor& field);

/// One line per field of the schema and of the groups in it: path and describe_knob().
[[nodiscard]] std::string describe_knobs(const google::protobuf::Descriptor& schema,
                                         const std::string& prefix = {});

}  // namespace palp::config
