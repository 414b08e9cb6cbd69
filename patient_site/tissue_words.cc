#include "patient_site/tissue_words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/core/conventions.h"

namespace palp::patient {
namespace {

constexpr std::array<std::string_view, 6> kParts{
    "ball", "cylinder", "block", "surface", "relaxes", "database"};

/// A name and its words.
struct Part {
  std::string name;
  std::vector<std::pair<std::string, std::string>> words;
};

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shown(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.16g", value);
  return text.data();
}

/// "12.5,-3" as millimetres.
std::optional<Place> place_in(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto x = number_in(text.substr(0, comma));
  const auto y = number_in(text.substr(comma + 1));
  if (!x || !y) return std::nullopt;
  const Place place{*x * kMillimetre, *y * kMillimetre};
  if (std::max(std::abs(place.x), std::abs(place.y)) > kPlaceMax) return std::nullopt;
  return place;
}

/// One word of a part: its name, and what is done with its value, which may be refused.
struct Word {
  std::string_view name;
  std::function<Result<void>(const std::string& text)> take;
};

Word number(std::string_view name, double low, double high, double unit, double& to) {
  return {name, [=, &to](const std::string& text) -> Result<void> {
            const auto value = number_in(text);
            if (!value || *value < low || *value > high) {
              return fail("'" + std::string{name} + "=" + text + "' is not a number from " +
                          shown(low) + " to " + shown(high));
            }
            to = *value * unit;
            return {};
          }};
}

Word whole(std::string_view name, std::uint64_t high, std::uint64_t& to) {
  return {name, [=, &to](const std::string& text) -> Result<void> {
            std::uint64_t value = 0;
            const char* end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, value);
            if (error != std::errc{} || stop != end || value > high) {
              return fail("'" + std::string{name} + "=" + text +
                          "' is not a whole number from 0 to " + std::to_string(high));
            }
            to = value;
            return {};
          }};
}

/// Of an inclusion: how far each may go says the database.
Word any_number(std::string_view name, double unit, double& to) {
  return {name, [=, &to](const std::string& text) -> Result<void> {
            const auto value = number_in(text);
            if (!value) return fail("'" + std::string{name} + "=" + text + "' is not NAME=NUMBER");
            to = *value * unit;
            return {};
          }};
}

Word place(Place& to) {
  return {"at", [&to](const std::string& text) -> Result<void> {
            const auto value = place_in(text);
            if (!value) {
              return fail("'at=" + text + "' is not at=X_MM,Y_MM within 250 mm of the middle");
            }
            to = *value;
            return {};
          }};
}

/// The first name that stands there twice; empty: none.
std::string doubled(const std::vector<std::string>& names) {
  for (auto one = names.begin(); one != names.end(); ++one) {
    if (std::find(names.begin(), one, *one) != one) return *one;
  }
  return {};
}

Result<void> unknown_word(const std::string& name,
                          const Part& part,
                          const std::vector<Word>& known) {
  std::string names;
  for (const Word& one : known) names.append(names.empty() ? "" : ", ").append(one.name);
  return fail("'" + name + "' is unknown of a " + part.name + "; there are " + names);
}

Result<void> take_words(const Part& part, const std::vector<Word>& known) {
  std::vector<std::string> given;
  for (const auto& [name, text] : part.words) given.push_back(name);
  if (const std::string name = doubled(given); !name.empty()) {
    return fail("'" + name + "' is given twice of a " + part.name);
  }
  for (const auto& [name, text] : part.words) {
    const auto word = std::find_if(known.begin(), known.end(), [&, &name = name](const Word& one) {
      return one.name == name;
    });
    if (word == known.end()) return unknown_word(name, part, known);
    if (auto taken = word->take(text); !taken) return taken;
  }
  return {};
}

Result<void> add_inclusion(const Part& part, BlockTissue& block) {
  PlacedInclusion one{.body = {.shape = part.name == "ball" ? fem::InclusionShape::Ball
                                                            : fem::InclusionShape::Cylinder,
                               .depth = 0,
                               .radius = kPaperRadius,
                               .ratio = kPaperRatio}};
  auto taken = take_words(part,
                          {any_number("depth", kMillimetre, one.body.depth),
                           any_number("radius", kMillimetre, one.body.radius),
                           any_number("ratio", 1, one.body.ratio),
                           place(one.axis)});
  if (taken) block.inclusions.push_back(one);
  return taken;
}

Result<void> describe_block(const Part& part, BlockTissue& block) {
  StiffnessVariation& variation = block.variation;
  double modulus = 0;
  double height = 0;
  const Word law{"law", [&](const std::string& text) -> Result<void> {
                   const auto named = plain_law(text);
                   if (!named) {
                     return fail("there is no law '" + text + "'; there are closed-form, " +
                                 "exponential, draining and layered");
                   }
                   block.law = named->force;
                   return {};
                 }};
  auto taken = take_words(part,
                          {number("e_kpa", 0.1, 1000, 1e3, modulus),
                           number("height", 15, 57, kMillimetre, height),
                           law,
                           number("varies", 0, 0.5, 1, variation.spread),
                           number("length", 2, 200, kMillimetre, variation.length),
                           whole("seed", 9007199254740991, variation.seed)});
  if (modulus > 0) block.youngs_modulus = modulus;
  if (height > 0) block.height = height;
  return taken;
}

/// Whether it is too small says the tip.
Word surface_radius(std::optional<double>& to) {
  return {"radius", [&to](const std::string& text) -> Result<void> {
            const auto value = number_in(text);
            if (!value || *value == 0 || std::abs(*value) > 1e6) {
              return fail("'radius=" + text +
                          "' is not a number from -1000000 to 1000000 but 0; a level surface has "
                          "none");
            }
            to = *value * kMillimetre;
            return {};
          }};
}

Result<void> describe_surface(const Part& part, BlockSurface& surface) {
  double x = 0;  // [rad]
  double y = 0;
  std::optional<double> radius;  // [m]
  constexpr double kDegree = std::numbers::pi / 180;
  auto taken = take_words(part,
                          {number("slope_x", -20, 20, kDegree, x),
                           number("slope_y", -20, 20, kDegree, y),
                           surface_radius(radius),
                           place(surface.apex)});
  surface.slope_x = std::tan(x);
  surface.slope_y = std::tan(y);
  surface.curvature = radius ? 1 / *radius : 0;
  return taken;
}

Result<void> load_block(const Part& part, BlockTissue& block) {
  std::string file;
  const Word path{"file", [&](const std::string& text) -> Result<void> {
                    file = text;
                    return {};
                  }};
  if (auto taken = take_words(part, {path}); !taken) return taken;
  if (file.empty()) return fail("'database' names no file; write database file=PATH");
  auto database = depth::load_database(file);
  if (!database) return tl::unexpected<Error>(database.error());
  block.database = std::move(*database);
  return {};
}

Result<void> describe_relaxation(const Part& part, Relaxation& relaxation) {
  Relaxation::Part& first = relaxation.parts[0];
  first = {.share = 0.1, .time = 1};
  return take_words(
      part, {number("share", 0, 0.9, 1, first.share), number("time_s", 0.01, 1000, 1, first.time)});
}

std::vector<Part> parts_of(std::string_view text) {
  std::vector<Part> parts;
  std::istringstream lines{std::string{text}};
  std::string line;
  while (std::getline(lines, line)) {
    line.erase(std::min(line.size(), line.find('#')));
    std::istringstream pieces{line};
    std::string piece;
    while (std::getline(pieces, piece, ';')) {
      std::istringstream words{piece};
      Part part;
      if (!(words >> part.name)) continue;
      std::string word;
      while (words >> word) {
        const auto mark = std::min(word.size(), word.find('='));
        part.words.emplace_back(word.substr(0, mark), word.substr(std::min(word.size(), mark + 1)));
      }
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

Result<void> take_part(const Part& part, DescribedTissue& tissue) {
  if (part.name == "ball" || part.name == "cylinder") return add_inclusion(part, tissue.block);
  if (part.name == "block") return describe_block(part, tissue.block);
  if (part.name == "surface") return describe_surface(part, tissue.block.surface);
  if (part.name == "relaxes") return describe_relaxation(part, tissue.relaxation);
  if (part.name == "database") return load_block(part, tissue.block);
  return fail("'" + part.name +
              "' is unknown; there are ball, cylinder, block, surface, relaxes and database");
}

}  // namespace

bool are_tissue_words(std::string_view text) {
  const std::vector<Part> parts = parts_of(text);
  return !parts.empty() &&
         std::find(kParts.begin(), kParts.end(), parts.front().name) != kParts.end();
}

Result<DescribedTissue> parse_tissue_words(std::string_view text) {
  DescribedTissue tissue;
  std::vector<std::string> whole;  // inclusions there may be several of
  for (const Part& part : parts_of(text)) {
    if (part.name != "ball" && part.name != "cylinder") whole.push_back(part.name);
    if (const std::string name = doubled(whole); !name.empty()) {
      return fail("'" + name + "' is given twice");
    }
    if (auto taken = take_part(part, tissue); !taken) return tl::unexpected<Error>(taken.error());
  }
  if (!tissue.block.database) {
    auto database = depth::default_database();
    if (!database) return tl::unexpected<Error>(database.error());
    tissue.block.database = std::move(*database);
  }
  if (auto ok = check(tissue.block); !ok) return tl::unexpected<Error>(ok.error());
  return tissue;
}

}  // namespace palp::patient
