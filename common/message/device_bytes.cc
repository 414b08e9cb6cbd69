#include "common/message/device_bytes.h"

#include "common/message/read_fields.h"
#include "common/message/readings.h"
#include "common/message/write_fields.h"

namespace palp::message {

std::size_t write_devices(const DeviceFacts& from,
                          std::span<std::byte, kDevicesSizeMax> out) noexcept {
  static_assert(size_max<Form::Log, DeviceFacts>() <= kDevicesSizeMax);
  DeviceFacts all_there = from;
  each(fields<DeviceFacts>.items, [&]<class Item>(const Item& /*device*/) {
    auto& device = Item::of(all_there);
    if (!device) clear(device.emplace());
  });
  WireWriter writer{out};
  write<Form::Log>(all_there, writer);
  return writer.size();
}

bool read_devices(std::span<const std::byte> bytes, DeviceFacts& to) noexcept {
  clear(to);
  Seen seen = 0;
  if (!read<Form::Log>(WireReader{bytes}, to, seen)) return false;
  each(fields<DeviceFacts>.items, [&]<class Item>(const Item& /*device*/) {
    auto& device = Item::of(to);
    using Facts = typename std::remove_cvref_t<decltype(device)>::value_type;
    using First = std::tuple_element_t<0, std::remove_cvref_t<decltype(fields<Facts>.items)>>;
    if (device && First::of(*device) == 0) device.reset();
  });
  return true;
}

}  // namespace palp::message
