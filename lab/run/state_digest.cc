#include "lab/run/state_digest.h"

#include <string_view>

#include "common/message/each_value.h"

namespace palp::lab {

bool DigestRecorder::record(const Record& record) noexcept {
  digest_.add(record.index());
  const auto fold = [this](std::string_view /*prefix*/, const auto& /*field*/, auto number) {
    digest_.add(number);
  };
  std::visit([&](const auto& one) { message::each_value(one, fold); }, record);
  return next_ == nullptr || next_->record(record);
}

}  // namespace palp::lab
