#include "common/message/wire_bytes.h"

#include "common/message/range.h"
#include "common/message/read_fields.h"
#include "common/message/write_fields.h"

namespace palp::message {

std::size_t write_wire(const WireTelegram& telegram,
                       std::span<std::byte, kTelegramSizeMax> out) noexcept {
  static_assert(size_max<Form::Wire, WireTelegram>() <= kTelegramSizeMax);
  WireWriter writer{out};
  write<Form::Wire>(telegram, writer);
  return writer.size();
}

bool read_wire(std::span<const std::byte> bytes, WireTelegram& to, std::uint64_t& seen) noexcept {
  return read<Form::Wire>(WireReader{bytes}, to, seen);
}

bool in_wire_range(const WireTelegram& telegram) noexcept { return in_range<Form::Wire>(telegram); }

bool is_for_repetition(const PortSample& sample) noexcept {
  return all(fields<PortSample>.items, [&](const auto& item) {
    if constexpr (requires { item.choices; }) {
      return all(item.choices, [&]<class Item>(const Item& /*choice*/) {
        return std::is_base_of_v<RepeatedLater, Item> ||
               !std::holds_alternative<typename Item::Type>(sample.payload);
      });
    }
    return true;
  });
}

PortSample for_repetition(const PortSample& sample) noexcept {
  if (is_for_repetition(sample)) return sample;
  return {sample.position, sample.velocity, sample.force, std::monostate{}};
}

}  // namespace palp::message
