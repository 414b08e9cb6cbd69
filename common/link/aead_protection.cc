#include "common/link/aead_protection.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <openssl/evp.h>

#include "common/core/check.h"
#include "common/message/limits.h"

namespace palp::link {

// Members of a named type have one of their own: it is no anonymous namespace's.
struct FreeCipherContext {
  void operator()(EVP_CIPHER_CTX* context) const noexcept { EVP_CIPHER_CTX_free(context); }
};
using CipherContext = std::unique_ptr<EVP_CIPHER_CTX, FreeCipherContext>;

namespace {

using Nonce = std::array<std::uint8_t, AeadKey::kSaltSize>;

constexpr bool kEncrypt = true;
constexpr bool kDecrypt = false;

const std::uint8_t* octets(std::span<const std::byte> bytes) noexcept {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

std::uint8_t* octets(std::span<std::byte> bytes) noexcept {
  return reinterpret_cast<std::uint8_t*>(bytes.data());
}

CipherContext make_context(const AeadKey& key, bool encrypts) {
  CipherContext context{EVP_CIPHER_CTX_new()};
  const Nonce any{};  // the first one allocates
  if (context == nullptr || EVP_CipherInit_ex2(context.get(),
                                               EVP_aes_256_gcm(),
                                               octets(key.key.bytes()),
                                               any.data(),
                                               encrypts ? 1 : 0,
                                               nullptr) != 1) {
    throw std::runtime_error{"cannot prepare AES-256-GCM: OpenSSL has none"};
  }
  return context;
}

/// One block at a time; the mask is made, never undone.
CipherContext make_masking(const Secret<AeadKey::kKeySize>& key) {
  CipherContext context{EVP_CIPHER_CTX_new()};
  if (context == nullptr ||
      EVP_EncryptInit_ex2(
          context.get(), EVP_aes_256_ecb(), octets(key.bytes()), nullptr, nullptr) != 1 ||
      EVP_CIPHER_CTX_set_padding(context.get(), 0) != 1) {
    throw std::runtime_error{"cannot prepare AES-256: OpenSSL has none"};
  }
  return context;
}

using Tag = std::span<const std::byte, AeadProtection::kTagSize>;

/// Hides what is behind the clear part of a header, or shows it again.
bool mask(const CipherContext& masking,
          Tag tag,
          std::span<std::byte, kHeaderSize - kClearSize> part) noexcept {
  std::array<std::uint8_t, AeadProtection::kTagSize> block{};
  int done = 0;
  if (EVP_EncryptUpdate(masking.get(),
                        block.data(),
                        &done,
                        octets(std::span<const std::byte>{tag}),
                        static_cast<int>(block.size())) != 1) {
    return false;
  }
  for (std::size_t i = 0; i < part.size(); ++i) part[i] ^= static_cast<std::byte>(block[i]);
  return true;
}

}  // namespace

struct AeadProtection::Generation {
  explicit Generation(const TrafficKeys& keys)
      : id{keys.id},
        send_salt{keys.send.salt},
        receive_salt{keys.receive.salt},
        sealing{make_context(keys.send, kEncrypt)},
        opening{make_context(keys.receive, kDecrypt)},
        hiding{make_masking(keys.send.header_key)},
        showing{make_masking(keys.receive.header_key)} {
    PALP_CHECK(id <= kKeyMax, "a key id has two bits");
  }
  [[nodiscard]] static Nonce nonce(const Secret<AeadKey::kSaltSize>& salt,
                                   std::uint64_t number) noexcept {
    Nonce nonce{};
    for (std::size_t i = 0; i < nonce.size(); ++i) {
      nonce[i] = std::to_integer<std::uint8_t>(salt.bytes()[i]);
    }
    for (std::size_t i = 0; i < sizeof number; ++i) {
      nonce[nonce.size() - 1 - i] ^= static_cast<std::uint8_t>(number >> (8 * i));
    }
    return nonce;
  }
  bool seal(std::uint64_t number,
            std::span<const std::byte> header,
            std::span<const std::byte> plain,
            std::span<std::byte> out) noexcept;
  bool open(std::uint64_t number,
            std::span<const std::byte> header,
            std::span<const std::byte> sealed,
            std::span<std::byte> plain) noexcept;
  void touch() noexcept;

