// Input: datagrams that a stranger without keys sends to a patient and to a surgeon who expect
// sealed words: a length, its high byte first, then so many bytes.
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include "common/core/check.h"
#include "common/io/secure/certificates.h"
#include "common/io/secure/credentials.h"
#include "common/io/secure/dtls_session.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/own_path.h"

namespace palp::io {
namespace {

using fuzz::ByteSource;
using link::Role;

std::unique_ptr<Credentials> read_key(const std::filesystem::path& folder, Role role) {
  auto read = Credentials::read(folder / (role == Role::Surgeon ? "surgeon" : "patient"), role);
  if (!read) throw std::runtime_error{read.error().text};
  return std::move(*read);
}

/// Made once: a bench's key, because certificates would cost most of the time.
struct Keys {
  Keys() {
    const auto folder = palp::test::own_path("fuzz");
    const auto made = make_pre_shared_key(folder);
    if (!made) throw std::runtime_error{made.error().text};
    surgeon = read_key(folder, Role::Surgeon);
    patient = read_key(folder, Role::Patient);
    std::filesystem::remove_all(folder);
  }
  std::unique_ptr<Credentials> surgeon;
  std::unique_ptr<Credentials> patient;
};

void check(const SessionEndpointOutput& out) {
  PALP_CHECK(!out.event || std::holds_alternative<link::Refused>(*out.event),
             "no stranger begins or ends a session");
  PALP_CHECK(out.protection == nullptr, "no stranger changes keys");
  PALP_CHECK(!out.moved_to, "no stranger moves anybody");
}

void run(ByteSource input) {
  static const Keys keys;
  static const Endpoint patient_at = *resolve_endpoint("127.0.0.1:2000");
  static const Endpoint stranger_at = *resolve_endpoint("127.0.0.1:1000");
  const auto session_of = [](Role role) {
    return link::SessionConfig{
        .role = role, .settings_hash = 77, .coupling = "direct", .git = "abc"};
  };
  DtlsSession patient{{.session = session_of(Role::Patient), .callee = {}}, *keys.patient, 1};
  DtlsSession surgeon{
      {.session = session_of(Role::Surgeon), .callee = patient_at}, *keys.surgeon, 2};
  TimePoint now{};
  check(surgeon.tick(now, {}));  // calls
  for (int count = 0; count < 64 && !input.empty(); ++count) {
    const std::size_t size =
        input.take<std::uint8_t>() * std::size_t{256} + input.take<std::uint8_t>();
    const auto datagram = input.take_bytes(size);
    now += std::chrono::milliseconds{5};
    const SessionEndpointOutput answer = patient.hear(datagram, stranger_at, now);
    check(answer);
    std::size_t answered = 0;
    for (const Letter& letter : answer.letters) {
      PALP_CHECK(letter.to == stranger_at, "answers go to who asked");
      answered += letter.bytes.size();
    }
    PALP_CHECK(answered <= datagram.size(), "nobody's traffic grows here");
    check(surgeon.hear(datagram, patient_at, now));
    check(patient.tick(now, {}));
    check(surgeon.tick(now, {}));
  }
}

}  // namespace
}  // namespace palp::io

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palp::io::run(palp::fuzz::ByteSource{palp::fuzz::as_bytes(data, size)});
  return 0;
}
