#pragma once

#include <string>
#include <string_view>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include "common/core/check.h"
#include "common/message/field.h"
#include "common/message/kind.h"

/// The oracle: structs to messages of protobuf and back, field by field by its name and through
/// protobuf's own code, which has numbers, types and bytes from the schema alone.
namespace palp::message {

using google::protobuf::FieldDescriptor;

inline const FieldDescriptor& field_of(const google::protobuf::Message& message,
                                       const std::string& name) {
  const auto* field = message.GetDescriptor()->FindFieldByName(name);
  PALP_CHECK(field != nullptr, ("the schema has no field " + name).c_str());
  return *field;
}

template <class Struct>
void to_protobuf(const Struct& from,
                 google::protobuf::Message& to,
                 bool of_patient,
                 const std::string& prefix = {});

inline void set_number(google::protobuf::Message& to, const FieldDescriptor& field, auto number) {
  const auto& reflection = *to.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_FLOAT:
      return reflection.SetFloat(&to, &field, static_cast<float>(number));
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return reflection.SetDouble(&to, &field, static_cast<double>(number));
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.SetBool(&to, &field, number != 0);
    case FieldDescriptor::CPPTYPE_UINT32:
      return reflection.SetUInt32(&to, &field, static_cast<std::uint32_t>(number));
    case FieldDescriptor::CPPTYPE_UINT64:
      return reflection.SetUInt64(&to, &field, static_cast<std::uint64_t>(number));
    case FieldDescriptor::CPPTYPE_INT64:
      return reflection.SetInt64(&to, &field, static_cast<std::int64_t>(number));
    case FieldDescriptor::CPPTYPE_ENUM:
      return reflection.SetEnumValue(&to, &field, static_cast<int>(number));
    default:
      PALP_CHECK(false, "no number");
  }
}

template <class Struct>
void to_protobuf(const Struct& from,
                 google::protobuf::Message& to,
                 bool of_patient,
                 const std::string& prefix) {
  const auto part = [&](std::string_view name) -> google::protobuf::Message& {
    return *to.GetReflection()->MutableMessage(&to, &field_of(to, std::string{name}));
  };
  each(fields<Struct>.items, [&]<class Item>(const Item& item) {
    const auto& value = Item::of(from);
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (requires { Item::exists(from); }) {
      if (!Item::exists(from)) return;
    }
    if constexpr (requires { Item::says_nothing(value); }) {
      if (Item::says_nothing(value)) return;
    }
    if constexpr (requires { item.none; }) {
      if (value == item.none) return;
    }
    if constexpr (requires { item.choices; }) {
      each(item.choices, [&]<class Choice>(const Choice& choice) {
        const auto* chosen = std::get_if<typename Choice::Type>(&value);
        if (chosen != nullptr) to_protobuf(*chosen, part(choice.name), of_patient);
      });
    } else if constexpr (kIsOptional<Value>) {
      if (value) to_protobuf(*value, to, of_patient, prefix + std::string{item.prefix});
    } else if constexpr (requires { item.prefix; }) {
      to_protobuf(value, to, of_patient, prefix + std::string{item.prefix});
    } else if constexpr (requires { Item::kNumber; }) {
      const std::string name{prefix +
                             std::string{of_patient ? item.name.patient : item.name.surgeon}};
      if constexpr (Described<Value>) {
        to_protobuf(value, part(name), of_patient);
      } else if constexpr (kIsText<Value>) {
        to.GetReflection()->SetString(&to, &field_of(to, name), std::string{value});
      } else {
        set_number(to, field_of(to, name), number_of(value));
      }
    }
  });
}

template <class Struct>
void from_protobuf(const google::protobuf::Message& from,
                   Struct& to,
                   bool of_patient,
                   const std::string& prefix = {});

/// What an enum of ours cannot hold becomes an enumerator that is out of range.
template <class Value>
void get_number(const google::protobuf::Message& from, const FieldDescriptor& field, Value& to) {
  const auto& reflection = *from.GetReflection();
  const auto set = [&](auto number) {
    to = from_number<Value>(static_cast<NumberOf<Value>>(number));
  };
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_FLOAT:
      return set(double{reflection.GetFloat(from, &field)});
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return set(reflection.GetDouble(from, &field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return set(reflection.GetBool(from, &field));
    case FieldDescriptor::CPPTYPE_UINT32:
      return set(reflection.GetUInt32(from, &field));
    case FieldDescriptor::CPPTYPE_UINT64:
      return set(reflection.GetUInt64(from, &field));
    case FieldDescriptor::CPPTYPE_INT64:
      return set(reflection.GetInt64(from, &field));
    case FieldDescriptor::CPPTYPE_ENUM: {
      const int value = reflection.GetEnumValue(from, &field);
      constexpr int kOutOfRange = 0xFF;
      return set(value >= 0 && value < kOutOfRange ? value : kOutOfRange);
    }
    default:
      PALP_CHECK(false, "no number");
  }
}

template <class Struct>
void from_protobuf(const google::protobuf::Message& from,
                   Struct& to,
                   bool of_patient,
                   const std::string& prefix) {
  const auto& reflection = *from.GetReflection();
  const auto has = [&](std::string_view name) {
    return reflection.HasField(from, &field_of(from, std::string{name}));
  };
  const auto part = [&](std::string_view name) -> const google::protobuf::Message& {
    return reflection.GetMessage(from, &field_of(from, std::string{name}));
  };
  each(fields<Struct>.items, [&]<class Item>(const Item& item) {
    auto& value = Item::of(to);
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (requires { item.choices; }) {
      each(item.choices, [&]<class Choice>(const Choice& choice) {
        if (!has(choice.name)) return;
        from_protobuf(
            part(choice.name), value.template emplace<typename Choice::Type>(), of_patient);
      });
    } else if constexpr (kIsOptional<Value>) {
      const auto& first = std::get<0>(fields<typename Value::value_type>.items);
      const std::string inner = prefix + std::string{item.prefix};
      if (!has(inner + std::string{first.name.surgeon})) return;
      from_protobuf(from, value.emplace(), of_patient, inner);
    } else if constexpr (requires { item.prefix; }) {
      from_protobuf(from, value, of_patient, prefix + std::string{item.prefix});
    } else if constexpr (requires { Item::kNumber; }) {
      const std::string name{prefix +
                             std::string{of_patient ? item.name.patient : item.name.surgeon}};
      if constexpr (Described<Value>) {
        from_protobuf(part(name), value, of_patient);
        if constexpr (requires { Item::says_nothing(value); }) {
          if (Item::says_nothing(value)) value = {};
        }
      } else if constexpr (requires { item.none; }) {
        value = item.none;
        if (has(name)) get_number(from, field_of(from, name), value);
      } else if constexpr (!kIsText<Value>) {
        get_number(from, field_of(from, name), value);
      }
    }
  });
}

}  // namespace palp::message
