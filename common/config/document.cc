#include "common/config/document.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include "common/config/knob.h"
#include "common/config/override.h"
#include "proto/config.pb.h"

namespace palp::config {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// The field a program names; a wrong name is our bug.
const FieldDescriptor& known_field(const Message& settings, std::string_view path) {
  const auto* type = settings.GetDescriptor();
  const FieldDescriptor* field = nullptr;
  while (!path.empty()) {
    PALP_CHECK(type != nullptr, "a program names a field of its schema");
    const auto dot = path.find('.');
    field = type->FindFieldByName(std::string{path.substr(0, dot)});
    PALP_CHECK(field != nullptr, "a program names a field of its schema");
    type = field->message_type();
    path = dot == std::string_view::npos ? std::string_view{} : path.substr(dot + 1);
  }
  PALP_CHECK(field != nullptr, "a program names a field of its schema");
  return *field;
}

}  // namespace

Document::Document(std::unique_ptr<Message> settings) : settings_{std::move(settings)} {
  PALP_CHECK(settings_ != nullptr, "a document holds a message");
}
Document::Document(Document&& other) noexcept = default;
Document& Document::operator=(Document&& other) noexcept = default;
Document::~Document() = default;

Result<void> Document::merge(std::string_view text, std::string_view name) {
  return merge_text(text, name, *settings_);
}

Result<void> Document::set(std::string_view assignment) {
  return apply_override(assignment, *settings_);
}

Result<void> Document::set(std::string_view path, std::string_view value, std::string_view name) {
  return apply_value(path, value, name, *settings_);
}

Result<void> Document::check() const { return check_settings(*settings_); }

std::string Document::text() const { return settings_text(*settings_); }

std::uint64_t Document::hash(const std::string& group) const {
  if (group.empty()) {
    return settings_hash(*settings_);
  }
  const FieldDescriptor& field = known_field(*settings_, group);
  PALP_CHECK(
      field.message_type() != nullptr && field.containing_type() == settings_->GetDescriptor(),
      "a group right below the top is hashed");
  return settings_hash(settings_->GetReflection()->GetMessage(*settings_, &field));
}

std::string Document::describe() const { return describe_knobs(*settings_->GetDescriptor()); }

std::string Document::describe(std::string_view path) const {
  return describe_knob(known_field(*settings_, path));
}

bool Document::is_switch(std::string_view path) const {
  return known_field(*settings_, path).cpp_type() == FieldDescriptor::CPPTYPE_BOOL;
}

Document surgeon_document() { return Document{std::make_unique<proto::config::SurgeonConfig>()}; }
Document patient_document() { return Document{std::make_unique<proto::config::PatientConfig>()}; }
Document scenario_document() { return Document{std::make_unique<proto::config::LabScenario>()}; }
Document study_document() { return Document{std::make_unique<proto::config::Study>()}; }

}  // namespace palp::config
