// Writes the first inputs of the targets datagram, link_script and session: fuzz_wire_seeds CORPUS.
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/link/codec_control.h"
#include "common/link/codec_wire.h"
#include "common/link/packet_protection.h"
#include "tests/common/link/some_telegram.h"

namespace palp::link {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, std::span<const std::byte> bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream file{path, std::ios::binary};
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

void write(const fs::path& path, const std::vector<int>& bytes) {
  std::vector<std::byte> out;
  out.reserve(bytes.size());
  for (const int byte : bytes) out.push_back(static_cast<std::byte>(byte));
  write(path, out);
}

void write_datagram(const fs::path& path, PacketType type, std::span<const std::byte> content) {
  std::vector<std::byte> out(kHeaderSize + content.size());
  (void)PlainProtection{}.seal({.type = type, .connection = 3, .number = 7}, content, out);
  write(path, out);
}

void datagrams(const fs::path& corpus) {
  WireCodec codec;
  std::array<std::byte, message::kTelegramSizeMax> content{};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const std::size_t size = codec.encode(some_telegram(seed), content);
    write_datagram(corpus / "datagram" / ("telegram-" + std::to_string(seed)),
                   PacketType::Data,
                   std::span{content}.first(size));
  }
  const ControlBytes hello = encode(Hello{.role = Role::Patient,
                                          .session_id = 1,
                                          .peer_session_id = 2,
                                          .connection_id = 3,
                                          .settings_hash = 4,
                                          .coupling = "direct",
                                          .git = "0123abc"});
  write_datagram(corpus / "datagram" / "hello", PacketType::Control, hello.view());
  const ControlBytes bye =
      encode(Bye{.session_id = 1, .peer_session_id = 2, .reason = ByeReason::Busy, .text = "busy"});
  write_datagram(corpus / "datagram" / "bye", PacketType::Close, bye.view());
}

/// The bytes are the deeds of link_script.cc and session.cc, in their order: direction, deed,
/// details.
void scripts(const fs::path& corpus) {
  write(corpus / "link_script" / "quiet", {0, 11, 31, 0, 11, 31});
  write(corpus / "link_script" / "loss", {0, 11, 9, 0, 0, 0, 3, 0, 0, 0, 0, 11, 31});
  write(corpus / "link_script" / "twice",
        {0, 11, 9, 1, 0, 1, 9, 0, 0, 4, 0, 11, 31, 0, 2, 0, 11, 3});
  write(corpus / "link_script" / "silence", {0, 11, 9, 1, 5, 0, 6, 255, 255, 1, 5, 0, 11, 31});
  write(corpus / "link_script" / "new-session", {0, 11, 9, 0, 7, 0, 11, 9, 1, 9, 0, 11, 9});
  write(corpus / "link_script" / "epoch",
        {0, 11, 9, 0, 4, 1, 1, 2, 1, 0, 11, 9, 1, 4, 2, 0, 1, 2, 0, 11, 9});
  write(corpus / "link_script" / "lie",
        {0, 11, 9, 0, 3, 20, 1, 0, 0, 11, 20, 2, 10, 1, 0, 0, 0, 0, 10, 1});
  write(corpus / "session" / "meet", {0, 11, 63});
  write(corpus / "session" / "work",
        {0, 11, 63, 0, 5, 1, 1, 5, 1, 0, 11, 9, 0, 3, 0, 0, 1, 0, 0, 0});
  write(corpus / "session" / "restart", {0, 11, 63, 0, 6, 0, 11, 63, 1, 6, 0, 11, 63});
  write(corpus / "session" / "replay",
        {0, 11, 63, 0, 2, 1, 1, 2, 1, 0, 11, 9, 0, 0, 1, 20, 1, 0, 11, 9});
  write(corpus / "session" / "bye", {0, 11, 63, 0, 4, 0, 1, 0, 1, 4, 1, 0, 2, 0, 11, 9});
  write(corpus / "session" / "leave", {0, 11, 63, 1, 8, 0, 0, 11, 63});
}

}  // namespace
}  // namespace palp::link

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_wire_seeds CORPUS\n");
    return 2;
  }
  try {
    palp::link::datagrams(argv[1]);
    palp::link::scripts(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
