#include "video/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palp::video {
namespace {

struct Colour {
  std::uint8_t y;
  std::uint8_t u;
  std::uint8_t v;
};
constexpr Colour kAir{200, 128, 128};
constexpr Colour kTissue{120, 112, 160};
constexpr Colour kRod{90, 128, 128};
constexpr Colour kBall{80, 190, 110};
constexpr int kGrain = 12;              // of brightness, static
constexpr double kDimpleWidth = 0.008;  // [m]

std::size_t at(const Picture& picture, int x, int y) noexcept {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
         static_cast<std::size_t>(x);
}

std::size_t colour_at(const Picture& picture, int x, int y) noexcept {
  return static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(picture.width / 2) +
         static_cast<std::size_t>(x / 2);
}

void set(Picture& picture, int x, int y, const Colour& colour) noexcept {
  picture.y[at(picture, x, y)] = colour.y;
  picture.u[colour_at(picture, x, y)] = colour.u;
  picture.v[colour_at(picture, x, y)] = colour.v;
}

/// Bits of a number, spread: grain that is the same in every run.
unsigned grain(unsigned x, unsigned y) noexcept {
  unsigned bits = x * 0x9E3779B1U ^ y * 0x85EBCA77U;
  bits ^= bits >> 15U;
  bits *= 0xC2B2AE3DU;
  return bits >> 24U;
}

}  // namespace

PhantomPicture::PhantomPicture() : background_{kWidth, kHeight}, picture_{kWidth, kHeight} {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      Colour colour = kTissue;
      const auto spread =
          static_cast<int>(grain(static_cast<unsigned>(x / 2), static_cast<unsigned>(y / 2)));
      colour.y = static_cast<std::uint8_t>(colour.y + spread * 2 * kGrain / 255 - kGrain);
      set(background_, x, y, colour);
    }
  }
}

const Picture& PhantomPicture::draw(const Scene& scene) {
  picture_ = background_;
  draw_tissue(scene);
  draw_tip(scene);
  return picture_;
}

void PhantomPicture::draw_tissue(const Scene& scene) {
  const double pressed = std::max(0.0, scene.depth - scene.surface);
  for (int x = 0; x < kWidth; ++x) {
    const double away =
        (scale_.left_edge + (x + 0.5) / scale_.pixels_per_m - scene.x) / kDimpleWidth;
    const double surface = scene.surface + pressed / (1 + away * away);
    const double row = (surface - scale_.top_edge) * scale_.pixels_per_m;
    const int top = static_cast<int>(std::clamp(row, 0.0, static_cast<double>(kHeight)));
    for (int y = 0; y < top; ++y) set(picture_, x, y, kAir);
  }
}

void PhantomPicture::draw_tip(const Scene& scene) {
  const double radius = kBallRadius * scale_.pixels_per_m;  // [pixels]
  const double middle = (scene.x - scale_.left_edge) * scale_.pixels_per_m;
  const double centre = (scene.depth - kBallRadius - scale_.top_edge) * scale_.pixels_per_m;
  const int left = std::max(0, static_cast<int>(middle - radius));
  const int right = std::min(kWidth - 1, static_cast<int>(middle + radius) + 1);
  const int bottom = std::min(kHeight - 1, static_cast<int>(centre + radius) + 1);
  for (int y = 0; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double across = x + 0.5 - middle;
      const double down = y + 0.5 - centre;
      if (across * across + down * down <= radius * radius) {
        set(picture_, x, y, kBall);
      } else if (down < 0 && std::abs(across) < radius / 3) {
        set(picture_, x, y, kRod);
      }
    }
  }
}

Picture test_picture(int width, int height, Duration at) {
  constexpr std::array<Colour, 8> kBars{{{235, 128, 128},
                                         {210, 16, 146},
                                         {170, 166, 16},
                                         {145, 54, 34},
                                         {106, 202, 222},
                                         {81, 90, 240},
                                         {41, 240, 110},
                                         {16, 128, 128}}};
  Picture picture{width, height};
  const auto place = static_cast<int>(at / std::chrono::milliseconds{10} % width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool block = y > height * 3 / 4 && std::abs(x - place) < 20;
      const auto bar = static_cast<std::size_t>(x * 8 / width);
      set(picture, x, y, block ? kBars[0] : y > height * 3 / 4 ? kBars[7] : kBars[bar]);
    }
  }
  return picture;
}

}  // namespace palp::video
