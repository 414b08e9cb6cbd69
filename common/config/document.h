#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "common/config/settings_text.h"
#include "common/core/check.h"
#include "common/core/result.h"

namespace palp::config {

/// The settings of one program or scenario, owned: what a main() holds that must not see protobuf.
/// A site's settings.cc reads the message out of it and makes the frozen structs of its parts.
/// Thread: any one at a time; not for a control thread.
class Document {
 public:
  explicit Document(std::unique_ptr<google::protobuf::Message> settings);
  Document(Document&& other) noexcept;
  Document& operator=(Document&& other) noexcept;
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  ~Document();

  /// As merge_text() and apply_override() of a file, "path=value", or a value under another name.
  [[nodiscard]] Result<void> merge(std::string_view text, std::string_view name);
  [[nodiscard]] Result<void> set(std::string_view assignment);
  [[nodiscard]] Result<void> set(std::string_view path,
                                 std::string_view value,
                                 std::string_view name);

  [[nodiscard]] Result<void> check() const;
  [[nodiscard]] std::string text() const;
  /// Of everything, or of the group of that name ("coupling").
  [[nodiscard]] std::uint64_t hash(const std::string& group = {}) const;

  /// What --help says: of every field, of one field.
  [[nodiscard]] std::string describe() const;
  [[nodiscard]] std::string describe(std::string_view path) const;
  /// The field is a boolean, a switch on the command line.
  [[nodiscard]] bool is_switch(std::string_view path) const;

  /// The message, for those who include proto/config.pb.h.
  template <class Settings>
  [[nodiscard]] const Settings& as() const {
    const auto* settings = dynamic_cast<const Settings*>(settings_.get());
    PALP_CHECK(settings != nullptr, "the document holds another kind of settings");
    return *settings;
  }

 private:
  std::unique_ptr<google::protobuf::Message> settings_;
};

/// All defaults: SurgeonConfig, PatientConfig, LabScenario and Study of proto/config.proto.
[[nodiscard]] Document surgeon_document();
[[nodiscard]] Document patient_document();
[[nodiscard]] Document scenario_document();
[[nodiscard]] Document study_document();

}  // namespace palp::config
