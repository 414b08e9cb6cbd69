#include "common/io/device/capture_port.h"

#include <cerrno>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace palp::io {
namespace {

class KernelCapturePort final : public CapturePort {
 public:
  explicit KernelCapturePort(std::string path) : path_{std::move(path)} {}
  ~KernelCapturePort() override { KernelCapturePort::close(); }
  KernelCapturePort(const KernelCapturePort&) = delete;
  KernelCapturePort& operator=(const KernelCapturePort&) = delete;

  int open() override {
    close();
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return descriptor_ < 0 ? errno : 0;
  }
  void close() override {
    for (const auto& [at, length] : mapped_) ::munmap(at, length);
    mapped_.clear();
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }
  int control(std::uint64_t request, void* argument) override {
    int code = 0;
    do {
      code = ::ioctl(descriptor_, request, argument);
    } while (code < 0 && errno == EINTR);
    return code < 0 ? errno : 0;
  }
  std::span<const std::uint8_t> map(std::size_t length, std::uint32_t offset) override {
    void* const at = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, descriptor_, offset);
    if (at == MAP_FAILED) return {};
    mapped_.emplace_back(at, length);
    return {static_cast<const std::uint8_t*>(at), length};
  }

 private:
  std::string path_;
  int descriptor_{-1};
  std::vector<std::pair<void*, std::size_t>> mapped_;
};

}  // namespace

std::unique_ptr<CapturePort> make_capture_port(std::string path) {
  return std::make_unique<KernelCapturePort>(std::move(path));
}

}  // namespace palp::io
