#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/core/check.h"
#include "fem/grading.h"
#include "fem/mesh.h"
#include "fem/mesh_sizes.h"

namespace palp::fem {
namespace {

/// One column of the fan: where it leaves the inclusion and where it ends on the box.
struct Station {
  Node inner;
  Node outer;
  double side{};  ///< [-], 0: rows graded for the surface, 1: for the sides
};

class Builder {
 public:
  Builder(const Specimen& specimen, Accuracy accuracy, const SurfaceNodes& surface)
      : block_{specimen.block},
        inclusion_{specimen.inclusion},
        indenter_{specimen.indenter},
        sizes_{accuracy},
        wanted_{surface},
        angular_{inclusion_.shape == InclusionShape::Cylinder ||
                 inclusion_.shape == InclusionShape::Column} {
    mesh_.half_width = block_.half_width;
    mesh_.height = block_.height;
    if (angular_) {  // a singular edge all round
      sizes_.rows += 4;
      sizes_.inner_rows += 1;
      sizes_.side += 4;
      sizes_.below += 3;
      sizes_.rim += 3;
    }
    if (wanted_.reach > 0) {
      sizes_.rows = std::max(sizes_.rows, int(std::ceil(elements_wanted(cover_rows()))));
    }
  }

  Mesh build() {
    if (inclusion_.shape == InclusionShape::None) {
      build_plain();
    } else {
      lay_box();
      lay_columns();
      lay_stations();
      build_fan();
      build_inside();
      build_outside();
    }
    mesh_.collect_surface();
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] int add(Node node) {
    mesh_.nodes.push_back(node);
    return static_cast<int>(mesh_.nodes.size()) - 1;
  }

  /// Radii of the columns under the indenter, and where they end.
  std::vector<double> contact_columns(double& reach) {
    const double radius = indenter_.radius;
    Grading grading{.length = 1.2 * radius,
                    .first = sizes_.contact * radius,
                    .last = kAnySize,
                    .growth = sizes_.contact_growth};
    if (indenter_.shape == IndenterShape::FlatPunch) {  // the pressure is singular at its edge
      grading = {.length = radius,
                 .first = 0.15 * sizes_.scale * radius,
                 .last = 1e-4 * radius,
                 .growth = 0.6 * sizes_.scale};
    }
    reach = grading.length;
    return distribute(grading,
                      std::max(4, static_cast<int>(std::lround(elements_wanted(grading)))));
  }

  /// Size of an element at the edge of the contact's columns.
  [[nodiscard]] double rim_size() const {
    if (indenter_.shape == IndenterShape::FlatPunch) return 1e-4 * indenter_.radius;
    return (sizes_.contact + 1.2 * sizes_.contact_growth) * indenter_.radius;
  }

  static void append(std::vector<double>& to, const std::vector<double>& more) {
    const double from = to.back();
    for (std::size_t i = 1; i < more.size(); ++i) to.push_back(from + more[i]);
  }

  void build_plain() {
    double reach = 0;
    std::vector<double> r = contact_columns(reach);
    const Grading outward{.length = block_.half_width - reach,
                          .first = rim_size(),
                          .last = kAnySize,
                          .growth = 0.4 * sizes_.scale};
    append(
        r,
        distribute(outward, std::max(3, static_cast<int>(std::lround(elements_wanted(outward))))));
    const Grading down{.length = block_.height,
                       .first = sizes_.surface_row * indenter_.radius *
                                (indenter_.shape == IndenterShape::FlatPunch ? 0.02 : 1),
                       .last = kAnySize,
                       .growth = 0.25 * sizes_.scale};
    const std::vector<double> z =
        distribute(down, std::max(5, static_cast<int>(std::lround(elements_wanted(down)))));
    for (const double depth : z) {
      for (const double radius : r) static_cast<void>(add({radius, -depth}));
    }
    const int width = static_cast<int>(r.size());
    mesh_.add_block((width - 1) / 2,
                    static_cast<int>(z.size() - 1) / 2,
                    [&](int column, int row) { return row * width + column; },
                    0);
  }

