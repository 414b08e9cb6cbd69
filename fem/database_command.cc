#include "fem/database_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include <unistd.h>

#include "common/config/json.h"
#include "common/config/number.h"
#include "common/config/report.h"
#include "common/config/settings_text.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "fem/database_builder.h"
#include "fem/database_grid.h"
#include "fem/database_processes.h"
#include "fem/depth_table.h"
#include "fem/interpolation_check.h"
#include "fem/shape_builder.h"

namespace palp::fem {
namespace {

constexpr const char* kSchema = "palp.depth-database/1";

using config::ExitCode;
using config::ExitStatus;

constexpr std::uint64_t kCheckSeed = 1;

ExitStatus bad_input(const std::string& sentence) {
  return {ExitCode::BadInput, "palp-fem: " + sentence};
}
ExitStatus cannot_open(const std::string& sentence) {
  return {ExitCode::CannotOpen, "palp-fem: " + sentence};
}
ExitStatus refused(const Error& error) {
  return error.unreachable ? cannot_open(error.text) : bad_input(error.text);
}

Result<Shard> parse_shard(const std::string& text) {
  if (text.empty()) return Shard{};
  const auto slash = text.find('/');
  const auto index = config::parse_whole(text.substr(0, slash));
  const auto count =
      slash == std::string::npos ? std::nullopt : config::parse_whole(text.substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count || *count > 10'000) {
    return fail("--shard is \"" + printable(text) + "\", expected i/n with 1 <= i <= n");
  }
  return Shard{static_cast<std::size_t>(*index - 1), static_cast<std::size_t>(*count)};
}

Detail detail_of(const DatabaseFlags& flags) {
  return flags.accuracy == "coarse" ? Detail::Coarse
         : flags.accuracy == "fine" ? Detail::Fine
                                    : Detail::Normal;
}

SolvingPlan solving_plan(const DatabaseFlags& flags) {
  return {flags.out, flags.cores, member_mesh(detail_of(flags)), flags.wall};
}

/// The grid that was asked for, if it can be solved.
Result<DepthGrid> asked_grid(const DatabaseFlags& flags) {
  const auto request = curve_request(flags.block);
  if (!request) return tl::unexpected<Error>(request.error());
  const Specimen& specimen = request->specimen;
  DepthGrid grid = grid_for(
      specimen.block, specimen.indenter.radius, specimen.inclusion.poisson, detail_of(flags));
  if (!flags.grid.empty()) {
    const auto text = read_whole_file(flags.grid);
    if (!text) return tl::unexpected<Error>(text.error());
    auto axes = with_axes(std::move(grid), *text);
    if (!axes) return fail(flags.grid + ", " + axes.error().text);
    grid = std::move(*axes);
  }
  if (auto ok = check(grid); !ok) return tl::unexpected<Error>(ok.error());
  return grid;
}

/// Everything found so far: the file itself and what the processes of an earlier run left.
Result<DepthTable> start_table(const DatabaseFlags& flags) {
  DepthTable table;
  auto grid = asked_grid(flags);
  if (!grid) return tl::unexpected<Error>(grid.error());
  table.grid = std::move(*grid);
  table.made_by = "palp-fem database, model neo, accuracy " + flags.accuracy +
                  ", each mesh relative to its own plain block";
  for (std::size_t core = 0; core <= flags.cores; ++core) {
    const std::string name = core == 0 ? flags.out : part_name(flags.out, core - 1);
    if (::access(name.c_str(), F_OK) != 0) continue;
    auto found = load_table(name);
    if (!found) return found;
    if (found->made_by != table.made_by) {
      return fail(name + " was made by \"" + printable(found->made_by) + "\", asked for is \"" +
                  table.made_by + "\"; remove it first");
    }
    if (auto merged = merge_table(table, *found); !merged) {
      return fail(name + ": " + merged.error().text + " than asked for; remove it first");
    }
    if (table.plain.empty()) table.plain = found->plain;
    if (core > 0) continue;
    table.checked_count = found->checked_count;  // of a whole file, which nothing is added to
    table.checked_rms = found->checked_rms;
    table.checked_max = found->checked_max;
  }
  if (!table.plain.empty()) return table;
  auto plain = solve_plain(table.grid);
  if (!plain) return tl::unexpected<Error>(plain.error());
  table.plain = *plain;
  return table;
}

std::size_t wanted_members(const DepthGrid& grid) {
  return cells_of(grid).size() * grid.ratios.size();
}

/// Without what the last bits say.
double in_mm(double length) { return std::round(length * 1e9) / 1e6; }

config::Json describe(const DepthTable& table) {
  const DepthGrid& grid = table.grid;
  config::Json out;
  out["schema"] = kSchema;
  out["model"] = table.model;
  out["made_by"] = table.made_by;
  out["youngs_modulus_kpa"] = grid.block.youngs_modulus / 1e3;
  out["poisson"] = grid.block.poisson;
  out["half_width_mm"] = in_mm(grid.block.half_width);
  out["height_mm"] = in_mm(grid.block.height);
  out["indenter_radius_mm"] = in_mm(grid.indenter_radius);
  out["depth_mm"] = {in_mm(grid.depths.front()), in_mm(grid.depths.back())};
  out["radius_mm"] = {in_mm(grid.radii.front()), in_mm(grid.radii.back())};
  out["ratio"] = {grid.ratios.front(), grid.ratios.back()};
  out["indentation_max_mm"] = in_mm(grid.indentations.back());
  out["members"] = table.members.size();
  out["members_wanted"] = wanted_members(grid);
  out["off_axis_values"] = table.off_axis ? table.off_axis->shape.size() : 0;
  out["checked_count"] = table.checked_count;
  out["checked_rms_share"] = table.checked_rms;
  out["checked_max_share"] = table.checked_max;
  return out;
}

ExitStatus tell(const DepthTable& table, const std::string& report) {
  const std::string text = describe(table).dump(2) + "\n";
  if (!report.empty()) {
    if (const auto written = config::write_whole_file(report, text); !written) {
      return cannot_open(written.error().text);
    }
  }
  return {ExitCode::Done, text};
}

/// States how far the interpolation is off, of a grid that is whole.
Result<void> check_if_asked(DepthTable& table, const DatabaseFlags& flags) {
  if (flags.check == 0 || table.members.size() != wanted_members(table.grid)) return {};
  return check_interpolation(
      table, static_cast<std::uint32_t>(flags.check), kCheckSeed, member_mesh(detail_of(flags)));
}

/// The shape beside the axis, of a grid that is whole.
Result<void> add_shape_if_asked(DepthTable& table, const DatabaseFlags& flags) {
  const bool whole = table.members.size() == wanted_members(table.grid);
  if (!flags.off_axis || !whole || table.off_axis) return {};
  const Detail detail = detail_of(flags);
  const ForEach on_all_cores = [&](std::size_t count, const auto& work) {
    flags.for_each_index(count, flags.cores, work);
  };
  auto shape = solve_shape_table(
      table.grid, shape_axes(table.grid, detail), shape_mesh(detail), on_all_cores);
  if (!shape) return tl::unexpected<Error>(shape.error());
  table.off_axis = std::move(*shape);
  return {};
}

ExitStatus save(const DepthTable& table, const DatabaseFlags& flags) {
  if (const auto written = config::write_whole_file(flags.out, table_bytes(table)); !written) {
    return cannot_open(written.error().text);
  }
  return tell(table, flags.report);
}

/// What is done once the grid is whole.
void declare_of_whole(config::CommandLine& line, DatabaseFlags& flags) {
  line.whole("--check",
             flags.check,
             {.min = 0, .max = 10'000},
             "phantoms between the grid's points, solved to state the interpolation's error");
  line.toggle("--off-axis", flags.off_axis, "adds what is left of a ball's effect beside its axis");
  line.choice("--accuracy", flags.accuracy, {"coarse", "normal", "fine"}, "of grid and meshes");
}

}  // namespace

void declare_database(config::CommandLine& line, DatabaseFlags& flags) {
  line.output("--out", flags.out, "the database; an unfinished one is completed");
  line.text("--shard", flags.shard, "i/n", "one share of the grid; merge puts them together");
  line.whole("--cores", flags.cores, {.min = 1, .max = 256}, "processes at a time");
  declare_block(line, flags.block);
  line.text("--grid", flags.grid, "FILE", "lines depth_mm, radius_mm, ratio, indentation_mm: axes");
  declare_of_whole(line, flags);
  line.report(flags.report, kSchema);
  config::declare_submission(line, flags.submission);
}

void declare_merge(config::CommandLine& line, DatabaseFlags& flags) {
  line.output("--out", flags.out, "the database");
  declare_of_whole(line, flags);
  line.report(flags.report, kSchema);
  line.arguments("FILE", flags.files, "databases of one grid");
}

void declare_info(config::CommandLine& line, DatabaseFlags& flags) {
  line.report(flags.report, kSchema);
  line.argument("FILE", flags.file, "a database");
  line.required();
}

ExitStatus run_database(const DatabaseFlags& flags) {
  const auto shard = parse_shard(flags.shard);
  if (!shard) return bad_input(shard.error().text);
  auto table = start_table(flags);
  if (!table) return refused(table.error());
  if (table->members.size() < wanted_members(table->grid)) {
    const Forecast ahead = forecast(table->grid, detail_of(flags), flags.off_axis);
    std::fprintf(stderr, "palp-fem: %s\n", forecast_text(ahead, flags.cores).c_str());
  }
  if (const auto done = solve_on_all_cores(*table, *shard, solving_plan(flags)); !done) {
    return cannot_open(done.error().text);
  }
  for (std::size_t core = 0; core < flags.cores; ++core) {
    const std::string name = part_name(flags.out, core);
    if (::access(name.c_str(), F_OK) != 0) continue;
    const auto part = load_table(name);
    if (!part) return refused(part.error());
    if (auto merged = merge_table(*table, *part); !merged) return bad_input(merged.error().text);
  }
  if (auto checked = check_if_asked(*table, flags); !checked) {
    return bad_input(checked.error().text);
  }
  if (auto added = add_shape_if_asked(*table, flags); !added) {
    return bad_input(added.error().text);
  }
  ExitStatus exit_status = save(*table, flags);
  if (exit_status.code != ExitCode::Done) return exit_status;  // the parts are all there is
  for (std::size_t core = 0; core < flags.cores; ++core) {
    static_cast<void>(std::remove(part_name(flags.out, core).c_str()));
  }
  return exit_status;
}

ExitStatus run_merge(const DatabaseFlags& flags) {
  std::optional<DepthTable> table;
  for (const std::string& name : flags.files) {
    auto found = load_table(name);
    if (!found) return refused(found.error());
    if (!table) {
      table = std::move(*found);
      continue;
    }
    const std::size_t before = table->members.size();
    const bool adds_shape = !table->off_axis && found->off_axis;
    if (auto merged = merge_table(*table, *found); !merged) {
      return bad_input(name + ": " + merged.error().text);
    }
    if (table->members.size() == before && !adds_shape && !found->members.empty()) {
      return bad_input(name + " adds no curve to those before it: is one given twice?");
    }
  }
  if (auto checked = check_if_asked(*table, flags); !checked) {
    return bad_input(checked.error().text);
  }
  if (auto added = add_shape_if_asked(*table, flags); !added) {
    return bad_input(added.error().text);
  }
  ExitStatus exit_status = save(*table, flags);
  const std::size_t wanted = wanted_members(table->grid);
  if (exit_status.code != ExitCode::Done || table->members.size() == wanted) return exit_status;
  return {ExitCode::Missed,
          "palp-fem: " + flags.out + " has " + std::to_string(table->members.size()) + " of " +
              std::to_string(wanted) + " curves: merge the files of all shards"};
}

ExitStatus run_info(const DatabaseFlags& flags) {
  const auto table = load_table(flags.file);
  if (!table) return refused(table.error());
  return tell(*table, flags.report);
}

}  // namespace palp::fem
