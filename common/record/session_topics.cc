// The topics of a session file, with the descriptors of their messages.
#include <set>

#include <google/protobuf/descriptor.pb.h>

#include "common/record/session_encoder.h"
#include "proto/session_log.pb.h"

namespace palp::record {
namespace {

using link::Role;

/// Copies `type` and what its fields need into `file`, each once.
void add_type(const google::protobuf::Descriptor& type,
              std::set<std::string>& added,
              google::protobuf::FileDescriptorProto& file) {
  if (!added.insert(type.full_name()).second) {
    return;
  }
  type.CopyTo(file.add_message_type());
  for (int k = 0; k < type.field_count(); ++k) {
    const auto& field = *type.field(k);
    if (field.message_type() != nullptr) {
      add_type(*field.message_type(), added, file);
    }
    const auto* enumeration = field.enum_type();
    if (enumeration != nullptr && enumeration->containing_type() == nullptr &&
        added.insert(enumeration->full_name()).second) {
      enumeration->CopyTo(file.add_enum_type());
    }
  }
}

Bytes descriptor_set(const google::protobuf::Descriptor& type) {
  google::protobuf::FileDescriptorSet set;
  auto& file = *set.add_file();
  file.set_name(type.file()->name());
  file.set_package(type.file()->package());
  file.set_syntax("proto3");
  std::set<std::string> added;
  add_type(type, added, file);
  Bytes bytes(set.ByteSizeLong());
  set.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace

std::string_view site_name(Role site) noexcept {
  return site == Role::Surgeon ? "surgeon" : "patient";
}

std::vector<TopicFormat> topics_of(Role site) {
  const bool surgeon = site == Role::Surgeon;
  const std::string prefix{std::string{site_name(site)} + '/'};
  const auto topic = [&](Topic which, const char* name, const google::protobuf::Descriptor* type) {
    return TopicFormat{.topic = which,
                       .name = prefix + name,
                       .schema = type->full_name(),
                       .descriptors = descriptor_set(*type)};
  };
  std::vector<TopicFormat> topics{
      topic(Topic::Tick,
            "tick",
            surgeon ? session::SurgeonTick::descriptor() : session::PatientTick::descriptor()),
      topic(Topic::TickView,
            "tick_view",
            surgeon ? session::SurgeonTickView::descriptor()
                    : session::PatientTickView::descriptor()),
      topic(Topic::Arrived, "arrived", session::ArrivedSample::descriptor()),
      topic(Topic::Link, "link", session::LinkStatus::descriptor()),
      topic(Topic::Event, "event", session::Event::descriptor())};
  if (!surgeon) {
    topics.push_back(topic(Topic::Contact, "contact", session::ContactSample::descriptor()));
  }
  topics.push_back(
      topic(Topic::Depth,
            "depth",
            surgeon ? session::DepthReport::descriptor() : session::DepthEstimate::descriptor()));
  if (surgeon) {
    topics.push_back(topic(Topic::Hand, "hand", session::HandReading::descriptor()));
  } else {
    topics.push_back(topic(Topic::Stage, "stage", session::StageReading::descriptor()));
    topics.push_back(topic(Topic::Force, "force", session::ForceReading::descriptor()));
  }
  topics.push_back(topic(Topic::Heard, "heard", session::LinkHeard::descriptor()));
  topics.push_back(topic(Topic::User, "user", session::UserCommand::descriptor()));
  topics.push_back(topic(Topic::Devices, "devices", session::Devices::descriptor()));
  return topics;
}

}  // namespace palp::record