  void lay_box() {
    const double a = inclusion_.radius;
    const double reach =
        indenter_.shape == IndenterShape::FlatPunch ? indenter_.radius : 1.2 * indenter_.radius;
    const double least = smooth_max(1.03 * reach, 1.02 * a);
    const double wanted = smooth_max(smooth_max(1.3 * reach, 1.5 * a), 0.45 * inclusion_.depth);
    const double room = block_.half_width - least;
    PALP_CHECK(room > 0, "check() has seen to it that the inclusion and the contact fit");
    box_r_ = least + smooth_min(wanted - least, 0.5 * room);
    const double bottom = inclusion_.bottom(block_.height);
    box_z_ = block_.height;
    if (inclusion_.shape != InclusionShape::Column) {
      box_z_ = bottom + smooth_min(0.5 * a + 0.1 * bottom, 0.5 * (block_.height - bottom));
    }
  }

  /// Surface radii of the fan's upper part.
  void lay_columns() {
    top_ = contact_columns(contact_reach_);
    const double corner = angular_ ? inclusion_.radius * 0.04 * sizes_.scale : rim_size();
    const Grading rim{.length = box_r_ - contact_reach_,
                      .first = rim_size(),
                      .last = corner * box_r_ / inclusion_.radius,
                      .growth = 0.4,
                      .most = wanted_.reach > 0 ? 2 * wanted_.spacing : kAnySize};
    const double least = wanted_.reach > 0 ? std::ceil(elements_wanted(rim)) : 0;
    append(top_, distribute(rim, std::max(sizes_.rim, static_cast<int>(least))));
  }

  /// Radius on the inclusion below the surface radius `r`: slope 1 at the axis, `r_end` at the box.
  [[nodiscard]] double squeeze(double r, double r_end) const {
    const double bend = 1 / r_end - 1 / box_r_;
    return r / (1 + bend * r);
  }

  /// Depths on the box's side. The inclusion's middle looks at its own height there, or lines from
  /// its lower half would rise and fold.
  [[nodiscard]] std::vector<double> box_wall(double middle) const {
    const double first = 0.3 * indenter_.radius;
    if (inclusion_.shape == InclusionShape::Column) {
      return distribute({.length = box_z_, .first = first, .last = kAnySize, .growth = 0.35},
                        sizes_.side);
    }
    const double near = 0.3 * smooth_min(inclusion_.radius, box_z_ - middle);
    const int half = sizes_.side / 2;
    std::vector<double> wall =
        distribute({.length = middle, .first = first, .last = near, .growth = 0.35}, half);
    append(wall,
           distribute({.length = box_z_ - middle, .first = near, .last = kAnySize, .growth = 0.35},
                      sizes_.side - half));
    return wall;
  }

  void lay_stations() {
    const double a = inclusion_.radius;
    const bool ball = inclusion_.shape == InclusionShape::Ball;
    const double centre = -(inclusion_.depth + a);
    const double top_end = ball ? a * std::numbers::sqrt2 / 2 : a;
    const auto on_ball = [&](double angle) {
      return Node{a * std::sin(angle), centre + a * std::cos(angle)};
    };
    for (const double r : top_) {
      const double below = squeeze(r, top_end);
      const Node inner = ball ? on_ball(std::asin(below / a)) : Node{below, -inclusion_.depth};
      const double out = std::clamp((r - contact_reach_) / (box_r_ - contact_reach_), 0.0, 1.0);
      stations_.push_back({inner, {r, 0}, out * out * (3 - 2 * out)});
    }
    const double bottom = inclusion_.bottom(block_.height);
    const double edge = angular_ ? a * 0.03 * sizes_.scale : kAnySize;
    const bool column = inclusion_.shape == InclusionShape::Column;
    const double tall = bottom - inclusion_.depth;
    const std::vector<double> side = distribute({.length = tall,
                                                 .first = ball ? tall : edge,
                                                 .last = ball     ? tall
                                                         : column ? kAnySize
                                                                  : edge,
                                                 .growth = 0.5},
                                                sizes_.side);
    const std::vector<double> wall = box_wall(0.5 * (inclusion_.depth + bottom));
    for (std::size_t i = 1; i < side.size(); ++i) {
      const double share = side[i] / tall;
      const Node inner = ball ? on_ball(std::numbers::pi * (0.25 + 0.5 * share))
                              : Node{a, -inclusion_.depth - side[i]};
      stations_.push_back({inner, {box_r_, -wall[i]}, 1});
    }
    if (column) return;
    const std::vector<double> below = distribute(
        {.length = a, .first = ball ? a : edge, .last = ball ? a : kAnySize, .growth = 0.5},
        sizes_.below);
    for (std::size_t i = 1; i < below.size(); ++i) {
      const double share = below[i] / a;
      const Node inner =
          ball ? on_ball(std::numbers::pi * (0.75 + 0.25 * share)) : Node{a - below[i], -bottom};
      stations_.push_back({inner, {box_r_ * (1 - share), -box_z_}, 1});
    }
  }

