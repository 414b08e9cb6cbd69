// Input: for some fields of a scenario where in their range they lie, two bytes for the field and
// one for the place. What passes its check runs: both sites, the link and the tissue in virtual
// time, 0.8 s of a short script, twice.
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/config/document.h"
#include "common/config/flag_value.h"
#include "common/config/number.h"
#include "common/core/check.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "surgeon_site/script_reader.h"
#include "tests/fuzz/fuzz.h"

namespace palp::lab {
namespace {

constexpr Duration kSpan{std::chrono::milliseconds{800}};

/// A number or a switch of the schema, as --help shows it.
struct Field {
  std::string path;
  std::optional<config::NumberRange> range;  ///< none: not a number
};

/// The last two numbers around " to " in "k_p of eq. (1) [N/m], 0 to 2000, default 200".
std::optional<config::NumberRange> range_in(std::string_view description) {
  const std::size_t to = description.rfind(" to ");
  if (to == std::string_view::npos) return std::nullopt;
  const std::string_view before = description.substr(0, to);
  const std::string_view after = description.substr(to + 4);
  const auto min = config::parse_number(before.substr(before.find_last_of(' ') + 1));
  const auto max = config::parse_number(after.substr(0, after.find_first_of(", ")));
  if (!min || !max) return std::nullopt;
  return config::NumberRange{*min, *max};
}

std::vector<Field> fields_of(const config::Document& document) {
  std::istringstream lines{document.describe()};
  std::vector<Field> fields;
  std::string path;
  std::string description;
  while (std::getline(lines, path) && std::getline(lines, description)) {
    path.erase(0, path.find_first_not_of(' '));
    fields.push_back({path, range_in(description)});
  }
  return fields;
}

/// The ends, places between, and places close to the lower end.
double place_in(const config::NumberRange& range, unsigned place) {
  constexpr unsigned kSteps = 128;
  const double width = range.max - range.min;
  if (place >= kSteps) return range.min + std::ldexp(width, -static_cast<int>(place - kSteps) / 4);
  return range.min + width * place / (kSteps - 1);
}

/// Texts that mean something somewhere; where one does not, it is refused. None names a file.
constexpr std::array<const char*, 10> kWords{
    "light",
    "firm",
    "arm",
    "none",
    "paper-5mm",
    "paper-25mm",
    "true",
    "false",
    "loss 30%",
    "delay 5ms 30ms distribution normal duplicate 20% order free"};

/// A scenario grows choice by choice; one that would make it unsound is taken back.
class Choices {
 public:
  void choose(const Field& field, unsigned place) {
    std::string value = kWords[place % kWords.size()];
    if (field.range) {
      const double number = place_in(*field.range, place);
      value = config::number_text(whole(field.path) ? std::floor(number) : number);
    }
    const std::size_t before = taken_.size();
    set(field.path + "=" + value);
    // What both sites must agree on, and what they have in common.
    for (const auto& [one, other] : {kSites, std::pair{kSites.second, kSites.first}}) {
      if (field.path.starts_with(one)) set(other + field.path.substr(one.size()) + "=" + value);
    }
    if (taken_.size() == before) return;
    if (document_.check() && (field.range || make_scenario("fuzz", document_))) return;
    taken_.resize(before);
    document_ = config::scenario_document();
    for (const std::string& assignment : taken_) (void)document_.set(assignment);
  }
  [[nodiscard]] const config::Document& document() const { return document_; }

 private:
  /// No fraction is taken: the default itself is refused with one.
  static bool whole(const std::string& path) {
    config::Document run = config::scenario_document();
    const auto refused = run.set(path + "=0.5");
    return !refused && refused.error().text.find("whole number") != std::string::npos;
  }
  void set(const std::string& assignment) {
    if (document_.set(assignment)) taken_.push_back(assignment);
  }

  static inline const std::pair<std::string, std::string> kSites{"surgeon.", "patient."};

  config::Document document_{config::scenario_document()};
  std::vector<std::string> taken_;
};

/// The script that fits into the span instead of the one asked for.
Scenario shortened(Scenario scenario) {
  auto script = surgeon::parse_script("move -1 0.05\ntaps 1 4 0.2 0.05\nlift 0.05 0.05",
                                      scenario.hand.plant.grip.stiffness);
  PALP_CHECK(script.has_value(), "the script is sound");
  scenario.script = std::move(*script);
  scenario.duration = kSpan;
  scenario.bare = true;  // the bytes have targets of their own
  return scenario;
}

void run_laws(const Scenario& scenario) {
  const RunResult first = simulate(scenario);
  const RunResult second = simulate(scenario);
  PALP_CHECK(first.digest == second.digest, "equal scenarios give equal bits");
  PALP_CHECK(first.virtual_span <= kSpan + std::chrono::milliseconds{100}, "a run ends in time");
  PALP_CHECK(first.surgeon_link.malformed == 0 && first.patient_link.malformed == 0 &&
                 first.surgeon_link.unsent == 0 && first.patient_link.unsent == 0,
             "no site says what the other must refuse");
  for (const DepthEstimate& depth : first.depths) {
    PALP_CHECK(std::isfinite(depth.hash) && std::isfinite(depth.depth), "estimates are numbers");
  }
}

}  // namespace
}  // namespace palp::lab

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto kFields = palp::lab::fields_of(palp::config::scenario_document());
  palp::fuzz::ByteSource input{palp::fuzz::as_bytes(data, size)};
  palp::lab::Choices choices;
  for (int count = 0; count < 32 && !input.empty(); ++count) {
    const auto& field = kFields[input.take<std::uint16_t>() % kFields.size()];
    choices.choose(field, input.take<std::uint8_t>());
  }
  auto scenario = palp::lab::make_scenario("fuzz", choices.document());
  PALP_CHECK(scenario.has_value(), "what passes its check makes a scenario");
  palp::lab::run_laws(palp::lab::shortened(std::move(*scenario)));
  return 0;
}
