#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace palp::review {

/// A list that stays short however long it grows: all of it up to `most`, then each second of it,
/// each fourth, ...
template <class T>
class Thinned {
 public:
  explicit Thinned(std::size_t most) : most_{most} {}

  void add(const T& one) {
    if (seen_++ % stride_ != 0) return;
    if (kept_.size() == most_) {
      std::size_t size = 0;
      for (std::size_t i = 0; i < kept_.size(); i += 2) kept_[size++] = kept_[i];
      kept_.resize(size);
      stride_ *= 2;
      if ((seen_ - 1) % stride_ != 0) return;
    }
    kept_.push_back(one);
  }
  [[nodiscard]] const std::vector<T>& kept() const noexcept { return kept_; }
  [[nodiscard]] std::vector<T> take() noexcept { return std::move(kept_); }

 private:
  std::size_t most_;
  std::size_t stride_{1};
  std::size_t seen_{};
  std::vector<T> kept_;
};

}  // namespace palp::review
