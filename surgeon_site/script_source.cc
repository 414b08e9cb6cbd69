#include "surgeon_site/script_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "common/core/byte_order_mark.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "surgeon_site/drawn_script.h"
#include "surgeon_site/recording_reader.h"
#include "surgeon_site/script_reader.h"

namespace palp::surgeon {
namespace {

/// The text of a script or a recorded hand.
Result<std::string> read_file(const std::string& path) {
  constexpr std::size_t kSizeMax = 256U << 20U;  // [bytes]: hours of motion at 1 kHz
  const Result<std::string> text = read_whole_file(path, kSizeMax);
  if (!text) return tl::unexpected<Error>(text.error());
  return std::string{without_byte_order_mark(*text)};
}

Result<GestureScript> random_script(std::string_view text, const ScriptSetting& setting) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seed);
  if (error != std::errc{} || stop != end) {
    return fail("script:random: the seed '" + printable(text) + "' must be a whole number");
  }
  return drawn_script(seed, setting);
}

struct Ready {
  std::string_view name;
  GestureScript (*make)(const ScriptSetting&);
};

constexpr std::array kReady{Ready{"script:standard", standard_script},
                            Ready{"script:demo", demo_script},
                            Ready{"script:map", map_script},
                            Ready{"script:search", search_script},
                            Ready{"script:breath", breath_script},
                            Ready{"script:long", long_script}};
constexpr std::string_view kRandom = "script:random:";

}  // namespace

bool is_ready_made(const std::string& source) {
  return source.starts_with(kRandom) ||
         std::ranges::any_of(kReady, [&](const Ready& one) { return one.name == source; });
}

Result<GestureScript> load_script(const std::string& source, const ScriptSetting& setting) {
  for (const Ready& ready : kReady) {
    if (source == ready.name) return ready.make(setting);
  }
  constexpr std::string_view kScript = "script:";
  constexpr std::string_view kReplay = "replay:";
  constexpr std::string_view kRecording = "recording:";
  if (source.starts_with(kRandom)) return random_script(source.substr(kRandom.size()), setting);
  if (source.starts_with(kRecording)) {
    return load_recording(source.substr(kRecording.size()), setting.hand_stiffness);
  }
  const bool replay = source.starts_with(kReplay);
  if (!replay && !source.starts_with(kScript)) {
    return fail("unknown master '" + printable(source) + "'" +
                ", expected script:standard, script:demo, script:map, script:search, "
                "script:breath, script:long, "
                "script:random:SEED, script:FILE, replay:FILE or recording:FILE, or a device: "
                "openffboard, paddle, spacemouse, orca");
  }
  const std::string path = source.substr(replay ? kReplay.size() : kScript.size());
  const Result<std::string> text = read_file(path);
  if (!text) return fail(replay ? "replay" : "script", text.error());
  Result<GestureScript> script =
      replay ? parse_replay(*text) : parse_script(*text, setting.hand_stiffness);
  if (!script) return fail(path, script.error());
  if (!replay) script->set_text(*text);
  return script;
}

}  // namespace palp::surgeon
