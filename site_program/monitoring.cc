#include "site_program/monitoring.h"

#include <stdexcept>

#include "common/io/process/entropy.h"
#include "common/record/wall_clock.h"

namespace palp::site_program {
namespace {

using monitor::Request;
using record::NoteCode;

/// 128 bits.
std::string draw_token() {
  return record::session_id_text(io::draw_entropy()) + record::session_id_text(io::draw_entropy());
}

NoteCode code_of(Request::Kind kind) {
  switch (kind) {
    case Request::Kind::Mark:
      return NoteCode::MarkAsked;
    case Request::Kind::Stop:
      return NoteCode::StopAsked;
    case Request::Kind::Reset:
      return NoteCode::ResetAsked;
    case Request::Kind::End:
      return NoteCode::EndAsked;
    case Request::Kind::PilotTook:
      return NoteCode::PointerTaken;
    case Request::Kind::PilotGave:
      return NoteCode::PointerGiven;
  }
  return NoteCode::None;
}

}  // namespace

Monitoring::Monitoring(const settings::MonitorSettings& settings,
                       const Facts& facts,
                       Recording& recording,
                       std::optional<MonitoredSite> site) {
  monitor::Feed* const feed = recording.feed();
  if (!settings.serve || feed == nullptr) return;
  tokens_.view = draw_token();
  monitor::Controls controls;
  if (site) {
    tokens_.control = draw_token();
    controls = {.requests = &requests_,
                .stops = site->stops,
                .pointer = site->pointer,
                .camera = site->media != nullptr ? &camera_ : nullptr,
                .study = site->study};
  }
  const std::string site_name{record::site_name(feed->site())};
  monitor::ServerConfig config{.desk = {.site = feed->site(),
                                        .program = "palp-" + site_name,
                                        .run = record::session_id_text(io::draw_entropy()),
                                        .facts = facts},
                               .tokens = tokens_,
                               .port = settings.port,
                               .origins = {}};
  if (!settings.origin.empty()) config.origins.push_back(settings.origin);
  try {
    server_ = std::make_unique<monitor::Server>(config, controls, *feed);
  } catch (const std::runtime_error& error) {
    fault_ = error.what();
    return;
  }
  if (controls.camera == nullptr) return;
  watching_ = std::make_unique<CameraWatching>(recording.has_file(),
                                               *site->media,
                                               site->touch_hold,
                                               *recording.camera(),
                                               camera_,
                                               [server = server_.get()] { server->wake(); });
}

Monitoring::~Monitoring() = default;

void Monitoring::announce(StatusLine& line) const {
  if (!fault_.empty()) line.warn(fault_ + "; the session goes on without a page");
  if (!server_) return;
  if (const std::string page = control_page(); !page.empty()) {
    line.info("monitor, with control: " + page);
  }
  line.info("monitor, only to look: " + page_of(tokens_.view));
}

std::string Monitoring::page_of(const std::string& token) const {
  return "http://127.0.0.1:" + std::to_string(server_->port()) + "/#" + token;
}

std::string Monitoring::control_page() const {
  return server_ && !tokens_.control.empty() ? page_of(tokens_.control) : std::string{};
}

void Monitoring::tell_news(StatusLine& line) {
  if (watching_) watching_->tell_news(line);
  if (!server_ || told_of_failure_) return;
  const auto failure = server_->failure();
  if (!failure) return;
  told_of_failure_ = true;
  line.warn("the monitor has ended: " + *failure + "; the session goes on without its page");
}

void Monitoring::look(Recording& recording, TimePoint now) {
  for (Request request; requests_.try_dequeue(request);) {
    recording.note(code_of(request.kind), request.client, now);
    marks_ += request.kind == Request::Kind::Mark ? 1 : 0;
    resets_ += request.kind == Request::Kind::Reset ? 1 : 0;
    end_asked_ = end_asked_ || request.kind == Request::Kind::End;
  }
}

void Monitoring::stop() {
  watching_.reset();
  server_.reset();
}

}  // namespace palp::site_program
