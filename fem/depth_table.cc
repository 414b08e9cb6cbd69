#include "fem/depth_table.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "common/core/conventions.h"
#include "proto/depth_database.pb.h"

namespace palp::fem {
namespace {

constexpr std::string_view kMagic{"PALPDDB1"};
constexpr std::size_t kHashBytes = 8;
constexpr std::uint32_t kFormatVersion = 1;
constexpr std::size_t kAxisMax = 200;  // values along one axis of a grid
constexpr double kShapeScale = 65535;  // [-], of a shape of 1 in 16 bits

std::uint64_t fnv(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  }
  return hash;
}

std::string hash_bytes(std::string_view bytes) {
  std::string out;
  const std::uint64_t hash = fnv(bytes);
  for (std::size_t i = 0; i < kHashBytes; ++i) out += static_cast<char>(hash >> (8 * i) & 0xff);
  return out;
}

auto key(const DepthMember& member) {
  return std::tuple{member.shape, member.depth, member.radius, member.ratio};
}

std::vector<double> scaled(const google::protobuf::RepeatedField<double>& from, double unit) {
  std::vector<double> out;
  for (const double value : from) out.push_back(value * unit);
  return out;
}

Result<void> check_axis(const char* name, const std::vector<double>& values, double above) {
  const bool rising = std::adjacent_find(values.begin(), values.end(), [](double a, double b) {
                        return !(a < b);
                      }) == values.end();
  const bool fits = values.size() >= 2 && values.size() <= kAxisMax;
  if (rising && fits && values.front() > above && std::isfinite(values.back())) return {};
  return fail(std::string{"the depth database's "} + name +
              " are not 2 to 200 rising positive numbers");
}

Result<void> check_table(const DepthTable& table) {
  const DepthGrid& grid = table.grid;
  for (const auto& ok : {check_axis("depths", grid.depths, 0),
                         check_axis("radii", grid.radii, 0),
                         check_axis("ratios", grid.ratios, 1),
                         check_axis("indentations", grid.indentations, 0),
                         check_axis("plain forces", table.plain, 0)}) {
    if (!ok) return ok;
  }
  if (table.plain.size() != grid.indentations.size()) {
    return fail("the depth database has another number of plain forces than of indentations");
  }
  if (auto ok = check(
          {.block = grid.block, .inclusion = {}, .indenter = {.radius = grid.indenter_radius}});
      !ok) {
    return fail("the depth database's block: " + ok.error().text);
  }
  std::set<decltype(key(DepthMember{}))> seen;
  for (const DepthMember& member : table.members) {
    const bool inside = member.depth < grid.depths.size() && member.radius < grid.radii.size() &&
                        member.ratio < grid.ratios.size() &&
                        member.excess.size() <= grid.indentations.size();
    const bool sound = std::all_of(member.excess.begin(), member.excess.end(), [](float value) {
      return std::isfinite(value) && value > 0 && value < 100;
    });
    if (!inside || !sound || !seen.insert(key(member)).second) {
      return fail("the depth database has a member outside its grid, twice, or without a force");
    }
  }
  if (!table.off_axis) return {};
  if (auto ok = check(*table.off_axis); !ok) return fail("the depth database", ok.error());
  return {};
}

void write_shape(const ShapeTable& table, wire::ShapeTable& out) {
  for (const double depth : table.depths) out.add_depth_mm(depth / kMillimetre);
  for (const double radius : table.radii) out.add_radius_mm(radius / kMillimetre);
  for (const double ratio : table.ratios) out.add_ratio(ratio);
  for (const double offset : table.offsets) out.add_offset_share(offset);
  for (const double d : table.indentations) out.add_indentation_mm(d / kMillimetre);
  std::string& bytes = *out.mutable_shape();
  for (const float value : table.shape) {
    const auto code = static_cast<unsigned>(std::lround(kShapeScale * static_cast<double>(value)));
    bytes += static_cast<char>(code & 0xff);
    bytes += static_cast<char>(code >> 8 & 0xff);
  }
}

ShapeTable read_shape(const wire::ShapeTable& in) {
  ShapeTable table{.depths = scaled(in.depth_mm(), kMillimetre),
                   .radii = scaled(in.radius_mm(), kMillimetre),
                   .ratios = scaled(in.ratio(), 1),
                   .offsets = scaled(in.offset_share(), 1),
                   .indentations = scaled(in.indentation_mm(), kMillimetre),
                   .shape = {}};
  const std::string& bytes = in.shape();
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const unsigned low = static_cast<unsigned char>(bytes[i]);
    const unsigned high = static_cast<unsigned char>(bytes[i + 1]);
    table.shape.push_back(static_cast<float>((low | high << 8) / kShapeScale));
  }
  return table;
}

}  // namespace

bool operator==(const DepthGrid& a, const DepthGrid& b) {
  const auto close = [](double x, double y) { return std::abs(x - y) <= 1e-9 * std::abs(x); };
  const auto same = [&](const std::vector<double>& x, const std::vector<double>& y) {
    return x.size() == y.size() && std::equal(x.begin(), x.end(), y.begin(), close);
  };
  return close(a.block.half_width, b.block.half_width) && close(a.block.height, b.block.height) &&
         close(a.block.youngs_modulus, b.block.youngs_modulus) &&
         close(a.block.poisson, b.block.poisson) && close(a.indenter_radius, b.indenter_radius) &&
         close(a.inclusion_poisson, b.inclusion_poisson) && same(a.depths, b.depths) &&
         same(a.radii, b.radii) && same(a.ratios, b.ratios) && same(a.indentations, b.indentations);
}

