#include "common/record/index_store.h"

namespace palp::record {

void IndexStore::settle() noexcept {
  if (newest_.size() < kKept || !file_ || refused_) return;
  // A piece that did not go out whole stays here, with all that follow.
  refused_ = std::fwrite(newest_.data(), 1, newest_.size(), file_.get()) != newest_.size() ||
             std::fflush(file_.get()) != 0;
  if (refused_) return;
  laid_down_ += newest_.size();
  newest_.clear();
}

Bytes IndexStore::all() {
  Bytes bytes(laid_down_);
  if (laid_down_ > 0) {
    std::rewind(file_.get());
    if (std::fread(bytes.data(), 1, laid_down_, file_.get()) != laid_down_) return {};
  }
  append(bytes, std::span<const std::byte>{newest_});
  return bytes;
}

}  // namespace palp::record
