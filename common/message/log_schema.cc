#include "common/message/log_schema.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>

#include "common/message/descriptor_builder.h"
#include "common/message/kind.h"
#include "common/message/text_encoding.h"

namespace palp::message {
namespace {

using Bytes = std::vector<std::byte>;
using Builder = DescriptorBuilder;

/// FieldDescriptorProto.Type
template <class Item, class Value>
constexpr unsigned type_number() noexcept {
  if constexpr (std::is_base_of_v<FixedWidth, Item>) {
    return sizeof(Value) == sizeof(std::uint64_t) ? 6 : 7;
  } else if constexpr (kIsText<Value>) {
    return 9;
  } else if constexpr (Described<Value>) {
    return 11;
  } else if constexpr (std::is_enum_v<Value>) {
    return 14;
  } else if constexpr (std::is_same_v<Value, bool>) {
    return 8;
  } else if constexpr (std::is_floating_point_v<NumberOf<Value>>) {
    return std::is_same_v<WidthOf<Form::Log, Item, NumberOf<Value>>, float> ? 2 : 1;
  } else if constexpr (std::is_signed_v<NumberOf<Value>>) {
    return 3;
  } else {
    return sizeof(Value) == sizeof(std::uint64_t) ? 4 : 13;
  }
}

struct FieldText {
  std::string name;
  unsigned number{};
  unsigned type{};
  std::string type_name;  ///< of messages and enums
  bool optional{};
  bool of_oneof{};
};

constexpr std::string_view kSharedPackage{"palp.shared"};
constexpr std::string_view kSharedFile{"shared.proto"};

/// One of the two files in the making: what the message needs, each once.
struct File {
  std::string_view name;
  std::string_view package;
  std::vector<Bytes> messages{};
  std::vector<Bytes> enums{};

  [[nodiscard]] bool empty() const noexcept { return messages.empty() && enums.empty(); }
  [[nodiscard]] std::string full(std::string_view within) const {
    return "." + std::string{package} + "." + std::string{within};
  }
  [[nodiscard]] Bytes descriptor(std::string_view imports) const {
    Builder out;
    out.text(1, name);
    out.text(2, package);
    if (!imports.empty()) out.text(3, imports);
    for (const Bytes& one : messages) out.part(4, one);
    for (const Bytes& one : enums) out.part(5, one);
    out.text(12, "proto3");
    return out.bytes();
  }
};

class Files {
 public:
  explicit Files(bool of_patient) : of_patient_{of_patient} {}

  template <class Struct>
  void add_message(std::string_view name) {
    if (!added_.insert(std::string{name}).second) return;
    std::vector<Bytes>& messages = file_of<Struct>().messages;
    const std::size_t place = messages.size();
    messages.emplace_back();
    Message message{.name = std::string{name}, .fields = {}, .oneof = {}, .enums = {}};
    collect<Struct, 0>(message, "");
    messages[place] = bytes_of(message);
  }

  [[nodiscard]] Bytes descriptor_set() const {
    Builder set;
    if (!shared_.empty()) set.part(1, shared_.descriptor(""));
    set.part(1, log_.descriptor(shared_.empty() ? "" : shared_.name));
    return set.bytes();
  }

 private:
  struct Message {
    std::string name;
    std::vector<FieldText> fields;
    std::string oneof;  ///< empty: it has none
    std::vector<Bytes> enums;
  };

  template <class Struct>
  File& file_of() noexcept {
    return fields<Struct>.names.shared.empty() ? log_ : shared_;
  }
  /// Adds it where a field names it. @returns its full name.
  template <class Struct>
  std::string part_type() {
    constexpr Names kNames = fields<Struct>.names;
    const std::string_view name = kNames.shared.empty() ? kNames.log : kNames.shared;
    add_message<Struct>(name);
    return file_of<Struct>().full(name);
  }

  template <class Struct, unsigned kBase>
  void collect(Message& to, std::string_view prefix) {
    each(fields<Struct>.items,
         [&](const auto& item) { collect_item<Struct, kBase>(item, to, prefix); });
  }