DepthGrid default_grid() {
  DepthGrid grid;
  for (const double mm :
       {3.0, 3.5, 4.1, 4.9, 5.9, 7.2, 9.0, 11.0, 13.5, 16.0, 18.5, 21.0, 23.5, 25.5, 27.0}) {
    grid.depths.push_back(mm * kMillimetre);
  }
  for (const double mm : {3.0, 4.0, 5.2, 6.8, 8.8, 11.0, 13.5, 16.0}) {
    grid.radii.push_back(mm * kMillimetre);
  }
  // Evenly in (k - 1) / (k + 1.5), what a ball does to the field far from it.
  grid.ratios = {3, 4.8, 8.5, 18, 55, 900};
  for (int i = 1; i <= 16; ++i) grid.indentations.push_back(i * 5e-3 / 16);
  return grid;
}

std::string table_bytes(const DepthTable& table) {
  wire::DepthDatabase out;
  const DepthGrid& grid = table.grid;
  out.set_format_version(kFormatVersion);
  out.set_model(table.model);
  out.set_made_by(table.made_by);
  out.set_youngs_modulus_kpa(grid.block.youngs_modulus / 1e3);
  out.set_poisson(grid.block.poisson);
  out.set_half_width_mm(grid.block.half_width / kMillimetre);
  out.set_height_mm(grid.block.height / kMillimetre);
  out.set_indenter_radius_mm(grid.indenter_radius / kMillimetre);
  out.set_inclusion_poisson(grid.inclusion_poisson);
  out.set_cylinder_height_over_radius(kCylinderHeightOverRadius);
  for (const double depth : grid.depths) out.add_depth_mm(depth / kMillimetre);
  for (const double radius : grid.radii) out.add_radius_mm(radius / kMillimetre);
  for (const double ratio : grid.ratios) out.add_ratio(ratio);
  for (const double d : grid.indentations) out.add_indentation_mm(d / kMillimetre);
  for (const double force : table.plain) out.add_plain_n(force);
  std::vector<DepthMember> members = table.members;
  std::sort(
      members.begin(), members.end(), [](const auto& a, const auto& b) { return key(a) < key(b); });
  for (const DepthMember& member : members) {
    wire::Member& one = *out.add_members();
    one.set_shape(member.shape == InclusionShape::Ball ? wire::BALL : wire::CYLINDER);
    one.set_depth(member.depth);
    one.set_radius(member.radius);
    one.set_ratio(member.ratio);
    for (const float excess : member.excess) one.add_excess(excess);
  }
  out.set_checked_rms_share(table.checked_rms);
  out.set_checked_max_share(table.checked_max);
  out.set_checked_count(table.checked_count);
  if (table.off_axis) write_shape(*table.off_axis, *out.mutable_off_axis());
  const std::string payload = out.SerializeAsString();
  return std::string{kMagic} + hash_bytes(payload) + payload;
}

Result<DepthTable> parse_table(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) return fail("this is no depth database (expected PALPDDB1)");
  const std::size_t head = kMagic.size() + kHashBytes;
  if (bytes.size() < head ||
      bytes.substr(kMagic.size(), kHashBytes) != hash_bytes(bytes.substr(head))) {
    return fail("the depth database is truncated or damaged: its checksum does not hold");
  }
  wire::DepthDatabase in;
  const std::string_view payload = bytes.substr(head);
  if (!in.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) {
    return fail("the depth database cannot be read: its checksum holds, its content does not");
  }
  if (in.format_version() != kFormatVersion) {
    return fail("the depth database has format " + std::to_string(in.format_version()) +
                ", expected 1: build it again with palp-fem database");
  }
  DepthTable table;
  table.model = in.model();
  table.made_by = in.made_by();
  DepthGrid& grid = table.grid;
  grid.block = {.half_width = in.half_width_mm() * kMillimetre,
                .height = in.height_mm() * kMillimetre,
                .youngs_modulus = in.youngs_modulus_kpa() * 1e3,
                .poisson = in.poisson()};
  grid.indenter_radius = in.indenter_radius_mm() * kMillimetre;
  grid.inclusion_poisson = in.inclusion_poisson();
  grid.depths = scaled(in.depth_mm(), kMillimetre);
  grid.radii = scaled(in.radius_mm(), kMillimetre);
  grid.ratios = scaled(in.ratio(), 1);
  grid.indentations = scaled(in.indentation_mm(), kMillimetre);
  table.plain = scaled(in.plain_n(), 1);
  for (const wire::Member& one : in.members()) {
    if (one.shape() != wire::BALL && one.shape() != wire::CYLINDER) continue;
    table.members.push_back(
        {.shape = one.shape() == wire::BALL ? InclusionShape::Ball : InclusionShape::Cylinder,
         .depth = one.depth(),
         .radius = one.radius(),
         .ratio = one.ratio(),
         .excess = {one.excess().begin(), one.excess().end()}});
  }
  table.checked_rms = in.checked_rms_share();
  table.checked_max = in.checked_max_share();
  table.checked_count = in.checked_count();
  if (in.has_off_axis()) table.off_axis = read_shape(in.off_axis());
  if (auto ok = check_table(table); !ok) return tl::unexpected<Error>(ok.error());
  return table;
}

Result<void> merge_table(DepthTable& into, const DepthTable& from) {
  if (!(into.grid == from.grid) || into.model != from.model) {
    return fail("the databases have different grids, blocks or models");
  }
  std::set<decltype(key(DepthMember{}))> have;
  for (const DepthMember& member : into.members) have.insert(key(member));
  const std::size_t before = into.members.size();
  for (const DepthMember& member : from.members) {
    if (have.insert(key(member)).second) into.members.push_back(member);
  }
  if (!into.off_axis) into.off_axis = from.off_axis;
  if (into.members.size() == before) return {};  // what was checked is as it was
  into.checked_count = 0;
  into.checked_rms = into.checked_max = 0;
  return {};
}

}  // namespace palp::fem
