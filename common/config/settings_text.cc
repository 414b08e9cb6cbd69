#include "common/config/settings_text.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include "common/config/knob.h"
#include "common/config/number.h"
#include "common/core/printable.h"

namespace palp::config {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

/// Counted from 0; -1: not known.
struct Place {
  int line{-1};
  int column{-1};
};

std::string sentence_at(std::string_view name, Place place, std::string_view what) {
  std::string text = printable(name);
  if (place.line >= 0) {
    text += ':' + std::to_string(place.line + 1) + ':' + std::to_string(place.column + 1);
  }
  return text.append(": ").append(what);
}

/// Keeps the first complaint of the parser.
class FirstComplaint final : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, int column, const std::string& message) override {
    if (!text_) {
      place_ = {line, column};
      text_ = message;
    }
  }
  [[nodiscard]] Place place() const { return place_; }
  [[nodiscard]] std::string text() const { return text_.value_or("not understood"); }

 private:
  Place place_;
  std::optional<std::string> text_;
};

/// The parser's complaint about an unknown field, in our words and with what there is; other
/// complaints as they are.
std::string plain_words(const std::string& complaint, const Message& settings) {
  const std::string before_type = "Message type \"";
  const std::string before_field = "\" has no field named \"";
  const auto middle = complaint.find(before_field);
  if (complaint.rfind(before_type, 0) == 0 && middle != std::string::npos) {
    const auto type = complaint.substr(before_type.size(), middle - before_type.size());
    const auto* group = settings.GetDescriptor()->file()->pool()->FindMessageTypeByName(type);
    if (group != nullptr) {
      const auto begin = middle + before_field.size();
      std::string field = complaint.substr(begin, complaint.rfind('"') - begin);
      field = "no field \"" + printable(field) + "\" in " + group->name() + ", which has:";
      for (int i = 0; i < group->field_count(); ++i) {
        field += (i == 0 ? " " : ", ") + group->field(i)->name();
      }
      return field;
    }
  }
  return printable(complaint);
}

/// The fields that are set, parents before children; stops at the first error of `visit`, which is
/// called with (message, field, index, path) for each single value.
template <class Visit>
Result<void> for_each_value(const Message& settings, const std::string& prefix, Visit&& visit) {
  std::vector<const FieldDescriptor*> fields;
  const auto& reader = *settings.GetReflection();
  reader.ListFields(settings, &fields);
  for (const FieldDescriptor* field : fields) {
    const bool repeated = field->is_repeated();
    const int count = repeated ? reader.FieldSize(settings, field) : 1;
    for (int i = 0; i < count; ++i) {
      const int index = repeated ? i : -1;
      const std::string path =
          prefix + field->name() + (repeated ? '[' + std::to_string(i) + ']' : "");
      Result<void> result;
      if (field->message_type() != nullptr) {
        const Message& group = repeated ? reader.GetRepeatedMessage(settings, field, i)
                                        : reader.GetMessage(settings, field);
        result = for_each_value(group, path + '.', visit);
      } else {
        result = visit(settings, *field, index, path);
      }
      if (!result) {
        return result;
      }
    }
  }
  return {};
}

/// Finds where in a text a value stood: the tree of a message of the same shape.
Place place_of(const TextFormat::ParseInfoTree* tree, std::string_view path, const Message& root) {
  const auto* type = root.GetDescriptor();
  while (tree != nullptr && type != nullptr) {
    const auto dot = path.find('.');
    std::string_view name = path.substr(0, dot);
    const auto bracket = name.find('[');
    int index = -1;
    if (bracket != std::string_view::npos) {
      const auto digits = name.substr(bracket + 1, name.size() - bracket - 2);
      index = static_cast<int>(parse_whole(digits).value_or(0));
      name = name.substr(0, bracket);
    }
    const auto* field = type->FindFieldByName(std::string{name});
    if (field == nullptr) {
      return {};
    }
    if (dot == std::string_view::npos) {
      const auto found = tree->GetLocation(field, index);
      return {found.line, found.column};
    }
    tree = tree->GetTreeForNested(field, index);
    type = field->message_type();
    path.remove_prefix(dot + 1);
  }
  return {};
}

/// `settings` with every default written out.
std::unique_ptr<Message> effective_copy(const Message& settings) {
  std::unique_ptr<Message> copy{settings.New()};
  copy->CopyFrom(settings);
  fill_defaults(*copy);
  return copy;
}

