#include "common/link/codec_wire.h"

#include <algorithm>
#include <bit>
#include <tuple>
#include <type_traits>
#include <variant>

#include "common/link/wire_format.h"

namespace palp::link {
namespace {

// Each message is a list of its fields, from which it is both written and read.

/// What a kind of field has: its tag; which fields before it make it one too many (bit n: field n);
/// the most bytes it takes; how it is written, left out where proto3 leaves it out; and how what
/// follows its tag is read.
template <unsigned kNumber, WireType kType>
struct Field {
  static constexpr unsigned kBit = 1U << kNumber;
  static constexpr unsigned kExcludedBy = kBit;
  static constexpr std::uint8_t kTag = wire_tag(kNumber, kType);
};

/// All fields of a message, in the order of their numbers: as protobuf writes them.
template <class Fields>
inline constexpr std::size_t kSizeMaxOf = 0;
template <class... Fields>
inline constexpr std::size_t kSizeMaxOf<std::tuple<Fields...>> = (Fields::kSizeMax + ...);

template <class... Fields, class From>
void write(const std::tuple<Fields...>& fields, const From& from, WireWriter& out) noexcept {
  std::apply([&](const auto&... field) { (field.write(from, out), ...); }, fields);
}

template <class OneField, class To>
bool read_if_next(
    const OneField& field, WireReader& in, To& to, unsigned& seen, bool& any) noexcept {
  if (!in.skip(OneField::kTag)) return true;
  if ((seen & OneField::kExcludedBy) != 0) return false;
  seen |= OneField::kBit;
  any = true;
  return field.read(in, to);
}

/// In the order of the numbers all is read at one go; each field out of it costs another.
template <class... Fields, class To>
bool read(const std::tuple<Fields...>& fields, WireReader in, To& to, unsigned& seen) noexcept {
  while (!in.empty()) {
    bool any = false;
    const bool good = std::apply(
        [&](const auto&... field) { return (read_if_next(field, in, to, seen, any) && ...); },
        fields);
    if (!good || !any) return false;
  }
  return true;
}

template <unsigned kNumber, class Of>
struct Whole : Field<kNumber, WireType::Varint> {
  static constexpr std::size_t kSizeMax = 1 + kVarintSizeMax;
  explicit constexpr Whole(Of where) noexcept : of{where} {}
  void write(const auto& from, WireWriter& out) const noexcept {
    if (of(from) == 0) return;
    out.put_byte(this->kTag);
    out.put_varint(of(from));
  }
  bool read(WireReader& in, auto& to) const noexcept {
    std::uint64_t value = 0;
    if (!in.take_varint(value)) return false;
    of(to) = static_cast<std::remove_reference_t<decltype(of(to))>>(value);
    return true;
  }
  Of of;
};

/// Of ours all fit into one byte. What an enum cannot hold becomes one that is out of range.
template <unsigned kNumber, class Of>
struct Enumerator : Field<kNumber, WireType::Varint> {
  static constexpr std::size_t kSizeMax = 2;
  explicit constexpr Enumerator(Of where) noexcept : of{where} {}
  void write(const auto& from, WireWriter& out) const noexcept {
    const auto value = static_cast<std::uint8_t>(of(from));
    if (value == 0) return;
    out.put_byte(this->kTag);
    out.put_byte(value);
  }
  bool read(WireReader& in, auto& to) const noexcept {
    std::uint64_t value = 0;
    if (!in.take_varint(value)) return false;
    constexpr std::uint32_t kOutOfRange = 0xFF;
    const auto known = std::min(static_cast<std::uint32_t>(value), kOutOfRange);
    of(to) = static_cast<std::remove_reference_t<decltype(of(to))>>(known);
    return true;
  }
  Of of;
};

/// A number as it lies in memory: `OnWire` may be narrower than ours.
template <unsigned kNumber, class OnWire, class Of>
struct Fixed : Field<kNumber, fixed_type<OnWire>()> {
  static constexpr std::size_t kSizeMax = 1 + sizeof(OnWire);
  explicit constexpr Fixed(Of where) noexcept : of{where} {}
  void write(const auto& from, WireWriter& out) const noexcept {
    using Bits = std::conditional_t<sizeof(OnWire) == 4, std::uint32_t, std::uint64_t>;
    const auto bits = std::bit_cast<Bits>(static_cast<OnWire>(of(from)));
    if (bits == 0) return;  // -0.0 is written
    out.put_byte(this->kTag);
    out.put_fixed(bits);
  }
  bool read(WireReader& in, auto& to) const noexcept {
    OnWire value{};
    if (!in.take_fixed(value)) return false;
    of(to) = value;
    return true;
  }
  Of of;
};

/// The only number whose 0 is told from none.
template <unsigned kNumber>
struct Echo : Field<kNumber, WireType::Varint> {
  static constexpr std::size_t kSizeMax = 1 + kVarintSizeMax;
  void write(const WireTelegram& from, WireWriter& out) const noexcept {
    if (from.echo_ns == kNothingHeard) return;
    out.put_byte(this->kTag);
    out.put_varint(from.echo_ns);
  }
  bool read(WireReader& in, WireTelegram& to) const noexcept {
    return in.take_varint(to.echo_ns) && to.echo_ns != kNothingHeard;
  }
};

/// A message within a message.
template <class Fields>
void write_part(const Fields& fields,
                std::uint8_t tag,
                const auto& from,
                WireWriter& out) noexcept {
  static_assert(kSizeMaxOf<Fields> <= kPartSizeMax);
  out.put_byte(tag);
  std::byte* size = out.begin_part();
  write(fields, from, out);
  out.end_part(size);
}

bool read_part(const auto& fields, WireReader& in, auto& to) noexcept {
  WireReader part{{}};
  unsigned seen = 0;
  return in.take_part(part) && read(fields, part, to, seen);
}

/// One that is there where `Present` says so of the message around it.
template <unsigned kNumber, class Fields, class Of, class Present>
struct Part : Field<kNumber, WireType::Part> {
  static constexpr std::size_t kSizeMax = 2 + kSizeMaxOf<Fields>;
  constexpr Part(const Fields& all, Of where, Present when) noexcept
      : fields{all}, of{where}, present{when} {}
  void write(const auto& from, WireWriter& out) const noexcept {
    if (present(from)) write_part(fields, this->kTag, of(from), out);
  }
  bool read(WireReader& in, auto& to) const noexcept { return read_part(fields, in, of(to)); }
  Fields fields;
  Of of;
  Present present;
};

/// One member of a sample's payload, of which there is one at most.
template <unsigned kNumber, class Chosen, class Fields>
struct Choice : Field<kNumber, WireType::Part> {
  static constexpr unsigned kExcludedBy = 1U << 4U | 1U << 5U | 1U << 6U;
  static constexpr std::size_t kSizeMax = 2 + kSizeMaxOf<Fields>;
  explicit constexpr Choice(const Fields& all) noexcept : fields{all} {}
  void write(const PortSample& from, WireWriter& out) const noexcept {
    const auto* chosen = std::get_if<Chosen>(&from.payload);
    if (chosen != nullptr) write_part(fields, this->kTag, *chosen, out);
  }
  bool read(WireReader& in, PortSample& to) const noexcept {
    return read_part(fields, in, to.payload.emplace<Chosen>());
  }
  Fields fields;
};

template <unsigned kNumber>
constexpr auto whole(auto of) noexcept {
  return Whole<kNumber, decltype(of)>{of};
}
template <unsigned kNumber>
constexpr auto enumerator(auto of) noexcept {
  return Enumerator<kNumber, decltype(of)>{of};
}
template <unsigned kNumber, class OnWire>
constexpr auto fixed(auto of) noexcept {
  return Fixed<kNumber, OnWire, decltype(of)>{of};
}
template <unsigned kNumber, class Fields>
constexpr auto part(const Fields& fields, auto of, auto present) noexcept {
  return Part<kNumber, Fields, decltype(of), decltype(present)>{fields, of, present};
}
template <unsigned kNumber, class Chosen, class Fields>
constexpr auto choice(const Fields& fields) noexcept {
  return Choice<kNumber, Chosen, Fields>{fields};
}

constexpr std::tuple kWave{fixed<1, double>([](auto& w) -> auto& { return w.wave_integral; }),
                           fixed<2, double>([](auto& w) -> auto& { return w.wave_energy; })};

constexpr std::tuple kTdpa{fixed<1, double>([](auto& t) -> auto& { return t.energy_in; })};

constexpr std::tuple kModel{whole<1>([](auto& m) -> auto& { return m.version; }),
                            fixed<2, float>([](auto& m) -> auto& { return m.c[0]; }),
                            fixed<3, float>([](auto& m) -> auto& { return m.c[1]; }),
                            fixed<4, float>([](auto& m) -> auto& { return m.c[2]; }),
                            fixed<5, float>([](auto& m) -> auto& { return m.c[3]; }),
                            fixed<6, float>([](auto& m) -> auto& { return m.c[4]; }),
                            fixed<7, float>([](auto& m) -> auto& { return m.surface; }),
                            fixed<8, float>([](auto& m) -> auto& { return m.depth_max; }),
                            fixed<9, float>([](auto& m) -> auto& { return m.residual; }),
                            fixed<10, float>([](auto& m) -> auto& { return m.swing; }),
                            fixed<11, float>([](auto& m) -> auto& { return m.swing_quadrature; }),
                            fixed<12, float>([](auto& m) -> auto& { return m.swing_rate; }),
                            fixed<13, float>([](auto& m) -> auto& { return m.relaxing[0]; }),
                            fixed<14, float>([](auto& m) -> auto& { return m.relaxing[1]; })};

constexpr std::tuple kSample{fixed<1, float>([](auto& s) -> auto& { return s.position; }),
                             fixed<2, float>([](auto& s) -> auto& { return s.velocity; }),
                             fixed<3, float>([](auto& s) -> auto& { return s.force; }),
                             choice<4, WavePayload>(kWave),
                             choice<5, TdpaPayload>(kTdpa),
                             choice<6, ModelPayload>(kModel)};
static_assert(std::variant_size_v<CouplingPayload> == 4, "a new payload needs its line here");

constexpr std::tuple kDepth{whole<1>([](auto& d) -> auto& { return d.number; }),
                            enumerator<2>([](auto& d) -> auto& { return d.verdict; }),
                            enumerator<3>([](auto& d) -> auto& { return d.reason; }),
                            fixed<4, float>([](auto& d) -> auto& { return d.depth; }),
                            fixed<5, float>([](auto& d) -> auto& { return d.depth_stddev; }),
                            fixed<6, float>([](auto& d) -> auto& { return d.depth_low; }),
                            fixed<7, float>([](auto& d) -> auto& { return d.depth_high; }),
                            fixed<8, float>([](auto& d) -> auto& { return d.hash; })};

constexpr std::tuple kSite{enumerator<1>([](auto& s) -> auto& { return s.state; }),
                           whole<2>([](auto& s) -> auto& { return s.epoch; }),
                           fixed<3, float>([](auto& s) -> auto& { return s.place.x; }),
                           part<4>(
                               kDepth,
                               [](auto& s) -> auto& { return s.depth; },
                               [](auto& s) { return s.depth.number != 0; }),
                           fixed<5, float>([](auto& s) -> auto& { return s.place.y; })};

constexpr auto kAlways = [](auto&) { return true; };

constexpr std::tuple kTelegram{
    whole<1>([](auto& t) -> auto& { return t.sent_at_ns; }),
    Echo<2>{},
    whole<3>([](auto& t) -> auto& { return t.hold_us; }),
    whole<4>([](auto& t) -> auto& { return t.newest_number; }),
    fixed<5, std::uint32_t>([](auto& t) -> auto& { return t.before_newest; }),
    part<6>(
        kSite, [](auto& t) -> auto& { return t.telegram.site; }, kAlways),
    part<7>(
        kSample, [](auto& t) -> auto& { return t.telegram.port; }, kAlways),
    part<8>(
        kSample,
        [](auto& t) -> auto& { return t.older[0]; },
        [](auto& t) { return t.older_count > 0; }),
    part<9>(
        kSample,
        [](auto& t) -> auto& { return t.older[1]; },
        [](auto& t) { return t.older_count > 1; })};
static_assert(kSizeMaxOf<std::remove_const_t<decltype(kTelegram)>> <= kTelegramSizeMax);

bool read_telegram(std::span<const std::byte> bytes, WireTelegram& telegram) noexcept {
  constexpr unsigned kNeeded = 1U << 6U | 1U << 7U;
  constexpr unsigned kFirstEarlier = 1U << 8U;
  constexpr unsigned kSecondEarlier = 1U << 9U;
  unsigned seen = 0;
  if (!read(kTelegram, WireReader{bytes}, telegram, seen)) return false;
  if ((seen & kNeeded) != kNeeded) return false;
  if ((seen & kFirstEarlier) != 0) telegram.older_count = 1;
  if ((seen & kSecondEarlier) != 0) {
    if (telegram.older_count == 0) return false;
    telegram.older_count = 2;
  }
  DepthReport& depth = telegram.telegram.site.depth;
  if (depth.number == 0) depth = {};  // none yet, whatever else it says
  return well_formed(telegram);
}

}  // namespace

std::size_t WireCodec::encode(const WireTelegram& telegram,
                              std::span<std::byte, kTelegramSizeMax> out) noexcept {
  if (!well_formed(telegram)) return 0;
  WireWriter writer{out};
  write(kTelegram, telegram, writer);
  return writer.size();
}

std::optional<WireTelegram> WireCodec::decode(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() > kTelegramSizeMax) return std::nullopt;
  std::optional<WireTelegram> telegram{std::in_place};
  if (!read_telegram(bytes, *telegram)) telegram.reset();
  return telegram;
}

}  // namespace palp::link
