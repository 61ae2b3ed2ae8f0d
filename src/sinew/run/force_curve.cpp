#include "sinew/run/force_curve.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "sinew/io/file_io.h"
#include "sinew/report/svg_plot.h"

namespace sinew {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

std::string force_curve(const std::string& probes_csv, const std::string& obstacle) {
  std::istringstream in(probes_csv);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = split(line);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), obstacle + name) -
                                    header.begin());
  };
  const std::size_t travel = column(".travel [m]");
  const std::size_t force = column(".against [N]");
  if (std::max(travel, force) >= header.size()) return {};

  report::Series series;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = split(line);
    if (std::max(travel, force) >= cells.size()) continue;
    series.x.push_back(1e3 * std::strtod(cells[travel].c_str(), nullptr));
    series.y.push_back(std::strtod(cells[force].c_str(), nullptr));
  }
  report::Plot plot;
  plot.title = "Force on " + obstacle + " against its travel";
  plot.x.label = "travel [mm]";
  plot.y.label = "force [N]";
  plot.series = {series};
  return to_svg(plot);
}

std::vector<std::string> force_curve_names(const Model& model, const Controls& controls) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.obstacles.size(); ++i)
    if (!controls.obstacle_paths[i].keys.empty())
      names.push_back(model.obstacles[i].name + "-force.svg");
  return names;
}

void write_force_curves(const std::filesystem::path& folder, const Model& model,
                        const Controls& controls) {
  std::string table;
  for (std::size_t i = 0; i < model.obstacles.size(); ++i) {
    const Obstacle& o = model.obstacles[i];
    if (controls.obstacle_paths[i].keys.empty()) continue;
    if (table.empty()) table = io::read_file(folder / "probes.csv");
    io::write_file(folder / (o.name + "-force.svg"), force_curve(table, o.name));
  }
}

}  // namespace sinew