  /// Of the fan between the inclusion's top and the surface.
  [[nodiscard]] Grading cover_rows() const {
    const double a = inclusion_.radius;
    double edge = angular_ ? a * 0.03 * sizes_.scale : kAnySize;
    if (wanted_.reach > 0) edge = 0.3 * a * sizes_.scale;  // or the far field of a ball is wrong
    return {.length = inclusion_.depth,
            .first = edge,
            .last = sizes_.surface_row * indenter_.radius,
            .growth = 0.3};
  }

  void build_fan() {
    const Grading cover = cover_rows();
    const std::vector<double> rows_top = distribute(cover, sizes_.rows);
    const double gap = box_r_ - 0.7 * inclusion_.radius;
    const std::vector<double> rows_side = distribute(
        {.length = gap, .first = angular_ ? cover.first : gap, .last = gap, .growth = 0.4},
        sizes_.rows);
    const int rows = 2 * sizes_.rows;
    for (const Station& station : stations_) {
      std::vector<int>& column = fan_.emplace_back();
      for (int j = 0; j <= rows; ++j) {
        const auto k = static_cast<std::size_t>(j);
        if (j == rows) {  // exactly, or rounding takes the node off the surface
          column.push_back(add(station.outer));
          break;
        }
        const double t =
            (1 - station.side) * rows_top[k] / cover.length + station.side * rows_side[k] / gap;
        column.push_back(add({station.inner.r + t * (station.outer.r - station.inner.r),
                              station.inner.z + t * (station.outer.z - station.inner.z)}));
      }
    }
    mesh_.add_block(
        static_cast<int>(stations_.size() - 1) / 2,
        sizes_.rows,
        [&](int column, int row) { return fan_at(column, row); },
        0);
  }

