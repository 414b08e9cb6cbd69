#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace palp::netem {

/// First in, first out, in a block of fixed size that is not touched before it is used.
/// Thread: its owner's, fit for rt.
template <class T>
class Ring {
  static_assert(std::is_trivially_default_constructible_v<T>, "its memory is left as it is");

 public:
  explicit Ring(std::size_t capacity)
      : items_{std::make_unique_for_overwrite<T[]>(capacity)}, capacity_{capacity} {}
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] const T& front() const noexcept { return items_[first_]; }
  [[nodiscard]] const T& back() const noexcept { return items_[wrap(first_ + count_ - 1)]; }
  /// `at` < size(), from the front.
  [[nodiscard]] const T& operator[](std::size_t at) const noexcept {
    return items_[wrap(first_ + at)];
  }
  void push(const T& item) noexcept { items_[wrap(first_ + count_++)] = item; }
  void pop() noexcept {
    first_ = wrap(first_ + 1);
    --count_;
  }

 private:
  [[nodiscard]] std::size_t wrap(std::size_t at) const noexcept {
    return at < capacity_ ? at : at - capacity_;
  }
  std::unique_ptr<T[]> items_;
  std::size_t capacity_;
  std::size_t first_{};
  std::size_t count_{};
};

}  // namespace palp::netem
