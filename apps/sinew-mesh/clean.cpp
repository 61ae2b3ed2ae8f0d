// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "examine.h"
#include "groups.h"

namespace sinew::mesher {
namespace {

class Cleaner {
 public:
  explicit Cleaner(std::vector<Finding>& findings) : findings_(findings) {}

  io::SurfaceSoup run(const io::SurfaceSoup& soup) {
    join_nodes(soup);
    drop_triangles();
    drop_nodes();
    return std::move(s_);
  }

 private:
  void add(const char* kind, std::int64_t count, std::string text) {
    findings_.push_back({kind, Severity::warning, count, std::move(text), {}});
  }
  const Vec3& x(Index node) const { return s_.nodes[uz(node)]; }

  void join_nodes(const io::SurfaceSoup& soup);
  void drop_triangles();
  void drop_duplicates();
  void drop_nodes();

  std::vector<Finding>& findings_;
  io::SurfaceSoup s_;
};

void Cleaner::join_nodes(const io::SurfaceSoup& soup) {
  std::vector<Index> order(soup.nodes.size()), number(soup.nodes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index n) {
    const Vec3& p = soup.nodes[uz(n)];
    return std::array<double, 3>{p.x(), p.y(), p.z()};
  };
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    number[uz(order[i])] = same ? number[uz(order[i - 1])] : order[i];
  }
  s_ = soup;
  for (Triangle& t : s_.triangles) {
    for (Index& n : t) n = number[uz(n)];
  }
}

void Cleaner::drop_triangles() {
  std::vector<Triangle>& all = s_.triangles;
  const std::size_t before = all.size();
  std::erase_if(all,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (const auto dropped = static_cast<std::int64_t>(before - all.size()); dropped > 0) {
    add("repeated_corner", dropped,
        fmt::format("{} with two corners at one place: left out", counted(dropped, "triangle")));
  }
  drop_duplicates();
  std::int64_t flat = 0;
  Vec3 where = Vec3::Zero();
  for (const Triangle& t : all) {
    if (!is_flat(x(t[0]), x(t[1]), x(t[2]))) continue;
    if (flat++ == 0) where = x(t[0]);
  }
  if (flat > 0) {
    add("flat_triangle", flat,
        fmt::format("{} without area, one at {}", counted(flat, "triangle"), to_text(where)));
  }
}

// Removes triangles with the same corners. If a patch of them closes the surface, one triangle of
// each set stays. If it is a wall between two bodies that touch there, none stays. The edges at the
// rim of the patch distinguish the two.
void Cleaner::drop_duplicates() {
  std::vector<Triangle>& all = s_.triangles;
  std::vector<std::pair<Triangle, Index>> sorted;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Triangle t = all[i];
    std::sort(t.begin(), t.end());
    sorted.emplace_back(t, static_cast<Index>(i));
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> first_of(all.size());  // the first triangle with these corners
  std::vector<bool> doubled(all.size());
  std::int64_t count = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool same = i > 0 && sorted[i].first == sorted[i - 1].first;
    const Index first = same ? first_of[uz(sorted[i - 1].second)] : sorted[i].second;
    first_of[uz(sorted[i].second)] = first;
    if (same) doubled[uz(first)] = true;
    count += same;
  }
  if (count == 0) return;

  Groups patches(all.size());
  // By edge: the number of single triangles, and a double one.
  std::map<std::array<Index, 2>, std::pair<Index, Index>> edges;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (uz(first_of[i]) != i) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = all[i][k], b = all[i][(k + 1) % 3];
      auto& [singles, double_one] =
          edges.try_emplace({std::min(a, b), std::max(a, b)}, 0, -1).first->second;
      if (!doubled[i]) {
        ++singles;
      } else if (double_one < 0) {
        double_one = static_cast<Index>(i);
      } else {
        patches.join(double_one, static_cast<Index>(i));
      }
    }
  }
  std::map<Index, std::int64_t> odd_rim;  // of each patch: rim edges with an odd number of singles,
                                          // minus those with an even number
  for (const auto& [edge, found] : edges) {
    const auto& [singles, double_one] = found;
    if (double_one >= 0 && singles > 0) odd_rim[patches.of(double_one)] += singles % 2 ? 1 : -1;
  }
  std::int64_t walls = 0;
  std::vector<bool> drop(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool wall = doubled[uz(first_of[i])] && odd_rim[patches.of(first_of[i])] < 0;
    drop[i] = wall || uz(first_of[i]) != i;
    walls += wall && uz(first_of[i]) == i;
  }
  std::size_t i = 0;
  std::erase_if(all, [&](const Triangle&) { return drop[i++]; });
  add("duplicate", count,
      fmt::format("{} at the place of an earlier one: left out{}", counted(count, "triangle"),
                  walls > 0 ? fmt::format(", and {} that were a wall inside", walls) : ""));
}

// Drops nodes that no triangle uses.
void Cleaner::drop_nodes() {
  std::vector<Index> number(s_.nodes.size(), -1);
  std::vector<Vec3> kept;
  for (Triangle& t : s_.triangles) {
    for (Index& n : t) {
      if (number[uz(n)] < 0) {
        number[uz(n)] = static_cast<Index>(kept.size());
        kept.push_back(x(n));
      }
      n = number[uz(n)];
    }
  }
  s_.nodes = std::move(kept);
}

}  // namespace

io::SurfaceSoup clean(const io::SurfaceSoup& soup, std::vector<Finding>& findings) {
  return Cleaner(findings).run(soup);
}

}  // namespace sinew::mesher