  [[nodiscard]] int fan_at(int column, int row) const {
    return fan_[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
  }
  [[nodiscard]] int top_end() const { return static_cast<int>(top_.size()) - 1; }
  [[nodiscard]] int side_end() const { return top_end() + 2 * sizes_.side; }

  /// Ball and cylinder: rows round the centre, the innermost ones collapsed. Column: a rectangle
  /// spanned by its top and its side.
  void build_inside() {
    if (inclusion_.shape == InclusionShape::Column) return build_inside_column();
    const double a = inclusion_.radius;
    const double tall = 0.5 * (inclusion_.bottom(block_.height) - inclusion_.depth);
    const Node centre{0, -inclusion_.depth - tall};
    const double edge = angular_ ? a * 0.03 * sizes_.scale : kAnySize;
    const std::vector<double> rows = distribute(
        {.length = a, .first = a, .last = std::min(edge, a), .growth = 0.5}, sizes_.inner_rows);
    const int middle = add(centre);
    std::vector<std::vector<int>> inside;
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      std::vector<int>& column = inside.emplace_back(1, middle);
      for (std::size_t j = 1; j + 1 < rows.size(); ++j) {
        const double t = rows[j] / a;
        const Node& rim = stations_[i].inner;
        column.push_back(add({t * rim.r, centre.z + t * (rim.z - centre.z)}));
      }
      column.push_back(fan_[i][0]);
    }
    mesh_.add_block(
        static_cast<int>(stations_.size() - 1) / 2,
        sizes_.inner_rows,
        [&](int column, int row) {
          return inside[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
        },
        1);
  }

  void build_inside_column() {
    std::vector<std::vector<int>> inside;  // by row from the top, then by column
    const int width = top_end();
    for (int row = 1; row <= 2 * sizes_.side; ++row) {
      std::vector<int>& line = inside.emplace_back();
      const double z = stations_[static_cast<std::size_t>(width + row)].inner.z;
      for (int column = 0; column < width; ++column) {
        line.push_back(add({stations_[static_cast<std::size_t>(column)].inner.r, z}));
      }
    }
    mesh_.add_block(
        width / 2,
        sizes_.side,
        [&](int column, int row) {
          if (row == 0) return fan_at(column, 0);
          if (column == width) return fan_at(width + row, 0);
          return inside[static_cast<std::size_t>(row) - 1][static_cast<std::size_t>(column)];
        },
        1);
  }

  /// Rectangles beside and below the box.
  void build_outside() {
    const int rows = 2 * sizes_.rows;
    std::vector<double> r{0};
    double first = 0.3 * box_r_;
    if (wanted_.reach > box_r_) {
      first = std::min(first, 2 * wanted_.spacing);
      const double length = wanted_.reach - box_r_;
      r = distribute({.length = length, .first = kAnySize, .last = kAnySize, .growth = 0.1},
                     static_cast<int>(std::ceil(length / first)));
    }
    const Grading outward{.length = block_.half_width - box_r_ - r.back(),
                          .first = first,
                          .last = kAnySize,
                          .growth = 0.5};
    // The count must not jump with the inclusion's radius: it goes by the block alone.
    const int beyond = sizes_.count(
        std::max(3.0, std::round(1.5 * std::log(block_.half_width / indenter_.radius) + 1)));
    append(r, distribute(outward, beyond));
    const int columns = static_cast<int>(r.size() - 1) / 2;
    std::vector<std::vector<int>> beside;  // by row from the surface
    for (int i = top_end(); i <= side_end(); ++i) {
      std::vector<int>& line = beside.emplace_back(1, fan_at(i, rows));
      const double z = stations_[static_cast<std::size_t>(i)].outer.z;
      for (std::size_t k = 1; k < r.size(); ++k) line.push_back(add({box_r_ + r[k], z}));
    }
    mesh_.add_block(
        columns,
        sizes_.side,
        [&](int column, int row) {
          return beside[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
        },
        0);
    if (inclusion_.shape == InclusionShape::Column) return;
    const double left = block_.height - box_z_;
    const int deep = sizes_.count(
        std::max(3.0, std::round(1.5 * std::log(1 + block_.height / (2 * indenter_.radius)))));
    const std::vector<double> z =
        distribute({.length = left, .first = 0.15 * box_z_, .last = kAnySize, .growth = 0.5}, deep);
    std::vector<std::vector<int>> under;
    std::vector<int> line;  // the box's lower side and the last line beside it
    for (int i = static_cast<int>(stations_.size()) - 1; i >= side_end(); --i) {
      line.push_back(fan_at(i, rows));
    }
    line.insert(line.end(), beside.back().begin() + 1, beside.back().end());
    under.push_back(line);
    for (std::size_t k = 1; k < z.size(); ++k) {
      std::vector<int> next;
      for (const int above : line) {
        next.push_back(add({mesh_.nodes[static_cast<std::size_t>(above)].r, -box_z_ - z[k]}));
      }
      under.push_back(next);
    }
    mesh_.add_block(
        static_cast<int>(line.size() - 1) / 2,
        deep,
        [&](int column, int row) {
          return under[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
        },
        0);
  }

  const Block& block_;
  const Inclusion& inclusion_;
  const Indenter& indenter_;
  Sizes sizes_;
  SurfaceNodes wanted_;
  bool angular_;
  Mesh mesh_;
  double contact_reach_{};   ///< [m]
  double box_r_{};           ///< [m]
  double box_z_{};           ///< [m]
  std::vector<double> top_;  ///< [m]
  std::vector<Station> stations_;
  std::vector<std::vector<int>> fan_;  ///< nodes by column, then row from the inclusion outward
};

}  // namespace

Mesh make_mesh(const Specimen& specimen, Accuracy accuracy, const SurfaceNodes& surface) {
  return Builder{specimen, accuracy, surface}.build();
}

}  // namespace palp::fem
