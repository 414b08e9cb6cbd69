#pragma once

#include <cstdint>
#include <string>

#include "common/core/result.h"
#include "common/settings/site_settings.h"
#include "surgeon_site/simulated_hand.h"
#include "surgeon_site/surgeon_node.h"

namespace palp::config {
class Document;
}  // namespace palp::config
namespace palp::proto::config {
class SurgeonConfig;
}  // namespace palp::proto::config

namespace palp::surgeon {

/// All that a surgeon site is made of, frozen: one struct per part. Without a file or a flag each
/// part has its own defaults.
struct Settings {
  std::string peer;  ///< HOST:PORT; a program needs one, virtual time does not
  settings::ProtectionSettings protection;
  coupling::CouplingConfig coupling;
  std::uint64_t agreement{};  ///< both sites must have the same
  link::LinkConfig link;
  SurgeonConfig node;
  /// Coupling direct is not meant for longer ones, and engages there only if forced.
  Duration direct_round_trip_max{std::chrono::milliseconds{20}};
  bool engagement_forced{};
  std::string master{"script:standard"};
  std::string devices;      ///< file; a master that is no script needs one
  std::string grip{"mid"};  ///< the name of what `hand` holds in numbers
  SimulatedHandConfig hand;
  settings::LoopSettings loop;
  settings::ImpairmentSettings impairment;
  settings::RecordSettings record;
  settings::MonitorSettings monitor;
  bool picture_in_step{};  ///< touch waits until it is as old as the picture
  Duration duration{};     ///< 0: until the script ends
  Duration give_up_after{std::chrono::seconds{120}};  ///< a patient site that fell silent
  std::uint64_t seed{1};
};

/// The document must have passed its check(). The sentence names what does not exist.
[[nodiscard]] Result<Settings> make_settings(const config::Document& document);
[[nodiscard]] Result<Settings> make_settings(const proto::config::SurgeonConfig& message);

}  // namespace palp::surgeon