  std::uint8_t id;
  Secret<AeadKey::kSaltSize> send_salt;
  Secret<AeadKey::kSaltSize> receive_salt;
  CipherContext sealing;
  CipherContext opening;
  CipherContext hiding;    ///< of the headers we send
  CipherContext showing;   ///< of those that come
  std::uint64_t sealed{};  ///< packets
};

bool AeadProtection::Generation::seal(std::uint64_t number,
                                      std::span<const std::byte> header,
                                      std::span<const std::byte> plain,
                                      std::span<std::byte> out) noexcept {
  EVP_CIPHER_CTX* context = sealing.get();
  const Nonce once = nonce(send_salt, number);
  const auto size = static_cast<int>(plain.size());
  int done = 0;
  int rest = 0;
  return EVP_EncryptInit_ex2(context, nullptr, nullptr, once.data(), nullptr) == 1 &&
         EVP_EncryptUpdate(
             context, nullptr, &done, octets(header), static_cast<int>(header.size())) == 1 &&
         EVP_EncryptUpdate(context, octets(out), &done, octets(plain), size) == 1 &&
         EVP_EncryptFinal_ex(context, octets(out) + done, &rest) == 1 && done + rest == size &&
         EVP_CIPHER_CTX_ctrl(context,
                             EVP_CTRL_AEAD_GET_TAG,
                             kTagSize,
                             octets(out.subspan(plain.size(), kTagSize))) == 1;
}

bool AeadProtection::Generation::open(std::uint64_t number,
                                      std::span<const std::byte> header,
                                      std::span<const std::byte> sealed_bytes,
                                      std::span<std::byte> plain) noexcept {
  EVP_CIPHER_CTX* context = opening.get();
  const Nonce once = nonce(receive_salt, number);
  const std::span<const std::byte> content = sealed_bytes.first(sealed_bytes.size() - kTagSize);
  // The call takes the tag through a pointer to what is not const.
  std::array<std::uint8_t, kTagSize> tag{};
  for (std::size_t i = 0; i < kTagSize; ++i) {
    tag[i] = std::to_integer<std::uint8_t>(sealed_bytes[content.size() + i]);
  }
  int done = 0;
  int rest = 0;
  return EVP_DecryptInit_ex2(context, nullptr, nullptr, once.data(), nullptr) == 1 &&
         EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_SET_TAG, kTagSize, tag.data()) == 1 &&
         EVP_DecryptUpdate(
             context, nullptr, &done, octets(header), static_cast<int>(header.size())) == 1 &&
         EVP_DecryptUpdate(
             context, octets(plain), &done, octets(content), static_cast<int>(content.size())) ==
             1 &&
         EVP_DecryptFinal_ex(context, octets(plain) + done, &rest) == 1;
}

/// Walks over key schedules and tables, so that they are in the caches. Nothing is encrypted and no
/// tag is made: no nonce is used, and that of this number never can be.
void AeadProtection::Generation::touch() noexcept {
  constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  static_assert(kNever > message::kNumberMax);
  constexpr int kAsItWas = -1;
  constexpr std::array<std::uint8_t, kHeaderSize> kNothing{};
  int done = 0;
  for (const auto& [context, salt] :
       {std::pair{sealing.get(), &send_salt}, {opening.get(), &receive_salt}}) {
    const Nonce any = nonce(*salt, kNever);
    (void)EVP_CipherInit_ex2(context, nullptr, nullptr, any.data(), kAsItWas, nullptr);
    (void)EVP_CipherUpdate(context, nullptr, &done, kNothing.data(), kHeaderSize);
  }
  constexpr std::array<std::byte, kTagSize> kNoTag{};
  std::array<std::byte, kHeaderSize - kClearSize> any{};
  (void)mask(hiding, kNoTag, any);
  (void)mask(showing, kNoTag, any);
}

AeadProtection::AeadProtection(const TrafficKeys& keys)
    : present_{std::make_unique<Generation>(keys)},
      warm_up_{std::make_unique<Generation>(TrafficKeys{})} {}

AeadProtection::AeadProtection(const TrafficKeys& present, const TrafficKeys& next, Lead lead)
    : present_{std::make_unique<Generation>(present)},
      next_{std::make_unique<Generation>(next)},
      warm_up_{std::make_unique<Generation>(TrafficKeys{})},
      seals_with_next_{lead == Lead::Own} {
  PALP_CHECK(present.id != next.id, "two generations have two ids");
}

AeadProtection::~AeadProtection() = default;

std::size_t AeadProtection::seal(const Header& header,
                                 std::span<const std::byte> plain,
                                 std::span<std::byte> out) noexcept {
  PALP_CHECK(header.number >= number_least_, "a packet number is sealed once");
  const std::size_t size = plain.size() + kTagSize;
  if (size > std::numeric_limits<std::uint16_t>::max()) return 0;
  if (out.size() < kHeaderSize + size) return 0;
  Generation& keys = seals_with_next_ ? *next_ : *present_;
  if (keys.sealed >= kPacketsMax) return 0;
  Header complete = header;
  complete.key = keys.id;
  complete.length = static_cast<std::uint16_t>(size);
  pack_header(complete, out.first<kHeaderSize>());
  number_least_ = header.number + 1;
  ++keys.sealed;
  const bool done =
      keys.seal(header.number, out.first(kHeaderSize), plain, out.subspan(kHeaderSize)) &&
      mask(keys.hiding,
           out.first(kHeaderSize + size).last<kTagSize>(),
           out.first<kHeaderSize>().subspan<kClearSize>());
  return done ? kHeaderSize + size : 0;
}

AeadProtection::Generation* AeadProtection::keys_of(const Header& header) noexcept {
  if (header.key == present_->id) return present_.get();
  if (next_ != nullptr && header.key == next_->id) return next_.get();
  return nullptr;
}

tl::expected<Header, Rejection> AeadProtection::read_header(
    std::span<const std::byte> datagram) noexcept {
  const std::optional<Header> clear = parse_clear_part(datagram);
  if (!clear || clear->length < kTagSize) return tl::unexpected(Rejection::Malformed);
  const Generation* keys = keys_of(*clear);
  if (keys == nullptr) return tl::unexpected(Rejection::Foreign);
  std::array<std::byte, kHeaderSize - kClearSize> part{};
  std::ranges::copy(datagram.subspan(kClearSize, part.size()), part.begin());
  if (!mask(keys->showing, datagram.last<kTagSize>(), part)) {
    return tl::unexpected(Rejection::Foreign);
  }
  const std::optional<Header> header = parse_hidden_part(*clear, part);
  if (!header) return tl::unexpected(Rejection::Foreign);  // under another mask it is anything
  return *header;
}

tl::expected<std::size_t, Rejection> AeadProtection::open(const Header& header,
                                                          std::span<const std::byte> datagram,
                                                          std::span<std::byte> plain) noexcept {
  PALP_CHECK(header.length >= kTagSize && datagram.size() == kHeaderSize + header.length,
             "a header that was read");
  const std::size_t size = header.length - kTagSize;
  if (size > plain.size()) return tl::unexpected(Rejection::Malformed);
  Generation* keys = keys_of(header);
  PALP_CHECK(keys != nullptr, "a header that was read");
  std::array<std::byte, kHeaderSize> shown{};
  pack_header(header, shown);
  if (!keys->open(header.number, shown, datagram.subspan(kHeaderSize), plain.first(size))) {
    return tl::unexpected(Rejection::Forged);
  }
  seals_with_next_ = seals_with_next_ || keys == next_.get();
  return size;
}

void AeadProtection::warm_up(std::span<const std::byte> plain, std::span<std::byte> room) noexcept {
  present_->touch();
  if (next_ != nullptr) next_->touch();
  const std::size_t size = plain.size() + kTagSize;
  if (room.size() < kHeaderSize + size + plain.size()) return;
  const std::uint64_t number = warm_up_->sealed++;
  pack_header({.length = static_cast<std::uint16_t>(size), .number = number},
              room.first<kHeaderSize>());
  const auto header = room.first(kHeaderSize);
  const auto sealed = room.subspan(kHeaderSize, size);
  (void)warm_up_->seal(number, header, plain, sealed);
  (void)warm_up_->open(number, header, sealed, room.subspan(kHeaderSize + size, plain.size()));
}

}  // namespace palp::link
