#include "common/config/override.h"

#include <limits>
#include <memory>
#include <string>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include "common/config/knob.h"
#include "common/config/number.h"
#include "common/core/printable.h"

namespace palp::config {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// A field and the message it belongs to.
struct Target {
  Message* group{};
  const FieldDescriptor* field{};
};

Result<Target> find_target(std::string_view path, Message& settings) {
  Message* group = &settings;
  std::string_view rest = path;
  while (true) {
    const auto dot = rest.find('.');
    const std::string name{rest.substr(0, dot)};
    const auto* type = group->GetDescriptor();
    const auto* field = type->FindFieldByName(name);
    if (field == nullptr) {
      std::string names;
      for (int i = 0; i < type->field_count(); ++i) {
        names += (i == 0 ? "" : ", ") + type->field(i)->name();
      }
      return fail("there is no field \"" + printable(name) + "\" in \"" + printable(path) +
                  "\", there are: " + names);
    }
    if (field->is_repeated()) {
      return fail(printable(path) + " is a list: set it in a file");
    }
    const bool last = dot == std::string_view::npos;
    if (last && field->message_type() != nullptr) {
      return fail(printable(path) + " is a group of fields: name one of them, such as " +
                  printable(path) + '.' + field->message_type()->field(0)->name());
    }
    if (last) {
      return Target{group, field};
    }
    if (field->message_type() == nullptr) {
      return fail(printable(path) + ": " + name + " has no fields of its own");
    }
    group = group->GetReflection()->MutableMessage(group, field);
    rest.remove_prefix(dot + 1);
  }
}

Result<void> write_whole(std::string_view value, const std::string& shown, const Target& target) {
  const auto whole = parse_whole(value);
  const bool small = target.field->cpp_type() == FieldDescriptor::CPPTYPE_UINT32;
  if (!whole || (small && *whole > std::numeric_limits<std::uint32_t>::max())) {
    return fail(shown + " is not a whole number: " + describe_knob(*target.field));
  }
  const auto& writer = *target.group->GetReflection();
  if (small) {
    writer.SetUInt32(target.group, target.field, static_cast<std::uint32_t>(*whole));
  } else {
    writer.SetUInt64(target.group, target.field, *whole);
  }
  return {};
}

/// Reads `value` as the field's type; `shown` is "name = value".
Result<void> write_value(std::string_view value, const std::string& shown, const Target& target) {
  const auto& writer = *target.group->GetReflection();
  switch (target.field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_STRING:
      writer.SetString(target.group, target.field, std::string{value});
      return {};
    case FieldDescriptor::CPPTYPE_BOOL:
      if (value != "true" && value != "false") {
        return fail(shown + " is neither true nor false");
      }
      writer.SetBool(target.group, target.field, value == "true");
      return {};
    case FieldDescriptor::CPPTYPE_DOUBLE:
      if (const auto number = is_share(*target.field) ? parse_share(value) : parse_number(value)) {
        writer.SetDouble(target.group, target.field, *number);
        return {};
      }
      return fail(shown + " is not a number: " + describe_knob(*target.field));
    default:
      return write_whole(value, shown, target);
  }
}

}  // namespace

Result<void> apply_value(std::string_view path,
                         std::string_view value,
                         std::string_view name,
                         Message& settings) {
  const std::unique_ptr<Message> changed{settings.New()};  // so that an error changes nothing
  changed->CopyFrom(settings);
  const std::string called{printable(name)};
  return find_target(path, *changed).and_then([&](const Target& target) {
    return write_value(value, called + " = " + printable(value), target)
        .and_then([&] { return check_value(*target.group, *target.field, -1, called); })
        .map([&] { settings.CopyFrom(*changed); });
  });
}

Result<void> apply_override(std::string_view assignment, Message& settings) {
  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    return fail('"' + printable(assignment) + "\" is not PATH=VALUE");
  }
  const auto path = assignment.substr(0, equals);
  return apply_value(path, assignment.substr(equals + 1), path, settings);
}

}  // namespace palp::config
