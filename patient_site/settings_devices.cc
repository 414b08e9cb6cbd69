#include "patient_site/settings_devices.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "common/config/settings_text.h"
#include "common/core/whole_file.h"
#include "common/settings/units.h"
#include "patient_site/devices/profile_flaw.h"
#include "patient_site/devices/profile_texts.h"
#include "proto/devices.pb.h"

namespace palp::patient {
namespace {

using proto::config::ModbusDevice;
using proto::config::PatientDeviceFile;
using proto::config::RegisterProfile;
using settings::from_milli;
using settings::from_milliseconds;

WordKind kind_of(const std::string& name) {
  if (name == "u16") return WordKind::U16;
  if (name == "i16") return WordKind::I16;
  if (name == "u32") return WordKind::U32;
  return name == "f32" ? WordKind::F32 : WordKind::I32;
}

std::uint16_t word_of(std::uint32_t value) { return static_cast<std::uint16_t>(value); }

RegisterCondition make_condition(const RegisterProfile::Condition& message) {
  return {.address = word_of(message.address()),
          .mask = word_of(message.mask()),
          .value = word_of(message.value()),
          .means = message.means()};
}

RegisterField make_field(const RegisterProfile::Quantity& message) {
  RegisterField field{.address = word_of(message.address()),
                      .kind = kind_of(message.kind()),
                      .unit = settings::from_micro(message.micro_per_count())};
  if (message.has_negative()) field.negative = make_condition(message.negative());
  return field;
}

ValueSource source_of(const std::string& name) {
  if (name == "target") return ValueSource::Position;
  if (name == "here") return ValueSource::Here;
  if (name == "speed") return ValueSource::Speed;
  if (name == "force limit") return ValueSource::ForceLimit;
  return name == "acceleration" ? ValueSource::Acceleration : ValueSource::Constant;
}

RegisterWrite make_write(const RegisterProfile::Write& message) {
  RegisterWrite write;
  write.kind = message.kind() == "coil"       ? WriteKind::Coil
               : message.kind() == "register" ? WriteKind::OneRegister
                                              : WriteKind::Registers;
  write.address = word_of(message.address());
  write.values.reserve(static_cast<std::size_t>(message.value_size()));
  for (const RegisterProfile::Value& value : message.value()) {
    write.values.push_back({.source = source_of(value.source()),
                            .number = value.number(),
                            .kind = kind_of(value.kind()),
                            .unit = settings::from_micro(value.micro_per_count())});
  }
  return write;
}

StartStep make_step(const RegisterProfile::Step& message) {
  StartStep step;
  step.means = message.means();
  step.write = make_write(message.write());
  if (message.has_unless()) step.unless = make_condition(message.unless());
  if (message.has_until()) step.until = make_condition(message.until());
  step.wait_max = from_seconds(message.wait_max_s());
  step.moves = message.moves();
  if (message.has_unasked()) step.unasked = make_condition(message.unasked());
  return step;
}

DeviceProfile make_profile(const RegisterProfile& message) {
  DeviceProfile profile;
  profile.name = message.name();
  profile.order = message.word_order() == "low first" ? WordOrder::LowFirst : WordOrder::HighFirst;
  profile.baud = message.baud();
  profile.parity = message.parity() == "even" ? 'E' : message.parity() == "odd" ? 'O' : 'N';
  profile.reply_delay = from_milliseconds(message.reply_delay_ms());
  profile.period = from_milliseconds(message.period_ms());
  profile.silence = from_milliseconds(message.silence_ms());
  profile.read_address = word_of(message.read_address());
  profile.read_count = word_of(message.read_count());
  profile.input_registers = message.input_registers();
  profile.state_address = word_of(message.state_address());
  profile.state_count = word_of(message.state_count());
  if (message.has_position()) profile.position = make_field(message.position());
  if (message.has_force()) profile.force = make_field(message.force());
  for (const auto& one : message.healthy()) profile.healthy.push_back(make_condition(one));
  if (message.life_ms() > 0) profile.life = word_of(message.life_address());
  profile.life_within = from_milliseconds(message.life_ms());
  profile.stuck_after = from_milliseconds(message.stuck_ms());
  for (const auto& one : message.start()) profile.start.push_back(make_step(one));
  for (const auto& one : message.move()) profile.move.push_back(make_write(one));
  if (message.has_stop()) profile.stop = make_write(message.stop());
  profile.exchange = message.exchange();
  profile.only_changes = message.only_changes();
  return profile;
}

DeviceInstallation make_installation(const ModbusDevice& message) {
  DeviceInstallation built_in;
  built_in.zero = from_milli(message.zero_mm());
  built_in.reversed = message.reversed();
  built_in.position_unit = settings::from_micro(message.um_per_count());
  built_in.force_unit = from_milli(message.mn_per_count());
  built_in.force_reversed = message.force_reversed();
  built_in.speed_max = message.speed_max_m_per_s();
  built_in.acceleration_max = message.acceleration_max_m_per_s2();
  built_in.force_limit = message.force_limit_n();
  built_in.travel_min = from_milli(message.travel_min_mm());
  built_in.travel_max = from_milli(message.travel_max_mm());
  built_in.may_home = message.may_home();
  built_in.force_range = message.range_n();
  built_in.force_zero = message.unloaded_n();
  built_in.tare_within = message.tare_within_n();
  built_in.tare_noise = message.tare_noise_n();
  built_in.tare_time = from_seconds(message.tare_s());
  built_in.stuck_after = from_seconds(message.stuck_after_s());
  return built_in;
}

Result<DevicePlan> make_plan(const ModbusDevice& message, const std::string& where) {
  const auto wrong = [&](const Error& error) { return fail(where, error); };
  auto profile = find_profile(message.profile());
  if (!profile) return wrong(profile.error());
  auto address = io::parse_modbus_address(message.address());
  if (!address) return wrong(address.error());
  address->station = static_cast<std::uint8_t>(message.station());
  address->baud = message.baud() > 0 ? message.baud() : profile->baud;
  address->parity = profile->parity;
  address->reply_delay = profile->reply_delay;
  fit_to_line(*profile, *address);
  if (message.silence_ms() > 0) profile->silence = from_milliseconds(message.silence_ms());
  DeviceInstallation built_in = make_installation(message);
  if (message.stuck_after_s() == 0) built_in.stuck_after = profile->stuck_after;
  if (const auto flaw = flaw_of(*profile, built_in)) return wrong(Error{*flaw});
  DevicePlan plan;
  plan.profile = std::move(*profile);
  plan.installation = built_in;
  plan.address = std::move(*address);
  plan.lag = from_milli(message.lag_ms());
  plan.pole = message.pole_hz();
  plan.noise = from_milli(message.noise_mn());
  plan.yield = settings::from_micro(message.yield_um_per_n());
  return plan;
}

Result<CardPlan> make_card_plan(const proto::config::HidCard& message, const std::string& where) {
  const CardModel& model = *card_named(message.model());
  const std::string name{model.name};
  if (message.n_per_v() == 0) return fail(where + ": " + name + " is not calibrated: no n_per_v");
  if (message.range() >= model.full_scales.size()) {
    return fail(where + ": " + name + " has the ranges 0 to " +
                std::to_string(model.full_scales.size() - 1));
  }
  CardPlan plan;
  CardInstallation& built_in = plan.installation;
  built_in.kind = model.kind;
  built_in.channel = static_cast<std::uint8_t>(message.channel());
  built_in.range = static_cast<std::uint8_t>(message.range());
  built_in.newtons_per_volt = message.n_per_v();
  built_in.load.force_range = message.range_n();
  built_in.load.force_zero = message.unloaded_n();
  built_in.load.tare_within = message.tare_within_n();
  built_in.load.tare_noise = message.tare_noise_n();
  built_in.load.tare_time = from_seconds(message.tare_s());
  built_in.silence = from_milliseconds(message.silence_ms());
  plan.serial = message.serial();
  plan.pole = message.pole_hz();
  plan.noise = from_milli(message.noise_mn());
  plan.yield = settings::from_micro(message.yield_um_per_n());
  return plan;
}

/// What the devices are together.
Result<DevicePlans> sound(DevicePlans plans, const std::string& name) {
  if (plans.x.has_value() != plans.y.has_value()) {
    return fail(name + ": a stage has the axes x and y, or neither");
  }
  for (const auto* axis : {&plans.normal, &plans.x, &plans.y}) {
    if (*axis && (*axis)->profile.move.empty()) {
      return fail(name + ": " + (*axis)->profile.name + " is no axis");
    }
  }
  if (plans.cell && !plans.cell->profile.force) {
    return fail(name + ": " + plans.cell->profile.name + " is no force sensor");
  }
  if (!plans.normal) return fail(name + ": there is no axis along the normal");
  if (plans.cell && plans.card) return fail(name + ": a site has a cell or a card, not both");
  if (!plans.cell && !plans.card && !plans.normal->profile.force) {
    return fail(name + ": there is no cell, and " + plans.normal->profile.name +
                " does not feel its load");
  }
  std::vector<std::string> lines;
  for (const auto* one : {&plans.normal, &plans.x, &plans.y, &plans.cell}) {
    if (!*one || (*one)->address.line.empty()) continue;
    if (std::find(lines.begin(), lines.end(), (*one)->address.line) != lines.end()) {
      return fail(name + ": two devices on the line " + (*one)->address.line +
                  "; each needs a line of its own, or a gateway");
    }
    lines.push_back((*one)->address.line);
  }
  return plans;
}

}  // namespace

Result<std::optional<DevicePlans>> plan_devices(Settings& settings) {
  if (settings.stage == "sim") return std::nullopt;
  auto plans = read_device_plans(settings.devices);
  if (!plans) return tl::unexpected{plans.error()};
  if (const auto flaw = flaw_of(DeviceFacts{
          .hand = {}, .stage = facts_of(*plans).stage, .sensor = facts_of(*plans).sensor})) {
    return fail(settings.devices + ": " + *flaw);
  }
  if (!plans->phantom.empty()) settings.phantom = plans->phantom;
  if ((settings.force == "hid") != plans->card.has_value()) {
    return fail(settings.devices + ": a card and --force hid go together, one needs the other");
  }
  settings.node.sensor_stale = sensor_silence_of(*plans);
  return std::optional{std::move(*plans)};
}

Result<DeviceProfile> find_profile(const std::string& name) {
  constexpr std::string_view kFile = "file:";
  std::string text{profile_text(name)};
  if (name.starts_with(kFile)) {
    auto read = read_whole_file(name.substr(kFile.size()));
    if (!read) return tl::unexpected{read.error()};
    text = std::move(*read);
  } else if (text.empty()) {
    return fail("unknown profile '" + name + "'; there are: " + profile_names() +
                ", and file:PATH");
  }
  RegisterProfile message;
  if (const auto merged = config::merge_text(text, name, message); !merged) {
    return tl::unexpected{merged.error()};
  }
  DeviceProfile profile = make_profile(message);
  if (profile.name.empty()) profile.name = name;
  return profile;
}

Result<DevicePlans> make_device_plans(std::string_view text, const std::string& name) {
  PatientDeviceFile message;
  if (const auto merged = config::merge_text(text, name, message); !merged) {
    return tl::unexpected{merged.error()};
  }
  if (const auto checked = config::check_settings(message); !checked) {
    return fail(name, checked.error());
  }
  DevicePlans plans;
  plans.phantom = message.phantom();
  struct Place {
    const char* name;
    bool there;
    const ModbusDevice& message;
    std::optional<DevicePlan>& plan;
  };
  for (const Place& place : {Place{"normal", message.has_normal(), message.normal(), plans.normal},
                             Place{"x", message.has_x(), message.x(), plans.x},
                             Place{"y", message.has_y(), message.y(), plans.y},
                             Place{"cell", message.has_cell(), message.cell(), plans.cell}}) {
    if (!place.there) continue;
    auto plan = make_plan(place.message, name + ": " + place.name);
    if (!plan) return tl::unexpected{plan.error()};
    place.plan = std::move(*plan);
  }
  if (message.has_card()) {
    auto card = make_card_plan(message.card(), name + ": card");
    if (!card) return tl::unexpected{card.error()};
    plans.card = std::move(*card);
  }
  return sound(std::move(plans), name);
}

Result<DevicePlans> read_device_plans(const std::string& path) {
  const auto text = read_whole_file(path);
  if (!text) return tl::unexpected{text.error()};
  auto plans = make_device_plans(*text, path);
  if (plans) plans->text = *text;
  return plans;
}

namespace {

/// As a person reads it: no more digits than a check can tell.
double rounded(double value) {
  const double size = std::pow(10, 5 - std::floor(std::log10(std::abs(value))));
  return value == 0 ? 0 : std::round(value * size) / size;
}

void enter(const DevicePlan& found, ModbusDevice& message) {
  const DeviceInstallation& built_in = found.installation;
  if (!found.profile.move.empty()) {
    message.set_zero_mm(rounded(built_in.zero * 1e3));
    message.set_reversed(built_in.reversed);
    message.set_um_per_count(rounded(built_in.position_unit * 1e6));
    message.set_travel_min_mm(rounded(built_in.travel_min * 1e3));
    message.set_travel_max_mm(rounded(built_in.travel_max * 1e3));
    message.set_lag_ms(rounded(found.lag * 1e3));
  }
  if (!found.profile.force) return;
  message.set_mn_per_count(rounded(built_in.force_unit * 1e3));
  message.set_force_reversed(built_in.force_reversed);
  message.set_unloaded_n(rounded(built_in.force_zero));
  message.set_noise_mn(rounded(found.noise * 1e3));
}

/// The whole file, with `change` done to it, if it is sound then.
Result<std::string> changed_text(std::string_view text,
                                 const std::string& name,
                                 const std::function<void(PatientDeviceFile&)>& change) {
  PatientDeviceFile message;
  if (const auto merged = config::merge_text(text, name, message); !merged) {
    return tl::unexpected{merged.error()};
  }
  change(message);
  std::string changed = config::changed_settings_text(message, name);
  if (const auto plans = make_device_plans(changed, name); !plans) {
    return tl::unexpected{plans.error()};
  }
  return changed;
}

}  // namespace

Result<std::string> calibrated_text(std::string_view text,
                                    const std::string& name,
                                    std::string_view place,
                                    const DevicePlan& found) {
  return changed_text(text, name, [&](PatientDeviceFile& file) {
    enter(found,
          place == "normal" ? *file.mutable_normal()
          : place == "x"    ? *file.mutable_x()
          : place == "y"    ? *file.mutable_y()
                            : *file.mutable_cell());
  });
}

Result<std::string> calibrated_text(std::string_view text,
                                    const std::string& name,
                                    const CardPlan& found) {
  return changed_text(text, name, [&](PatientDeviceFile& file) {
    proto::config::HidCard& card = *file.mutable_card();
    card.set_n_per_v(rounded(found.installation.newtons_per_volt));
    card.set_unloaded_n(rounded(found.installation.load.force_zero));
    card.set_noise_mn(rounded(found.noise * 1e3));
  });
}

}  // namespace palp::patient