/// Fowler, Noll and Vo's 64 bit hash, variant 1a.
class Fnv1a {
 public:
  /// The length first: no two sequences of texts look alike.
  void add_text(std::string_view text) noexcept {
    for (std::size_t rest = text.size(), i = 0; i < sizeof rest; ++i, rest >>= 8) {
      add_byte(static_cast<unsigned char>(rest));
    }
    for (const char c : text) {
      add_byte(static_cast<unsigned char>(c));
    }
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void add_byte(unsigned char byte) noexcept { value_ = (value_ ^ byte) * 0x100000001b3U; }

  std::uint64_t value_{0xcbf29ce484222325U};
};

}  // namespace

Result<void> merge_text(std::string_view text, std::string_view name, Message& settings) {
  const std::unique_ptr<Message> parsed{settings.New()};
  FirstComplaint complaint;
  TextFormat::ParseInfoTree places;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&complaint);
  parser.WriteLocationsTo(&places);
  if (!parser.ParseFromString(std::string{text}, parsed.get())) {
    return fail(sentence_at(name, complaint.place(), plain_words(complaint.text(), settings)));
  }
  auto checked = for_each_value(
      *parsed,
      "",
      [&](const Message& group, const FieldDescriptor& field, int index, const std::string& path) {
        return check_value(group, field, index, path).map_error([&](const Error& error) {
          return Error{sentence_at(name, place_of(&places, path, *parsed), error.text)};
        });
      });
  if (checked) {
    settings.MergeFrom(*parsed);
  }
  return checked;
}

Result<void> check_settings(const Message& settings) {
  return for_each_value(
      *effective_copy(settings),
      "",
      [](const Message& group, const FieldDescriptor& field, int index, const std::string& path) {
        return check_value(group, field, index, path).and_then([&] {
          return check_relation(group, field, path);
        });
      });
}

void fill_defaults(Message& settings) {
  const auto& fields = *settings.GetDescriptor();
  const auto& writer = *settings.GetReflection();
  for (int i = 0; i < fields.field_count(); ++i) {
    const FieldDescriptor* field = fields.field(i);
    if (field->is_repeated()) {
      const int groups = field->message_type() == nullptr ? 0 : writer.FieldSize(settings, field);
      for (int k = 0; k < groups; ++k) {
        fill_defaults(*writer.MutableRepeatedMessage(&settings, field, k));
      }
    } else if (field->message_type() != nullptr) {
      fill_defaults(*writer.MutableMessage(&settings, field));
    } else if (!writer.HasField(settings, field)) {
      switch (field->cpp_type()) {  // an absent field reads as its default
        case FieldDescriptor::CPPTYPE_DOUBLE:
          writer.SetDouble(&settings, field, field->default_value_double());
          break;
        case FieldDescriptor::CPPTYPE_UINT32:
          writer.SetUInt32(&settings, field, field->default_value_uint32());
          break;
        case FieldDescriptor::CPPTYPE_UINT64:
          writer.SetUInt64(&settings, field, field->default_value_uint64());
          break;
        case FieldDescriptor::CPPTYPE_BOOL:
          writer.SetBool(&settings, field, field->default_value_bool());
          break;
        default:
          writer.SetString(&settings, field, field->default_value_string());
      }
    }
  }
}

std::string changed_settings_text(const Message& settings, std::string_view from) {
  std::string text;
  TextFormat::PrintToString(settings, &text);
  return "# Written by a program, from " + harmless_line(from) +
         ". Comments of that file were not kept.\n" + text;
}

std::string settings_text(const Message& settings) {
  std::string text;
  TextFormat::PrintToString(*effective_copy(settings), &text);
  return text;
}

std::uint64_t settings_hash(const Message& settings) {
  Fnv1a hash;
  (void)for_each_value(
      *effective_copy(settings),
      "",
      [&hash](
          const Message& group, const FieldDescriptor& field, int index, const std::string& path) {
        const auto& reader = *group.GetReflection();
        std::string value;
        if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
          value = index < 0 ? reader.GetString(group, &field)
                            : reader.GetRepeatedString(group, &field, index);
        } else {
          value = value_text(group, field, index);
        }
        hash.add_text(path);
        hash.add_text(value == "-0" ? "0" : value);
        return Result<void>{};
      });
  return hash.value();
}

}  // namespace palp::config
