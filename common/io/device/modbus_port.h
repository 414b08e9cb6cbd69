#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/device/register_port.h"

namespace palp::io {

/// Where a device is and how its line is set.
struct ModbusAddress {
  std::string host;      ///< numeric address of a server or gateway; empty: a serial line
  std::uint16_t port{};  ///< of TCP
  std::string line;      ///< path of a serial line, /dev/ttyUSB0
  std::uint32_t baud{115'200};
  char parity{'N'};         ///< N, E or O
  std::uint8_t station{1};  ///< 1 to 247
  Duration reply_delay{};   ///< the device's own, longest
};

/// "tcp:ADDRESS:PORT" or "serial:PATH" into host, port and line; the rest keeps its defaults.
[[nodiscard]] Result<ModbusAddress> parse_modbus_address(const std::string& text);

/// The longest that a transaction of `bytes` on the line, both ways, can take on a sound one.
/// Over TCP: with what a gateway and a network add.
[[nodiscard]] Duration reply_time_max(const ModbusAddress& address, std::uint32_t bytes) noexcept;

/// Modbus through libmodbus, RTU on a serial line or TCP. Each transaction has its own time-out.
/// A broken or late answer empties the line, so that no later request takes it for its own.
/// Thread: its device's; moves to none other once open() was called.
class ModbusPort final : public RegisterPort {
 public:
  explicit ModbusPort(ModbusAddress address);
  ~ModbusPort() override;
  ModbusPort(const ModbusPort&) = delete;
  ModbusPort& operator=(const ModbusPort&) = delete;

  PortFault open() override;
  void close() override;
  PortFault read(std::uint16_t address, std::span<std::uint16_t> words, bool input) override;
  PortFault write(std::uint16_t address, std::span<const std::uint16_t> words) override;
  PortFault write_one(std::uint16_t address, std::uint16_t word) override;
  PortFault write_coil(std::uint16_t address, bool on) override;
  PortFault exchange(std::uint16_t write_address,
                     std::span<const std::uint16_t> written,
                     std::uint16_t read_address,
                     std::span<std::uint16_t> words) override;

 private:
  struct Context;
  [[nodiscard]] bool prepare(std::size_t words);
  [[nodiscard]] PortFault outcome(int count, std::size_t expected);

  ModbusAddress address_;
  std::unique_ptr<Context> context_;
  bool answer_due_{};  ///< on a connection: the next request needs a new one
};

}  // namespace palp::io
