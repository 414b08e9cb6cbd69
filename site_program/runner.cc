#include "site_program/runner.h"

#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace palp::site_program {
namespace {

constexpr std::size_t kHeapRoom = std::size_t{4} << 20U;  // [bytes]

/// Of the io thread, below rt, which it must never keep waiting.
int io_priority(int rt_priority) noexcept { return rt_priority > 10 ? rt_priority - 10 : 0; }

/// What follows the words that all refusals begin with.
std::string without_opening(const std::string& sentence) {
  constexpr std::string_view kOpening = "no session: ";
  return sentence.starts_with(kOpening) ? sentence.substr(kOpening.size()) : sentence;
}

}  // namespace

Runner::Runner(const RunnerConfig& config) : loop_{config.loop} {
  io::SessionServerConfig server;
  server.session = config.session;
  server.address = config.address;
  if (config.meeting) {
    server.relay = config.meeting->relay;
    server.room = config.meeting->room;
  }
  server.wrap_transport = config.wrap_transport;
  server.priority = io_priority(loop_.priority);
  if (config.with_media) server.media = &door_;
  if (!config.protection.identity.empty()) {
    auto credentials = io::Credentials::read(config.protection.identity, config.session.role);
    if (!credentials) throw std::runtime_error{credentials.error().text};
    credentials_ = std::move(*credentials);
    server.credentials = credentials_.get();
    server.rekey_after = config.protection.rekey_after;
  }
  server_ = std::make_unique<io::SessionServer>(server, desk_);
}

Runner::~Runner() {
  rt_.reset();
  server_.reset();
}

void Runner::start(link::Link& link, std::function<void(TimePoint now)> tick) {
  const io::LoopConfig loop{.period = loop_.period,
                            .spin = loop_.spin,
                            .priority = loop_.priority,
                            .lock_memory = loop_.lock_memory};
  // What the heap is short of at some time in the session, it has from here on: run() in
  // site_main.cc lets it keep that.
  void* volatile room = std::malloc(kHeapRoom);
  std::free(room);
  rt_ = std::make_unique<io::PeriodicThread>(
      "palp-rt",
      loop,
      [this, &link, tick = std::move(tick)](TimePoint now) {
        desk_.serve(link, now);
        tick(now);
      },
      [&link] { link.warm_up(); });
  service_.ready();
}

std::vector<std::string> Runner::shortcomings() const {
  const io::RealtimeGrant& grant = rt_->grant();
  std::vector<std::string> sentences;
  if (grant.priority < loop_.priority) sentences.push_back(grant.scheduling);
  if (loop_.lock_memory && !grant.memory_locked) sentences.push_back(grant.memory);
  if (credentials_ != nullptr) {
    const std::vector<std::string>& cautions = credentials_->cautions();
    sentences.insert(sentences.end(), cautions.begin(), cautions.end());
  }
  return sentences;
}

void Runner::describe_identity(record::SessionInfo& info) const {
  info.metadata.emplace_back("identity", credentials_ ? credentials_->name() : "none: insecure");
  info.metadata.emplace_back("certificate_sha256", credentials_ ? credentials_->fingerprint() : "");
}

std::optional<std::string> Runner::tell_news(StatusLine& line) {
  using Kind = io::SessionNews::Kind;
  std::optional<std::string> hopeless;
  service_.progress(rt_->progress().ticks);
  while (const auto news = server_->news()) {
    if (news->kind == Kind::Established) {
      ++sessions_;
      peer_ = news->identity;
    }
    if (news->final) {
      hopeless = news->sentence;
    } else if (news->kind == Kind::Refused) {
      line.warn(news->sentence);
      refusal_ = without_opening(news->sentence);
    } else {
      line.info(news->sentence);
    }
  }
  return hopeless;
}

void Runner::stop(const std::string& why) {
  service_.stopping();
  server_->close(why);
  if (rt_) rt_->stop();
}

void Runner::account(SiteReport& report) {
  if (rt_) report.loop = rt_->stop();
  report.noise = server_->noise();
  report.sessions = sessions_;
}

}  // namespace palp::site_program
