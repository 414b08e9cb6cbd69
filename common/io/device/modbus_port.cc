#include "common/io/device/modbus_port.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <limits>
#include <utility>

#include <modbus/modbus.h>

namespace palp::io {
namespace {

constexpr std::uint32_t kFrameBytes = 24;  // of request and reply together, beside the words
constexpr Duration kGatewayTime = std::chrono::milliseconds{40};  // and a network's
constexpr Duration kLineTime = std::chrono::milliseconds{30};     // an adapter's timer, a busy host

timeval to_timeval(Duration span) noexcept {
  const auto micro = std::chrono::duration_cast<std::chrono::microseconds>(span).count();
  timeval time{};
  time.tv_sec = static_cast<time_t>(micro / 1'000'000);
  time.tv_usec = static_cast<suseconds_t>(micro % 1'000'000);
  return time;
}

}  // namespace

Result<ModbusAddress> parse_modbus_address(const std::string& text) {
  constexpr std::string_view kTcp = "tcp:";
  constexpr std::string_view kSerial = "serial:";
  const auto bad = [&] {
    return fail("'" + text + "' is no address of a device; it is tcp:ADDRESS:PORT or serial:PATH");
  };
  ModbusAddress address;
  if (text.starts_with(kSerial) && text.size() > kSerial.size()) {
    address.line = text.substr(kSerial.size());
    return address;
  }
  const auto colon = text.rfind(':');
  if (!text.starts_with(kTcp) || colon <= kTcp.size()) return bad();
  address.host = text.substr(kTcp.size(), colon - kTcp.size());
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, address.port);
  if (error != std::errc{} || stop != end || address.port == 0) return bad();
  return address;
}

Duration reply_time_max(const ModbusAddress& address, std::uint32_t bytes) noexcept {
  if (address.line.empty()) return address.reply_delay + kGatewayTime;
  const double bits = address.parity == 'N' ? 10 : 11;
  return address.reply_delay + kLineTime + from_seconds(bits * bytes / address.baud);
}

struct ModbusPort::Context {
  explicit Context(modbus_t* opened) : handle{opened} {}
  ~Context() {
    if (handle == nullptr) return;
    modbus_close(handle);
    modbus_free(handle);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  modbus_t* handle;
};

ModbusPort::ModbusPort(ModbusAddress address) : address_{std::move(address)} {}
ModbusPort::~ModbusPort() = default;

PortFault ModbusPort::open() {
  close();
  modbus_t* const handle =
      address_.line.empty()
          ? modbus_new_tcp(address_.host.c_str(), address_.port)
          : modbus_new_rtu(
                address_.line.c_str(), static_cast<int>(address_.baud), address_.parity, 8, 1);
  if (handle == nullptr) return PortFault::NotOpen;
  context_ = std::make_unique<Context>(handle);
  const timeval patience = to_timeval(reply_time_max(address_, kFrameBytes) * 4);
  modbus_set_response_timeout(handle,
                              static_cast<std::uint32_t>(patience.tv_sec),
                              static_cast<std::uint32_t>(patience.tv_usec));
  if (modbus_set_slave(handle, address_.station) != 0 || modbus_connect(handle) != 0) {
    context_.reset();
    return PortFault::NotOpen;
  }
  return PortFault::None;
}

void ModbusPort::close() { context_.reset(); }

bool ModbusPort::prepare(std::size_t words) {
  if (!context_) return false;
  if (std::exchange(answer_due_, false)) {
    modbus_close(context_->handle);
    if (modbus_connect(context_->handle) != 0) {
      context_.reset();
      return false;
    }
  }
  // Frames of a line have no number: what is there now answers an earlier request.
  if (!address_.line.empty()) modbus_flush(context_->handle);
  const auto bytes = static_cast<std::uint32_t>(kFrameBytes + 2 * words);
  const timeval patience = to_timeval(reply_time_max(address_, bytes));
  const auto whole = static_cast<std::uint32_t>(patience.tv_sec);
  const auto part = static_cast<std::uint32_t>(patience.tv_usec);
  modbus_set_response_timeout(context_->handle, whole, part);
  modbus_set_byte_timeout(context_->handle, whole, part);
  return true;
}

PortFault ModbusPort::outcome(int count, std::size_t expected) {
  if (std::cmp_equal(count, expected)) return PortFault::None;
  const int error = errno;
  switch (error) {
    case EMBXILFUN:
    case EMBXILADD:
    case EMBXILVAL:
    case EMBXSFAIL:
    case EMBXACK:
    case EMBXSBUSY:
    case EMBXNACK:
    case EMBXMEMPAR:
    case EMBXGPATH:
    case EMBXGTAR:
      return PortFault::Refused;
    default:
      break;
  }
  if (error == ECONNRESET || error == EPIPE || error == EBADF || error == EIO ||
      error == ECONNREFUSED || error == ENXIO || error == ENODEV || error == ENOTCONN) {
    close();
    return PortFault::Lost;
  }
  // What comes late would be taken for the answer to the next request. A line is emptied; on a
  // connection it may come later still, so that one is given up.
  modbus_flush(context_->handle);
  answer_due_ = address_.line.empty();
  if (error == ETIMEDOUT) return PortFault::NoReply;
  return error == EMBBADSLAVE ? PortFault::WrongStation : PortFault::BrokenFrame;
}

PortFault ModbusPort::read(std::uint16_t address, std::span<std::uint16_t> words, bool input) {
  if (!prepare(words.size())) return PortFault::Lost;
  const auto count = static_cast<int>(words.size());
  return outcome(input ? modbus_read_input_registers(context_->handle, address, count, words.data())
                       : modbus_read_registers(context_->handle, address, count, words.data()),
                 words.size());
}

PortFault ModbusPort::write(std::uint16_t address, std::span<const std::uint16_t> words) {
  if (!prepare(words.size())) return PortFault::Lost;
  return outcome(modbus_write_registers(
                     context_->handle, address, static_cast<int>(words.size()), words.data()),
                 words.size());
}

PortFault ModbusPort::write_one(std::uint16_t address, std::uint16_t word) {
  if (!prepare(1)) return PortFault::Lost;
  return outcome(modbus_write_register(context_->handle, address, word), 1);
}

PortFault ModbusPort::write_coil(std::uint16_t address, bool on) {
  if (!prepare(1)) return PortFault::Lost;
  return outcome(modbus_write_bit(context_->handle, address, on ? 1 : 0), 1);
}

PortFault ModbusPort::exchange(std::uint16_t write_address,
                               std::span<const std::uint16_t> written,
                               std::uint16_t read_address,
                               std::span<std::uint16_t> words) {
  if (!prepare(words.size() + written.size())) return PortFault::Lost;
  return outcome(modbus_write_and_read_registers(context_->handle,
                                                 write_address,
                                                 static_cast<int>(written.size()),
                                                 written.data(),
                                                 read_address,
                                                 static_cast<int>(words.size()),
                                                 words.data()),
                 words.size());
}

}  // namespace palp::io
