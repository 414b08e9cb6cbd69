#include "relay/relay_report.h"

#include "common/config/json.h"

namespace palp::relay {

std::string status_line(const Rooms& rooms) {
  const RoomCounts& counts = rooms.counts();
  return std::to_string(rooms.rooms()) + " rooms, " + std::to_string(counts.forwarded) +
         " datagrams forwarded, " + std::to_string(counts.unknown + counts.junk) +
         " of strangers, " + std::to_string(counts.forged + counts.stale) + " joins refused, " +
         std::to_string(counts.over_rate) + " above a rate";
}

std::string to_json(const RoomCounts& counts, Duration span) {
  const config::Json json{{"schema", "palp.rooms/1"},
                          {"outcome", "completed"},
                          {"duration_s", seconds(span)},
                          {"forwarded", counts.forwarded},
                          {"alone", counts.alone},
                          {"unknown", counts.unknown},
                          {"over_rate", counts.over_rate},
                          {"junk", counts.junk},
                          {"cookies", counts.cookies},
                          {"joins", counts.joins},
                          {"forged", counts.forged},
                          {"stale", counts.stale},
                          {"refused", counts.refused}};
  return json.dump(2) + "\n";
}

}  // namespace palp::relay