  template <class Struct, unsigned kBase, class Item>
  void collect_item(const Item& item, Message& to, std::string_view prefix) {
    using Value = ValueOf<Item, Struct>;
    if constexpr (requires { item.choices; }) {
      to.oneof = item.name;
      each(item.choices, [&]<class Choice>(const Choice& choice) {
        to.fields.push_back({.name = std::string{choice.name},
                             .number = kBase + number_in<Form::Log, Choice>(),
                             .type = 11,
                             .type_name = part_type<typename Choice::Type>(),
                             .optional = false,
                             .of_oneof = true});
      });
    } else if constexpr (kIsOptional<Value>) {
      collect<typename Value::value_type, kBase + Item::kBase>(to, item.prefix);
    } else if constexpr (requires { item.prefix; }) {
      collect<Value, kBase + Item::kBase>(to, item.prefix);
    } else if constexpr (requires { Item::kNumber; }) {
      add_field<Value, kBase>(item, to, prefix);
    }
  }

  template <class Value, unsigned kBase, class Item>
  void add_field(const Item& item, Message& to, std::string_view prefix) {
    FieldText field;
    field.name = prefix;
    field.name += of_patient_ ? item.name.patient : item.name.surgeon;
    field.number = kBase + number_in<Form::Log, Item>();
    field.type = type_number<Item, Value>();
    field.optional = std::is_base_of_v<Always, Item>;
    if constexpr (Described<Value>) {
      field.type_name = part_type<Value>();
    } else if constexpr (std::is_enum_v<Value>) {
      constexpr auto kEnum = enumerators<Value>;
      const std::string within{kEnum.within.empty() ? "" : std::string{kEnum.within} + "."};
      const std::string name = within + std::string{kEnum.name};
      field.type_name = (within.empty() ? shared_ : log_).full(name);
      if (added_.insert(name).second) {
        (within.empty() ? shared_.enums : to.enums).push_back(enum_bytes(kEnum));
      }
    }
    to.fields.push_back(std::move(field));
  }

  static Bytes enum_bytes(const auto& of) {
    Builder out;
    out.text(1, of.name);
    for (std::size_t i = 0; i < of.values.size(); ++i) {
      Builder value;
      value.text(1, of.values[i]);
      value.number(2, i);
      out.part(2, value.bytes());
    }
    return out.bytes();
  }

  /// A field that is `optional` lies in a oneof of its own, behind those of the schema.
  static Bytes bytes_of(Message& message) {
    std::vector<std::string> oneofs;
    if (!message.oneof.empty()) oneofs.push_back(message.oneof);
    Builder out;
    out.text(1, message.name);
    for (const FieldText& field : message.fields) {
      Builder one;
      one.text(1, field.name);
      one.number(3, field.number);
      one.number(4, 1);  // LABEL_OPTIONAL
      one.number(5, field.type);
      if (!field.type_name.empty()) one.text(6, field.type_name);
      if (field.of_oneof) one.number(9, 0);
      if (field.optional) {
        one.number(9, oneofs.size());
        oneofs.push_back("_" + field.name);
        one.number(17, 1);
      }
      out.part(2, one.bytes());
    }
    for (const Bytes& one : message.enums) out.part(4, one);
    for (const std::string& name : oneofs) {
      Builder one;
      one.text(1, name);
      out.part(8, one.bytes());
    }
    return out.bytes();
  }

  bool of_patient_;
  std::set<std::string> added_;
  File shared_{.name = kSharedFile, .package = kSharedPackage};
  File log_{.name = "session_log.proto", .package = kLogPackage};
};

}  // namespace

template <class Message>
std::string_view log_name(bool of_patient) noexcept {
  constexpr Names kNames = fields<Message>.names;
  return of_patient && !kNames.log_patient.empty() ? kNames.log_patient : kNames.log;
}

template <class Message>
LogSchema log_schema(bool of_patient) {
  const std::string_view name = log_name<Message>(of_patient);
  Files files{of_patient};
  files.add_message<Message>(name);
  return {.name = std::string{kLogPackage} + "." + std::string{name},
          .descriptors = files.descriptor_set()};
}

/// Makes both of each message.
template <class List>
struct SchemaOf;
template <class... Messages>
struct SchemaOf<MessageList<Messages...>> {
  static constexpr std::tuple kName{&log_name<Messages>...};
  static constexpr std::tuple kSchema{&log_schema<Messages>...};
};
template struct SchemaOf<LogMessages>;

}  // namespace palp::message
