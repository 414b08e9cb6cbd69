#include "common/io/secure/room_key.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include "common/io/secure/openssl_handles.h"

namespace palp::io {
namespace {

/// Keeps the digest of a name from being that of anything else.
constexpr std::string_view kRoomLabel = "palp relay room 1: ";

const unsigned char* as_octets(const std::byte* bytes) noexcept {
  return reinterpret_cast<const unsigned char*>(bytes);
}

struct FreeDigest {
  void operator()(EVP_MD_CTX* one) const noexcept { EVP_MD_CTX_free(one); }
};
using DigestHandle = std::unique_ptr<EVP_MD_CTX, FreeDigest>;

}  // namespace

struct RoomKey::Key {
  Openssl<EVP_PKEY> pair;
};

RoomKey::RoomKey() : key_{std::make_unique<Key>()} {}
RoomKey::RoomKey(RoomKey&&) noexcept = default;
RoomKey& RoomKey::operator=(RoomKey&&) noexcept = default;
RoomKey::~RoomKey() = default;

Result<RoomKey> RoomKey::from_name(std::string_view name) {
  if (name.size() < kNameMin || name.size() > kNameMax) {
    return fail("the name of a room has 16 to 64 characters, since whoever guesses it can enter");
  }
  if (!std::ranges::all_of(name, [](char one) { return one > ' ' && one < '\x7f'; })) {
    return fail("the name of a room has printable characters without blanks only");
  }
  std::string text{kRoomLabel};
  text += name;
  std::array<unsigned char, EVP_MAX_MD_SIZE> seed{};
  unsigned size = 0;
  RoomKey key;
  if (EVP_Digest(text.data(), text.size(), seed.data(), &size, EVP_sha256(), nullptr) == 1) {
    key.key_->pair.reset(
        EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, seed.data(), size));
  }
  OPENSSL_cleanse(seed.data(), seed.size());
  std::size_t length = key.id_.size();
  if (key.key_->pair == nullptr ||
      EVP_PKEY_get_raw_public_key(
          key.key_->pair.get(), reinterpret_cast<unsigned char*>(key.id_.data()), &length) != 1) {
    throw std::runtime_error{"cannot make the key of a room: " + openssl_complaint()};
  }
  return key;
}

RoomProof RoomKey::sign(std::span<const std::byte> message) const {
  RoomProof proof{};
  std::size_t size = proof.size();
  const DigestHandle digest{EVP_MD_CTX_new()};
  if (EVP_DigestSignInit(digest.get(), nullptr, nullptr, nullptr, key_->pair.get()) != 1 ||
      EVP_DigestSign(digest.get(),
                     reinterpret_cast<unsigned char*>(proof.data()),
                     &size,
                     as_octets(message.data()),
                     message.size()) != 1) {
    throw std::runtime_error{"cannot sign for a room: " + openssl_complaint()};
  }
  return proof;
}

bool proves_room(const RoomId& room,
                 std::span<const std::byte> message,
                 const RoomProof& proof) noexcept {
  const Openssl<EVP_PKEY> key{
      EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, as_octets(room.data()), room.size())};
  const DigestHandle digest{EVP_MD_CTX_new()};
  const bool proven =
      key != nullptr && digest != nullptr &&
      EVP_DigestVerifyInit(digest.get(), nullptr, nullptr, nullptr, key.get()) == 1 &&
      EVP_DigestVerify(digest.get(),
                       as_octets(proof.data()),
                       proof.size(),
                       as_octets(message.data()),
                       message.size()) == 1;
  ERR_clear_error();
  return proven;
}

}  // namespace palp::io
