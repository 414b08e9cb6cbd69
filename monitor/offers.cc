#include "monitor/offers.h"

#include <algorithm>
#include <array>
#include <string>

#include "monitor/status_json.h"

namespace palp::monitor {
namespace {

using record::Topic;

/// What a screen can take: 50 Hz and slower. The 1 kHz topics are in the file alone.
constexpr std::array kLive{
    Topic::TickView, Topic::Link, Topic::Event, Topic::Depth, Topic::Map, Topic::MapCell};

Channel camera_channel(link::Role site, bool jpeg) {
  const video::CameraFormat format = video::camera_format(jpeg);
  Channel channel = channel_of({.topic = {},
                                .name = std::string{record::site_name(site)} + "/" + format.topic,
                                .schema = format.schema,
                                .descriptors = format.descriptors});
  channel.id = jpeg ? kJpegChannel : kCameraChannel;
  return channel;
}

Channel json_channel(std::uint32_t id,
                     link::Role site,
                     const std::string& topic,
                     const std::string& schema_name,
                     const std::string& schema) {
  return {.id = id,
          .topic = std::string{record::site_name(site)} + "/" + topic,
          .encoding = "json",
          .schema_name = "palp.monitor." + schema_name,
          .schema = schema};
}

}  // namespace

std::vector<Channel> channels_of(link::Role site, const Controls& controls) {
  std::vector<Channel> channels;
  for (const record::TopicFormat& format : record::topics_of(site)) {
    if (std::ranges::find(kLive, format.topic) == kLive.end()) continue;
    channels.push_back(channel_of(format));
  }
  channels.push_back(json_channel(kStatusChannel, site, "status", "Status", status_schema()));
  channels.push_back(json_channel(kClientChannel, site, "client", "Client", client_schema()));
  if (controls.camera != nullptr) {
    channels.push_back(camera_channel(site, false));
    channels.push_back(camera_channel(site, true));
    channels.push_back(json_channel(kVideoChannel, site, "video", "Video", video_schema()));
  }
  if (controls.study != nullptr) {
    channels.push_back(json_channel(kStudyChannel, site, "study", "Study", R"({"type":"object"})"));
  }
  return channels;
}

std::vector<Service> services_of(const Controls& controls) {
  if (controls.requests == nullptr) return {};
  std::vector<Service> services{
      {kMark, "mark"}, {kStop, "stop"}, {kReset, "reset"}, {kEnd, "end_session"}};
  if (controls.pointer != nullptr) {
    services.push_back({kTake, "pointer/take"});
    services.push_back({kGive, "pointer/give"});
  }
  if (controls.study != nullptr) services.push_back({kAnswer, "study/answer"});
  return services;
}

}  // namespace palp::monitor
