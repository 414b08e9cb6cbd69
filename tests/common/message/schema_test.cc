// Goal: the .proto files are the authority. Method: each list beside the descriptor of its message,
// and the descriptors that files carry beside those of protobuf's compiler.
#include <map>
#include <set>
#include <string>

#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "common/message/kind.h"
#include "common/message/log_schema.h"
#include "proto/link.pb.h"
#include "proto/session_log.pb.h"
#include "proto/shared.pb.h"
#include "tests/common/message/all_structs.h"

namespace palp::message {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

/// What a list says of one field.
struct Said {
  int number{};
  FieldDescriptor::Type type{};
  std::string type_name;  ///< of messages and enums, without package
  bool optional{};
  std::string oneof;
};
using Saids = std::map<std::string, Said>;

template <Form kForm, class Item, class Value>
FieldDescriptor::Type type_of() {
  if constexpr (kIsText<Value>) {
    return FieldDescriptor::TYPE_STRING;
  } else if constexpr (Described<Value>) {
    return FieldDescriptor::TYPE_MESSAGE;
  } else if constexpr (std::is_enum_v<Value>) {
    return FieldDescriptor::TYPE_ENUM;
  } else if constexpr (std::is_same_v<Value, bool>) {
    return FieldDescriptor::TYPE_BOOL;
  } else {
    using Width = WidthOf<kForm, Item, NumberOf<Value>>;
    constexpr bool kFixed = std::is_base_of_v<FixedWidth, Item>;
    if constexpr (std::is_same_v<Width, float>) return FieldDescriptor::TYPE_FLOAT;
    if constexpr (std::is_same_v<Width, double>) return FieldDescriptor::TYPE_DOUBLE;
    if constexpr (std::is_same_v<Width, std::int64_t>) return FieldDescriptor::TYPE_INT64;
    if constexpr (sizeof(Width) == 8) {
      return kFixed ? FieldDescriptor::TYPE_FIXED64 : FieldDescriptor::TYPE_UINT64;
    }
    return kFixed ? FieldDescriptor::TYPE_FIXED32 : FieldDescriptor::TYPE_UINT32;
  }
}

template <Form kForm, class Struct>
std::string message_name() {
  constexpr Names kNames = fields<Struct>.names;
  if (!kNames.shared.empty()) return std::string{kNames.shared};
  return std::string{kForm == Form::Wire ? kNames.wire : kNames.log};
}

template <Form kForm, class Struct, unsigned kBase = 0>
void collect(Saids& said, bool of_patient, const std::string& prefix = {}) {
  each(fields<Struct>.items, [&]<class Item>(const Item& item) {
    using Value = ValueOf<Item, Struct>;
    if constexpr (requires { item.choices; }) {
      each(item.choices, [&]<class Choice>(const Choice& choice) {
        said[std::string{choice.name}] = {
            .number = static_cast<int>(kBase + number_in<kForm, Choice>()),
            .type = FieldDescriptor::TYPE_MESSAGE,
            .type_name = message_name<kForm, typename Choice::Type>(),
            .optional = false,
            .oneof = std::string{item.name}};
      });
    } else if constexpr (kIsOptional<Value>) {
      collect<kForm, typename Value::value_type, kBase + Item::kBase>(
          said, of_patient, prefix + std::string{item.prefix});
    } else if constexpr (requires { item.prefix; }) {
      collect<kForm, Value, kBase + Item::kBase>(
          said, of_patient, prefix + std::string{item.prefix});
    } else if constexpr (requires { Item::kNumber; }) {
      Said one{.number = static_cast<int>(kBase + number_in<kForm, Item>()),
               .type = type_of<kForm, Item, Value>(),
               .type_name = {},
               .optional = std::is_base_of_v<Always, Item> || requires {item.none;
    }
    , .oneof = {}};
      if constexpr (Described<Value>) {
    one.type_name = message_name<kForm, Value>();
      } else if constexpr (std::is_enum_v<Value>) {
    one.type_name = enumerators<Value>.name;
      }
      said[prefix + std::string{of_patient ? item.name.patient : item.name.surgeon}] = one;
}
});
}

Saids saids_of(const Descriptor& schema) {
  Saids found;
  for (int i = 0; i < schema.field_count(); ++i) {
    const FieldDescriptor& field = *schema.field(i);
    const auto* message = field.message_type();
    const auto* enumeration = field.enum_type();
    const auto* oneof = field.real_containing_oneof();
    EXPECT_FALSE(field.is_repeated()) << field.full_name();
    found[field.name()] = {
        .number = field.number(),
        .type = field.type(),
        .type_name = message != nullptr ? message->name()
                                        : (enumeration != nullptr ? enumeration->name() : ""),
        .optional = field.has_presence() && oneof == nullptr && message == nullptr,
        .oneof = oneof == nullptr ? "" : oneof->name()};
  }
  return found;
}

void expect_alike(const Saids& list, const Descriptor& schema) {
  const Saids authority = saids_of(schema);
  for (const auto& [name, said] : list) {
    const auto there = authority.find(name);
    if (there == authority.end()) {
      ADD_FAILURE() << schema.full_name() << " has no field " << name;
      continue;
    }
    EXPECT_EQ(said.number, there->second.number) << schema.full_name() << "." << name;
    EXPECT_EQ(said.type, there->second.type) << schema.full_name() << "." << name;
    EXPECT_EQ(said.type_name, there->second.type_name) << schema.full_name() << "." << name;
    EXPECT_EQ(said.optional, there->second.optional) << schema.full_name() << "." << name;
    EXPECT_EQ(said.oneof, there->second.oneof) << schema.full_name() << "." << name;
  }
  for (const auto& [name, said] : authority) {
    EXPECT_TRUE(list.contains(name)) << schema.full_name() << "." << name << " is in no list";
  }
}

const Descriptor* find(const std::string& package, std::string_view name) {
  return DescriptorPool::generated_pool()->FindMessageTypeByName(package + "." + std::string{name});
}

class SchemaTest : public testing::Test {
 protected:
  // Else the linker leaves the schemas out.
  static void SetUpTestSuite() {
    (void)link::wire::Telegram::descriptor();
    (void)session::SurgeonTick::descriptor();
  }
};

/// Compares the lists that name a message there, in one form. @returns the names.
template <Form kForm>
std::set<std::string> compare_with(const std::string& package,
                                   std::string_view Names::*name_of,
                                   bool of_patient = false) {
  std::set<std::string> compared;
  each_struct([&]<class Struct>() {
    constexpr Names kNames = fields<Struct>.names;
    const std::string_view name = kNames.*name_of;
    if (name.empty()) return;
    const Descriptor* schema = find(package, name);
    ASSERT_NE(schema, nullptr) << name;
    Saids said;
    collect<kForm, Struct>(said, of_patient);
    expect_alike(said, *schema);
    compared.emplace(name);
  });
  return compared;
}

std::size_t message_count(const Descriptor& any_of_the_file) {
  return static_cast<std::size_t>(any_of_the_file.file()->message_type_count());
}

TEST_F(SchemaTest, ListsOfTheWireAreThoseOfLinkProto) {
  const auto compared = compare_with<Form::Wire>("palp.link.wire", &Names::wire);
  const std::size_t by_protobuf = 2;  // Hello, Bye
  EXPECT_EQ(compared.size() + by_protobuf, message_count(*link::wire::Telegram::descriptor()));
}

TEST_F(SchemaTest, ListsOfTheLogAreThoseOfSessionLogProto) {
  auto compared = compare_with<Form::Log>("palp.session", &Names::log);
  compared.merge(compare_with<Form::Log>("palp.session", &Names::log_patient, true));
  EXPECT_EQ(compared.size(), message_count(*session::SurgeonTick::descriptor()));
}

TEST_F(SchemaTest, ListsOfBothAreThoseOfSharedProtoInBothForms) {
  const auto on_wire = compare_with<Form::Wire>("palp.shared", &Names::shared);
  const auto in_log = compare_with<Form::Log>("palp.shared", &Names::shared);
  EXPECT_EQ(on_wire, in_log);
  EXPECT_EQ(on_wire.size(), message_count(*shared::Devices::descriptor()));
}

template <class Enum>
void expect_values(const EnumDescriptor& schema) {
  constexpr auto kEnum = enumerators<Enum>;
  ASSERT_EQ(static_cast<std::size_t>(schema.value_count()), kEnum.values.size()) << kEnum.name;
  for (int i = 0; i < schema.value_count(); ++i) {
    EXPECT_EQ(schema.value(i)->number(), i) << schema.full_name();
    EXPECT_EQ(schema.value(i)->name(), kEnum.values[static_cast<std::size_t>(i)]);
  }
}

TEST_F(SchemaTest, EnumsAreThoseOfTheFiles) {
  expect_values<SiteState>(*shared::SiteState_descriptor());
  expect_values<LinkState>(*shared::LinkState_descriptor());
  expect_values<DepthVerdict>(*shared::DepthVerdict_descriptor());
  expect_values<DepthReason>(*shared::DepthReason_descriptor());
  expect_values<EventKind>(*session::Event::Kind_descriptor());
}

using google::protobuf::FileDescriptorProto;
using google::protobuf::FileDescriptorSet;

/// The file of `type`, made where there is none.
FileDescriptorProto& file_of(const google::protobuf::FileDescriptor& of, FileDescriptorSet& set) {
  for (auto& file : *set.mutable_file()) {
    if (file.name() == of.name()) return file;
  }
  auto& file = *set.add_file();
  file.set_name(of.name());
  file.set_package(of.package());
  file.set_syntax("proto3");
  return file;
}

/// Copies `type` and what its fields need, each once.
void add_type(const Descriptor& type, std::set<std::string>& added, FileDescriptorSet& set) {
  if (!added.insert(type.full_name()).second) return;
  auto& copy = *file_of(*type.file(), set).add_message_type();
  type.CopyTo(&copy);
  copy.clear_reserved_range();  // says nothing of bytes
  for (int k = 0; k < type.field_count(); ++k) {
    const auto& field = *type.field(k);
    if (field.message_type() != nullptr) add_type(*field.message_type(), added, set);
    const auto* enumeration = field.enum_type();
    if (enumeration != nullptr && enumeration->containing_type() == nullptr &&
        added.insert(enumeration->full_name()).second) {
      enumeration->CopyTo(file_of(*enumeration->file(), set).add_enum_type());
    }
  }
}

TEST_F(SchemaTest, FilesCarryWhatTheCompilerSaysOfTheirMessages) {
  using google::protobuf::util::MessageDifferencer;
  each_log_message([]<class Message>() {
    for (const bool of_patient : {false, true}) {
      if (!in_file_of<Message>(of_patient)) continue;
      const LogSchema schema = log_schema<Message>(of_patient);
      FileDescriptorSet ours;
      ASSERT_TRUE(ours.ParseFromArray(schema.descriptors.data(),
                                      static_cast<int>(schema.descriptors.size())));
      const Descriptor* type = DescriptorPool::generated_pool()->FindMessageTypeByName(schema.name);
      ASSERT_NE(type, nullptr) << schema.name;
      FileDescriptorSet expected;
      std::set<std::string> added;
      add_type(*type, added, expected);
      if (expected.file_size() == 2) {
        file_of(*type->file(), expected)
            .add_dependency(shared::Devices::descriptor()->file()->name());
      }
      MessageDifferencer differ;
      differ.set_repeated_field_comparison(MessageDifferencer::AS_SET);
      std::string difference;
      differ.ReportDifferencesToString(&difference);
      EXPECT_TRUE(differ.Compare(expected, ours)) << schema.name << "\n" << difference;
      // A reader that builds the types can.
      DescriptorPool pool;
      for (const auto& file : ours.file()) {
        EXPECT_NE(pool.BuildFile(file), nullptr) << schema.name;
      }
    }
  });
}

}  // namespace
}  // namespace palp::message
