#include "review/scenario_text.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "common/config/document.h"
#include "common/config/number.h"
#include "common/core/median.h"
#include "common/record/session_encoder.h"

namespace palp::review {
namespace {

constexpr double kDelayMax = 5000;   ///< [ms], of the lab's paths
constexpr double kJitterMax = 1000;  ///< [ms]

/// Of a path, as the session measured it.
struct Measured {
  double delay{};   ///< [ms]
  double jitter{};  ///< [ms]
  double loss{};    ///< [share]
};

double loss_of(const SiteData& receiver) {
  if (!receiver.last_link) return 0;
  const auto lost = static_cast<double>(receiver.last_link->health.lost);
  const auto arrived = static_cast<double>(receiver.last_link->health.accepted);
  return lost + arrived > 0 ? lost / (lost + arrived) : 0;
}

double median_ms(const SiteData& site, Duration LinkPoint::*member, Duration otherwise) {
  std::vector<double> values;
  for (const LinkPoint& point : site.links) {
    if (point.round_trip <= Duration{0} || point.*member <= Duration{0}) continue;
    values.push_back(seconds(point.*member) * 1e3);
  }
  return median(values).value_or(seconds(otherwise) * 1e3);
}

std::string path_text(std::string_view name, const Measured& path) {
  return std::string{name} +
         " { delay_ms: " + config::number_text(std::clamp(path.delay, 0.0, kDelayMax)) +
         " jitter_ms: " + config::number_text(std::clamp(path.jitter, 0.0, kJitterMax)) +
         " loss: " + config::number_text(path.loss) + " }\n";
}

std::string indented(const std::string& text) {
  std::string out = "  ";
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    if (text[i] == '\n' && i + 1 < text.size()) out += "  ";
  }
  return out;
}

Result<std::string> site_text(config::Document document,
                              const SiteData& site,
                              const std::string& master) {
  const std::string name{record::site_name(site.site)};
  if (!site.texts.settings) return fail("the " + name + "'s file holds no settings");
  if (auto merged = document.merge(*site.texts.settings, "config.textproto"); !merged) {
    return tl::unexpected(merged.error());
  }
  if (!master.empty()) {
    if (auto set = document.set("hand.master", master, "the recorded hand"); !set) {
      return tl::unexpected(set.error());
    }
  }
  return name + " {\n" + indented(document.text()) + "}\n";
}

}  // namespace

Result<std::string> scenario_text(const SessionPair& session, const std::string& surgeon_path) {
  if (!session.patient.texts.tissue_csv && !session.patient.texts.tissue_words) {
    return fail(
        "the session's tissue was real, and what it would do under another hand is in no "
        "file: give the lab a phantom that is like it");
  }
  const auto surgeon =
      site_text(config::surgeon_document(), session.surgeon, "recording:" + surgeon_path);
  if (!surgeon) return tl::unexpected(surgeon.error());
  const auto patient = site_text(config::patient_document(), session.patient, "");
  if (!patient) return tl::unexpected(patient.error());
  const double round_trip = median_ms(session.surgeon, &LinkPoint::round_trip, Duration{0});
  const double out = std::min(
      round_trip,
      median_ms(session.surgeon, &LinkPoint::delay_out, from_seconds(round_trip * 0.5e-3)));
  const double jitter = median_ms(session.surgeon, &LinkPoint::jitter, Duration{0});
  return "means: \"a recorded session, played again\"\n" + *surgeon + *patient +
         path_text("up", {out, jitter, loss_of(session.patient)}) +
         path_text("down", {round_trip - out, jitter, loss_of(session.surgeon)});
}

}  // namespace palp::review
