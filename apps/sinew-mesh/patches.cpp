// SPDX-License-Identifier: GPL-3.0-or-later
#include "patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "groups.h"

namespace sinew::mesher {
namespace {

// Triangles connected by edges that have exactly two of them.
struct Patches {
  Index count = 0;
  std::vector<Index> of;      // (triangles)
  std::vector<bool> open;     // has an edge with one triangle (patches)
  std::vector<bool> at_wall;  // has an edge with 3, 5, 7 ... triangles (patches)
};

Patches find_patches(const io::SurfaceSoup& s) {
  std::map<std::array<Index, 2>, std::vector<Index>> edges;
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = s.triangles[i][k], b = s.triangles[i][(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back(static_cast<Index>(i));
    }
  }
  std::vector<std::vector<Index>> next(s.triangles.size());
  for (const auto& [edge, triangles] : edges) {
    if (triangles.size() != 2) continue;
    next[uz(triangles[0])].push_back(triangles[1]);
    next[uz(triangles[1])].push_back(triangles[0]);
  }
  Patches p;
  p.of.assign(s.triangles.size(), -1);
  std::vector<Index> front;
  for (std::size_t seed = 0; seed < p.of.size(); ++seed) {
    if (p.of[seed] >= 0) continue;
    p.of[seed] = p.count;
    front.assign(1, static_cast<Index>(seed));
    while (!front.empty()) {
      const Index t = front.back();
      front.pop_back();
      for (const Index n : next[uz(t)]) {
        if (p.of[uz(n)] >= 0) continue;
        p.of[uz(n)] = p.count;
        front.push_back(n);
      }
    }
    ++p.count;
  }
  p.open.assign(uz(p.count), false);
  p.at_wall.assign(uz(p.count), false);
  for (const auto& [edge, triangles] : edges) {
    for (const Index t : triangles) {
      const std::size_t patch = uz(p.of[uz(t)]);
      if (triangles.size() == 1) p.open[patch] = true;
      if (triangles.size() >= 3 && triangles.size() % 2 == 1) p.at_wall[patch] = true;
    }
  }
  return p;
}

io::SurfaceSoup without(const io::SurfaceSoup& s, const std::vector<bool>& drop) {
  io::SurfaceSoup out;
  out.nodes = s.nodes;
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    if (!drop[i]) out.triangles.push_back(s.triangles[i]);
  }
  return out;
}

double enclosed(const Examination& e) {
  double volume = 0;
  for (const Part& part : e.parts) volume += part.volume;
  return volume;
}

constexpr Index most_tried = 24;  // patches whose removal is tried

}  // namespace

io::SurfaceSoup join_close_nodes(const Examination& e, std::vector<std::string>& log) {
  const double near = 1e-6 * (e.high - e.low).norm();
  io::SurfaceSoup s = e.surface;
  std::map<std::array<std::int64_t, 3>, std::vector<Index>> cells;  // of side near
  std::vector<Index> number(s.nodes.size());
  std::int64_t joined = 0;
  for (std::size_t i = 0; i < s.nodes.size(); ++i) {
    number[i] = static_cast<Index>(i);
    const Vec3 c = ((s.nodes[i] - e.low) / near).array().floor();
    if (!(c.cwiseAbs().maxCoeff() < 1e9)) continue;  // a node that no triangle uses
    std::array<std::int64_t, 3> cell{};
    for (int a = 0; a < 3; ++a) cell[static_cast<std::size_t>(a)] = std::int64_t(c[a]);
    Index found = -1;
    for (int k = 0; k < 27 && found < 0; ++k) {
      const auto there =
          cells.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (there == cells.end()) continue;
      for (const Index n : there->second) {
        if ((s.nodes[uz(n)] - s.nodes[i]).norm() <= near) found = n;
      }
    }
    if (found < 0) {
      cells[cell].push_back(static_cast<Index>(i));
    } else {
      number[i] = found;
      joined += s.nodes[uz(found)] != s.nodes[i];
    }
  }
  if (joined == 0) return s;
  for (Triangle& t : s.triangles) {
    for (Index& n : t) n = number[uz(n)];
  }
  log.push_back(
      fmt::format("joined {} closer than {:.3g} to another", counted(joined, "node"), near));
  return s;
}

io::SurfaceSoup drop_walls(const Examination& e, std::vector<std::string>& log) {
  Examination now = e;
  for (int round = 0; round < 20 && now.find("wall"); ++round) {
    const Patches patches = find_patches(now.surface);
    std::vector<bool> fin(uz(patches.count));
    for (std::size_t p = 0; p < fin.size(); ++p) fin[p] = patches.open[p] && patches.at_wall[p];
    std::vector<bool> drop(now.surface.triangles.size());
    if (std::find(fin.begin(), fin.end(), true) == fin.end()) {
      double best = -1;
      Index chosen = -1, tried = 0;
      for (Index p = 0; p < patches.count && tried < most_tried; ++p) {
        if (!patches.at_wall[uz(p)]) continue;
        ++tried;
        for (std::size_t i = 0; i < drop.size(); ++i) drop[i] = patches.of[i] == p;
        const double volume = enclosed(examine(without(now.surface, drop)));
        if (volume <= best) continue;
        best = volume;
        chosen = p;
      }
      if (chosen < 0) break;
      fin[uz(chosen)] = true;
    }
    Index triangles = 0;
    for (std::size_t i = 0; i < drop.size(); ++i) {
      drop[i] = fin[uz(patches.of[i])];
      triangles += drop[i];
    }
    if (triangles == 0 || uz(triangles) == drop.size()) break;
    log.push_back(fmt::format("left out {} of a wall or a fin", counted(triangles, "triangle")));
    now = examine(without(now.surface, drop));
  }
  return now.surface;
}

io::SurfaceSoup drop_scraps(const Examination& e, std::vector<std::string>& log) {
  std::vector<bool> drop(e.surface.triangles.size());
  Index triangles = 0;
  for (std::size_t i = 0; i < drop.size(); ++i) {
    const Part& part = e.parts[uz(e.part_of[i])];
    drop[i] = part.loops > 0 && part.area < 0.01 * e.area;
    triangles += drop[i];
  }
  if (triangles == 0 || uz(triangles) == drop.size()) return e.surface;
  log.push_back(fmt::format("left out {} of open scraps", counted(triangles, "triangle")));
  return without(e.surface, drop);
}

}  // namespace sinew::mesher
