#include "tests/house/arrows.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fnmatch.h>

namespace palp::house {
namespace {

/// Rooms, the longer name first where one lies in another.
constexpr std::array<std::string_view, 39> kRooms{"common/core",
                                                  "common/message",
                                                  "common/coupling",
                                                  "common/link",
                                                  "common/config",
                                                  "common/settings",
                                                  "common/record",
                                                  "common/io/process",
                                                  "common/io/realtime",
                                                  "common/io/device",
                                                  "common/io/net",
                                                  "common/io/secure",
                                                  "common/io",
                                                  "common/plot",
                                                  "video",
                                                  "monitor",
                                                  "site_program",
                                                  "netem/model",
                                                  "netem/syntax",
                                                  "netem/relay",
                                                  "netem",
                                                  "relay",
                                                  "fem",
                                                  "depth",
                                                  "surgeon_site/devices",
                                                  "surgeon_site",
                                                  "patient_site/devices",
                                                  "patient_site",
                                                  "judge",
                                                  "lab/run",
                                                  "lab/plan",
                                                  "lab/report",
                                                  "lab",
                                                  "review",
                                                  "study/closed_loop",
                                                  "study/real_sites",
                                                  "study",
                                                  "proto",
                                                  "tests"};

/// What files may include besides their own room and core: rooms, all sub-rooms of one ("netem/*"),
/// or single headers.
struct Arrow {
  std::string_view from;  ///< pattern of paths; the first row that matches counts
  std::vector<std::string_view> to;
};

/// One list.
// NOLINTNEXTLINE(readability-function-size): a table
const std::vector<Arrow>& arrows() {
  static const std::vector<Arrow> table{
      {"common/core/*", {}},
      {"common/message/*", {}},
      {"common/coupling/*", {"common/message"}},
      {"common/link/*", {"common/message"}},
      {"common/config/*", {}},
      {"common/settings/*", {"common/coupling", "common/link", "common/config"}},
      {"common/record/*", {"common/message", "common/link"}},
      {"common/io/process/*", {}},
      {"common/io/realtime/*", {"common/io/process"}},
      {"common/io/device/*", {"common/io/process", "common/io/realtime"}},
      {"common/io/net/*",
       {"common/io/process", "common/io/realtime", "common/message", "common/link"}},
      {"common/io/secure/*", {"common/io/*", "common/message", "common/link"}},
      {"common/plot/pdf.*", {"common/io/process"}},
      {"common/plot/picture.*", {"common/config"}},
      {"common/plot/*", {}},
      // The emulator as a program; its library sees nothing but the seam.
      {"netem/model/*", {"common/link/transport.h"}},
      {"netem/syntax/*", {"netem/model"}},
      {"netem/relay/*",
       {"netem/model", "netem/syntax", "common/link/transport.h", "common/io/*", "common/config"}},
      {"netem/main.cc", {"netem/*", "common/io/*", "common/config"}},
      {"netem/presets_command.*", {"netem/syntax", "common/config"}},
      // A relay between sites: it has no keys, and knows nothing of couplings or impairments.
      {"relay/*", {"common/link", "common/io/*", "common/config"}},
      // Pictures to datagrams and back: no clock, no socket, no record.
      {"video/*", {"common/link", "common/message"}},
      // The live page: what the session file gets, for screens. It sees no site and no link.
      {"monitor/server.cc",
       {"common/record", "common/message", "common/link", "common/io/realtime", "video"}},
      {"monitor/*", {"common/record", "common/message", "common/link", "common/config", "video"}},
      // What the two programs of a session do alike: it puts parts together, as their main.cc does.
      {"site_program/*",
       {"common/config",
        "common/settings",
        "common/message",
        "common/link",
        "common/record",
        "common/io/*",
        "monitor",
        "video",
        "netem/*"}},
      {"fem/main.cc",
       {"common/config", "common/io/process/parallel.h", "common/io/process/process_time.h"}},
      {"fem/*_command.*", {"common/config", "common/plot"}},
      {"fem/database_processes.cc", {"common/config/report.h"}},
      // How far off the database is between its points: read as the estimators read it.
      {"fem/interpolation_check.cc", {"depth/depth_database.h"}},
      {"fem/*", {}},
      // What fem solved: the table's format and the words for a specimen.
      {"depth/*", {"common/message", "fem/depth_table.h", "fem/specimen.h"}},
      // A site: main puts it together, settings reads its configuration, devices are adapters.
      {"surgeon_site/main.cc",
       {"surgeon_site/devices",
        "site_program",
        "common/message",
        "common/coupling",
        "common/link",
        "common/record",
        "common/config",
        "common/settings",
        "common/io/*",
        "netem/*"}},
      {"surgeon_site/devices/*", {"surgeon_site/haptic_device.h", "common/io/*"}},
      {"surgeon_site/devices_command.*",
       {"surgeon_site/devices", "common/config", "common/io/*", "site_program"}},
      {"surgeon_site/master_check.*", {"surgeon_site/devices", "common/io/device", "site_program"}},
      {"surgeon_site/session_end.*", {"common/config", "common/record", "site_program"}},
      // What a study and its participant's page say to each other.
      {"surgeon_site/study_port.*",
       {"common/config", "common/io/process", "common/record", "monitor", "site_program"}},
      {"surgeon_site/hand_plan.*", {"surgeon_site/devices", "common/settings"}},
      {"surgeon_site/settings_devices.*",
       {"surgeon_site/devices", "common/io/device", "common/config", "common/settings"}},
      {"surgeon_site/settings.*",
       {"common/message",
        "common/coupling",
        "common/link",
        "common/record",
        "common/config",
        "common/settings"}},
      {"surgeon_site/*", {"common/message", "common/coupling", "common/link", "common/record"}},
      {"patient_site/drawn_camera.*", {"video"}},
      {"patient_site/captured_camera.*", {"video", "common/io/device", "common/io/process"}},
      {"patient_site/main.cc",
       {"patient_site/devices",
        "video",
        "site_program",
        "depth",
        "common/message",
        "common/coupling",
        "common/link",
        "common/record",
        "common/config",
        "common/settings",
        "common/io/*",
        "netem/*"}},
      {"patient_site/devices/*",
       {"patient_site/stage.h",
        "patient_site/force_sensor.h",
        "patient_site/plane_motion.h",
        "patient_site/servo_watch.h",
        "common/io/*"}},
      {"patient_site/devices_command.*",
       {"patient_site/devices", "common/config", "common/io/*", "site_program"}},
      {"patient_site/axis_check.*", {"patient_site/devices", "common/io/device", "site_program"}},
      {"patient_site/sensor_check.*", {"site_program"}},
      {"patient_site/force_check.*", {"patient_site/devices", "common/io/device", "site_program"}},
      {"patient_site/device_check.*", {"patient_site/devices", "common/io/*", "site_program"}},
      // Reads the text of a device's registers, and of where it is built in.
      {"patient_site/settings_devices.*",
       {"patient_site/devices", "common/io/device", "common/config", "common/settings"}},
      {"patient_site/settings.*",
       {"depth",
        "common/message",
        "common/coupling",
        "common/link",
        "common/record",
        "common/config",
        "common/settings"}},
      {"patient_site/tissue_record.*", {"common/record", "common/config/number.h"}},
      // Closed solution of a domed surface.
      {"patient_site/block_tissue.*", {"depth", "fem/sneddon_sphere.h"}},
      {"patient_site/*",
       {"depth", "common/message", "common/coupling", "common/link", "common/record"}},
      // What is judged of a run, offline: no site sees it, and it sees none.
      {"judge/*", {"common/message", "common/config/json.h"}},
      {"lab/run/*",
       {"surgeon_site",
        "patient_site",
        "depth",
        "judge",
        "review/phase_finder.h",
        "common/config/number.h",
        "netem/model",
        "common/message",
        "common/coupling",
        "common/link",
        "common/record"}},
      {"lab/plan/*",
       {"lab/run",
        "surgeon_site",
        "patient_site",
        "depth",
        "judge",
        "netem/model",
        "netem/syntax",
        "common/message",
        "common/coupling",
        "common/link",
        "common/config",
        "common/settings"}},
      {"lab/report/*",
       {"lab/run", "lab/plan", "depth", "judge", "common/message", "common/config", "common/plot"}},
      {"lab/main.cc",
       {"lab/*",
        "review/session_figure.h",
        "common/config",
        "common/plot",
        "common/io/process",
        "site_program/build_info.h"}},
      {"lab/*",
       {"lab/*",
        "judge/metric_table.h",
        "common/coupling",
        "common/config",
        "common/plot",
        "common/io/process/process_time.h",
        "common/io/process/parallel.h"}},
      // Experiments with observers: no clock; files in commands, the journal and the data set only,
      // to which belong the lists of who answers and who withdrew.
      {"study/main.cc",
       {"study/closed_loop",
        "study/real_sites",
        "common/config",
        "common/io/process/entropy.h",
        "common/io/process/parallel.h",
        "site_program/build_info.h"}},
      {"study/report_command.*", {"common/config", "common/plot"}},
      {"study/*_command.*", {"common/config"}},
      {"study/study_report.*", {"common/plot"}},
      {"study/study_file.*", {"common/config"}},
      {"study/data_set.*", {"common/config"}},
      {"study/who_answers.*", {"common/config"}},
      {"study/letters.*", {"common/config/json.h"}},
      {"study/preregistration.*", {"common/config/number.h"}},
      {"study/schedule.*", {"common/config/json.h"}},
      {"study/answers_file.*", {"common/config/number.h"}},
      {"study/trial_row.*", {"common/config/number.h"}},
      {"study/exports.*", {"common/config/number.h"}},
      // Stimuli as tissue.
      {"study/level_curves.*", {"patient_site", "common/config/number.h"}},
      // Observers that feel whole sessions: where study and lab meet.
      {"study/closed_loop/*",
       {"study", "lab/run", "lab/plan", "surgeon_site", "patient_site", "common/config"}},
      // Trials at both sites' programs: where study has processes and a clock.
      {"study/real_sites/*",
       {"study",
        "patient_site",
        "common/config",
        "common/record",
        "common/io/process",
        "common/io/realtime"}},
      {"study/*", {}},
      // What a site did is done again by the site's own control, and judged as the lab judges.
      {"review/*",
       {"common/message",
        "common/link",
        "common/record",
        "common/coupling",
        "common/config",
        "common/plot",
        "surgeon_site",
        "patient_site",
        "depth",
        "judge"}},
  };
  return table;
}

/// A library and the files that may see it.
struct Fence {
  std::string_view library;  ///< beginning of the include
  std::vector<std::string_view> only_in;
};

/// The files that speak protobuf: schema in, plain structs out.
const std::vector<std::string_view>& protobuf_files() {
  static const std::vector<std::string_view> files{"common/link/codec_control.cc",
                                                   "common/config/*.cc",
                                                   "common/settings/*.cc",
                                                   "surgeon_site/settings*.cc",
                                                   "patient_site/settings*.cc",
                                                   "lab/plan/scenario*.cc",
                                                   "netem/syntax/timeline.cc",
                                                   "video/camera_frame.cc",
                                                   "study/study_file.cc",
                                                   "fem/depth_table.cc"};
  return files;
}

const std::vector<Fence>& fences() {
  static const std::vector<Fence> table{
      {"modbus/", {"common/io/device/modbus_port.cc"}},
      {"hidapi/", {"common/io/device/hid_port.cc"}},
      {"seccomp.h", {"common/io/process/system_call_filter.cc"}},
      {"boost/asio", {"common/io/net/*.cc", "common/io/secure/*.cc", "monitor/server.cc"}},
      {"boost/beast", {"monitor/server.cc"}},
      {"boost/math", {"study/compare.cc"}},
      {"google/protobuf/", protobuf_files()},
      {"wels/", {"video/openh264_encoder.cc"}},
      {"turbojpeg.h", {"video/jpeg_encoder.cc"}},
      {"zstd", {"common/record/mcap_*.cc"}},
      {"zlib.h", {"common/record/mcap_*.cc"}},
      // Programs without a schema of their own have flags of their own.
      {"CLI/", {"common/config/command_line.cc"}},
      {"spdlog/", {"common/io/process/diagnostics.cc", "*/main.cc"}},
      {"fmt/", {"common/io/process/diagnostics.cc", "*/main.cc"}},
      {"openssl/",
       {"common/link/aead_protection.cc",
        "common/io/secure/credentials.cc",
        "common/io/secure/dtls_*.cc",
        "common/io/secure/address_cookie.cc",
        "common/io/secure/room_key.cc",
        "common/io/secure/certificates.cc",
        "common/io/secure/openssl_*.h",
        "common/io/secure/site_certificate.*",
        "study/data_set.cc"}},
      {"readerwriterqueue/", {"common/core/spsc_queue.h"}},
      // link answers with reasons of its own, not with sentences.
      {"tl/expected.hpp", {"common/core/result.h"}},
      {"nlohmann/", {"common/config/json.cc"}},
      {"Eigen/", {"fem/*"}},
      {"ceres/", {"fem/depth_formula.cc"}},
      {"gtest/", {}},
      {"gmock/", {}},
      {"rapidcheck", {}},
      {"benchmark/", {}},
  };
  return table;
}

/// Of the system and the C library; the standard library's headers have no '.' and no '/'.
constexpr std::array<std::string_view, 24> kSystemHeaders{
    "sys/",       "netinet/", "arpa/",    "net/",        "linux/",      "unistd.h",
    "fcntl.h",    "poll.h",   "malloc.h", "pthread.h",   "sched.h",     "signal.h",
    "time.h",     "errno.h",  "dlfcn.h",  "fnmatch.h",   "termios.h",   "semaphore.h",
    "execinfo.h", "cxxabi.h", "netdb.h",  "immintrin.h", "xmmintrin.h", "spawn.h"};

bool matches_any(std::string_view path, const std::vector<std::string_view>& patterns) {
  return std::ranges::any_of(patterns, [&](auto pattern) { return matches(path, pattern); });
}

/// A room itself, or "netem/*": its sub-rooms.
bool names_room(std::string_view entry, std::string_view room) {
  return entry == room ||
         (entry.ends_with("/*") && room.starts_with(entry.substr(0, entry.size() - 1)));
}

bool arrow_allowed(const Source& source, const std::string& target) {
  const std::string_view from = room_of(source.path);
  const std::string_view to = room_of(target);
  if (from == "tests" || to == from || to == "common/core") return true;
  for (const Arrow& arrow : arrows()) {
    if (!matches(source.path, arrow.from)) continue;
    return std::ranges::any_of(arrow.to,
                               [&](auto one) { return one == target || names_room(one, to); });
  }
  return false;
}

}  // namespace

bool matches(std::string_view path, std::string_view pattern) {
  return fnmatch(std::string{pattern}.c_str(), std::string{path}.c_str(), FNM_PATHNAME) == 0;
}

std::string_view room_of(std::string_view path) {
  for (const std::string_view room : kRooms) {
    if (path.size() > room.size() && path.starts_with(room) && path[room.size()] == '/') {
      return room;
    }
  }
  return {};
}

Violations forbidden_arrows(const Source& source) {
  Violations found;
  const std::string_view from = room_of(source.path);
  if (from.empty()) {
    if (source.is_code()) found.push_back({source.path, 0, "lies in no room of the table"});
    return found;
  }
  for (const Include& include : includes(source)) {
    if (!include.quoted || include.target.ends_with(".pb.h")) continue;
    const std::string_view to = room_of(include.target);
    if (to.empty()) {
      found.push_back({source.path,
                       include.line,
                       "\"" + include.target + "\" is in no room: include from the root"});
    } else if (!arrow_allowed(source, include.target)) {
      found.push_back(
          {source.path, include.line, std::string{from} + " may not include " + include.target});
    }
  }
  return found;
}

Violations broken_fences(const Source& source) {
  Violations found;
  if (room_of(source.path) == "tests") return found;
  for (const Include& include : includes(source)) {
    const std::string& target = include.target;
    const auto tell = [&](const std::string& sentence) {
      found.push_back({source.path, include.line, sentence});
    };
    if (target.ends_with(".pb.h")) {
      if (!matches_any(source.path, protobuf_files())) tell(target + " is protobuf: behind a .cc");
      continue;
    }
    if (include.quoted) continue;
    const auto fence = std::ranges::find_if(
        fences(), [&](const Fence& one) { return target.starts_with(one.library); });
    if (fence != fences().end()) {
      if (!matches_any(source.path, fence->only_in)) tell("<" + target + "> is outside its fence");
      continue;
    }
    const bool standard = target.find_first_of("./") == std::string::npos;
    const bool system = std::ranges::any_of(
        kSystemHeaders, [&](auto beginning) { return target.starts_with(beginning); });
    if (!standard && !system) tell("<" + target + "> belongs to a library without a fence");
  }
  return found;
}

}  // namespace palp::house
