// SPDX-License-Identifier: GPL-3.0-or-later
#include "examine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "groups.h"

namespace sinew::mesher {
namespace {

// One side of an edge: the triangle, and whether it runs from the smaller node to the larger.
struct Side {
  Index a, b;  // a < b
  Index triangle;
  bool forward;
};

class Examiner {
 public:
  explicit Examiner(const io::SurfaceSoup& soup) : s_(e_.surface) { s_ = clean(soup, e_.findings); }

  Examination run() {
    if (s_.triangles.empty()) {
      add("no_triangles", Severity::fatal, 0, "no triangle is left: all name a corner twice",
          "export the surface again");
      return std::move(e_);
    }
    measure_extent();
    make_sides();
    make_parts();
    turn_alike();
    look_at_edges();
    look_at_nodes();
    measure_parts();
    if (e_.usable()) look_for_crossings();
    if (e_.usable()) nest();
    return std::move(e_);
  }

 private:
  void add(const char* kind, Severity severity, std::int64_t count, std::string text,
           std::string remedy = {}) {
    e_.findings.push_back({kind, severity, count, std::move(text), std::move(remedy)});
  }
  const Vec3& x(Index node) const { return s_.nodes[uz(node)]; }
  // A place for a message: coordinates that are negligible beside the extent become 0.
  std::string at(const Vec3& p) const {
    const double least = 1e-9 * (e_.high - e_.low).norm();
    return to_text(p.unaryExpr([&](double v) { return std::abs(v) < least ? 0.0 : v; }));
  }

  void measure_extent();
  void make_sides();
  void make_parts();
  void turn_alike();
  void look_at_edges();
  void look_at_nodes();
  void holes(const std::vector<Side>& open);
  void measure_parts();
  void look_for_crossings();
  void nest();
  double winding_number(Index part, const Vec3& p) const;
  template <typename Do>
  void each_edge(Do action) const {
    for (std::size_t i = 0; i < sides_.size();) {
      std::size_t end = i + 1;
      while (end < sides_.size() && sides_[end].a == sides_[i].a && sides_[end].b == sides_[i].b) {
        ++end;
      }
      action(&sides_[i], end - i);
      i = end;
    }
  }

  Examination e_;
  io::SurfaceSoup& s_;
  std::vector<Side> sides_;  // by edge
};

void Examiner::measure_extent() {
  e_.low = e_.high = x(s_.triangles[0][0]);
  for (const Triangle& t : s_.triangles) {
    for (const Index n : t) {
      e_.low = e_.low.cwiseMin(x(n));
      e_.high = e_.high.cwiseMax(x(n));
    }
  }
}

void Examiner::make_sides() {
  for (std::size_t i = 0; i < s_.triangles.size(); ++i) {
    const Triangle& t = s_.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      sides_.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(i), a < b});
    }
  }
  std::sort(sides_.begin(), sides_.end(), [](const Side& l, const Side& r) {
    return std::array{l.a, l.b, l.triangle} < std::array{r.a, r.b, r.triangle};
  });
}

void Examiner::make_parts() {
  Groups groups(s_.triangles.size());
  each_edge([&](const Side* side, std::size_t n) {
    for (std::size_t i = 1; i < n; ++i) groups.join(side[0].triangle, side[i].triangle);
  });
  std::map<Index, Index> number;
  for (std::size_t i = 0; i < s_.triangles.size(); ++i) {
    const Index group = groups.of(static_cast<Index>(i));
    const auto [entry, added] = number.emplace(group, static_cast<Index>(e_.parts.size()));
    const Vec3& corner = x(s_.triangles[i][0]);
    if (added) {
      e_.parts.emplace_back();
      e_.parts.back().low = e_.parts.back().high = corner;
    }
    e_.part_of.push_back(entry->second);
    Part& part = e_.parts[uz(entry->second)];
    ++part.triangles;
    for (const Index n : s_.triangles[i]) {
      part.low = part.low.cwiseMin(x(n));
      part.high = part.high.cwiseMax(x(n));
    }
  }
}

// Turns triangles until the two at every edge run through it in opposite directions; if that is
// impossible, the surface has one side only.
void Examiner::turn_alike() {
  struct Next {
    Index triangle;
    bool same;  // whether both run the same way through the edge
  };
  std::vector<std::vector<Next>> next(s_.triangles.size());
  std::int64_t odd = 0;
  each_edge([&](const Side* side, std::size_t n) {
    if (n != 2) return;
    const bool same = side[0].forward == side[1].forward;
    odd += same;
    next[uz(side[0].triangle)].push_back({side[1].triangle, same});
    next[uz(side[1].triangle)].push_back({side[0].triangle, same});
  });
  if (odd == 0) return;
  std::vector<signed char> turn(s_.triangles.size(), -1);
  std::vector<Index> front;
  std::int64_t conflicts = 0;
  Vec3 where = Vec3::Zero();
  for (std::size_t seed = 0; seed < turn.size(); ++seed) {
    if (turn[seed] >= 0) continue;
    turn[seed] = 0;
    front.assign(1, static_cast<Index>(seed));
    while (!front.empty()) {
      const Index t = front.back();
      front.pop_back();
      for (const Next& n : next[uz(t)]) {
        const auto wanted = static_cast<signed char>(turn[uz(t)] ^ (n.same ? 1 : 0));
        if (turn[uz(n.triangle)] < 0) {
          turn[uz(n.triangle)] = wanted;
          front.push_back(n.triangle);
        } else if (turn[uz(n.triangle)] != wanted && conflicts++ == 0) {
          where = x(s_.triangles[uz(t)][0]);
        }
      }
    }
  }
  if (conflicts > 0) {
    add("not_orientable", Severity::fatal, conflicts,
        fmt::format(
            "has one side only, like a Moebius strip or a Klein bottle, so it has no inside; "
            "seen at {}",
            at(where)),
        "model the surface anew");
    return;
  }
  std::int64_t turned = 0;
  for (std::size_t i = 0; i < turn.size(); ++i) {
    if (turn[i] != 1) continue;
    std::swap(s_.triangles[i][1], s_.triangles[i][2]);
    ++turned;
  }
  sides_.clear();
  make_sides();
  add("turned", Severity::warning, odd,
      fmt::format("{} between triangles that face opposite ways: turned {}", counted(odd, "edge"),
                  counted(turned, "triangle")));
}

void Examiner::look_at_edges() {
  std::vector<Side> open;
  std::int64_t walls = 0, touching = 0;
  Vec3 wall = Vec3::Zero(), touch = Vec3::Zero();
  each_edge([&](const Side* side, std::size_t n) {
    if (n == 1) open.push_back(side[0]);
    if (n == 3 || (n > 4 && n % 2 == 1)) {
      if (walls++ == 0) wall = 0.5 * (x(side[0].a) + x(side[0].b));
    } else if (n > 2) {
      if (touching++ == 0) touch = 0.5 * (x(side[0].a) + x(side[0].b));
    }
  });
  if (!open.empty()) holes(open);
  if (walls > 0) {
    add("wall", Severity::repairable, walls,
        fmt::format("{} with an odd number of triangles, one at {}: a wall or a fin hangs on the "
                    "surface",
                    counted(walls, "edge"), at(wall)),
        "remove the wall, or try --repair");
  }
  if (touching > 0) {
    add("touching", Severity::warning, touching,
        fmt::format("{} with four triangles or more, one at {}: the surface touches itself there",
                    counted(touching, "edge"), at(touch)));
  }
}

// A node belongs to several fans if its triangles are not connected by edges.
void Examiner::look_at_nodes() {
  Groups fans(3 * s_.triangles.size());  // of the corners of triangles
  const auto corner = [&](Index triangle, Index node) {
    const Triangle& t = s_.triangles[uz(triangle)];
    return 3 * triangle + (t[0] == node ? 0 : t[1] == node ? 1 : 2);
  };
  each_edge([&](const Side* side, std::size_t n) {
    if (n != 2) return;
    for (const Index node : {side[0].a, side[0].b}) {
      fans.join(corner(side[0].triangle, node), corner(side[1].triangle, node));
    }
  });
  std::vector<Index> fan(s_.nodes.size(), -1);
  std::vector<bool> several(s_.nodes.size());
  for (std::size_t i = 0; i < 3 * s_.triangles.size(); ++i) {
    const std::size_t node = uz(s_.triangles[i / 3][i % 3]);
    const Index found = fans.of(static_cast<Index>(i));
    if (fan[node] >= 0 && fan[node] != found) several[node] = true;
    fan[node] = found;
  }
  const auto count = std::count(several.begin(), several.end(), true);
  if (count == 0 || e_.find("touching") || e_.find("wall")) return;
  const auto first = std::find(several.begin(), several.end(), true) - several.begin();
  add("touching", Severity::warning, count,
      fmt::format("{} where the surface touches itself, one at {}", counted(count, "node"),
                  at(x(static_cast<Index>(first)))));
}

void Examiner::holes(const std::vector<Side>& open) {
  std::map<Index, std::vector<std::size_t>> at_node;
  Groups loops(open.size());
  for (std::size_t i = 0; i < open.size(); ++i) {
    for (const Index n : {open[i].a, open[i].b}) {
      for (const std::size_t other : at_node[n]) {
        loops.join(static_cast<Index>(i), static_cast<Index>(other));
      }
      at_node[n].push_back(i);
    }
  }
  struct Loop {
    Index edges = 0;
    double length = 0;
    Vec3 sum = Vec3::Zero();
  };
  std::map<Index, Loop> found;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto [entry, added] = found.try_emplace(loops.of(static_cast<Index>(i)));
    if (added) ++e_.parts[uz(e_.part_of[uz(open[i].triangle)])].loops;
    Loop& loop = entry->second;
    ++loop.edges;
    loop.length += (x(open[i].a) - x(open[i].b)).norm();
    loop.sum += 0.5 * (x(open[i].a) + x(open[i].b));
  }
  const auto largest = std::max_element(
      found.begin(), found.end(),
      [](const auto& l, const auto& r) { return l.second.length < r.second.length; });
  const Loop& l = largest->second;
  add("open", Severity::repairable, static_cast<std::int64_t>(found.size()),
      fmt::format("open: {} ({} in all); {} {} around {}, {:.4g} round",
                  counted(static_cast<std::int64_t>(found.size()), "hole"),
                  counted(static_cast<std::int64_t>(open.size()), "edge"),
                  found.size() == 1 ? "it has its" : "the largest has", counted(l.edges, "edge"),
                  at(l.sum / l.edges), l.length),
      "close the surface, or let --repair fill what is missing");
}

void Examiner::measure_parts() {
  for (std::size_t i = 0; i < s_.triangles.size(); ++i) {
    const Triangle& t = s_.triangles[i];
    Part& part = e_.parts[uz(e_.part_of[i])];
    // Relative to a corner of the part's box, so that no digits are lost far from the origin.
    const Vec3 a = x(t[0]) - part.low, b = x(t[1]) - part.low, c = x(t[2]) - part.low;
    part.area += 0.5 * (b - a).cross(c - a).norm();
    part.volume += a.dot(b.cross(c)) / 6;
  }
  std::int64_t closed = 0, empty = 0;
  for (std::size_t p = 0; p < e_.parts.size(); ++p) {
    Part& part = e_.parts[p];
    e_.area += part.area;
    if (part.loops > 0) {
      part.volume = 0;
      continue;
    }
    ++closed;
    if (part.volume < 0) {
      for (std::size_t i = 0; i < s_.triangles.size(); ++i) {
        if (uz(e_.part_of[i]) == p) std::swap(s_.triangles[i][1], s_.triangles[i][2]);
      }
      part.volume = -part.volume;
    }
    if (part.volume <= 1e-9 * std::pow(part.area, 1.5)) ++empty;
  }
  if (empty > 0) {
    add("no_volume", Severity::fatal, empty,
        fmt::format("{} of {} closed part{} {} no volume: flat, or folded onto itself", empty,
                    closed, closed == 1 ? "" : "s", empty == 1 ? "encloses" : "enclose"),
        "give the surface a thickness");
  }
}

void Examiner::look_for_crossings() {
  const Crossings found = find_crossings(s_, e_.part_of);
  if (found.pairs == 0) return;
  const std::int64_t between = found.pairs - found.within_parts;
  add("crossing", Severity::repairable, found.pairs,
      fmt::format("crosses itself: {} of triangles ({}), one at {}",
                  counted(found.pairs, "crossing pair"),
                  between == 0              ? std::string("within one part")
                  : found.within_parts == 0 ? std::string("between parts")
                                            : fmt::format("{} between parts", between),
                  at(found.first)),
      "correct the surface where it crosses, or try --repair");
}

// The solid angle of a surface seen from p over 4 pi (A. van Oosterom and J. Strackee, "The solid
// angle of a plane triangle", 1983).
double Examiner::winding_number(Index part, const Vec3& p) const {
  double sum = 0;
  for (std::size_t i = 0; i < s_.triangles.size(); ++i) {
    if (e_.part_of[i] != part) continue;
    const Triangle& t = s_.triangles[i];
    const Vec3 a = x(t[0]) - p, b = x(t[1]) - p, c = x(t[2]) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

// Parts do not cross here, so one point decides whether a part lies in another.
void Examiner::nest() {
  std::vector<Index> corner(e_.parts.size());
  for (std::size_t i = 0; i < s_.triangles.size(); ++i) {
    corner[uz(e_.part_of[i])] = s_.triangles[i][0];
  }
  std::int64_t cavities = 0;
  for (std::size_t p = 0; p < e_.parts.size(); ++p) {
    Part& inner = e_.parts[p];
    for (std::size_t q = 0; q < e_.parts.size(); ++q) {
      const Part& outer = e_.parts[q];
      if (p == q || (inner.low.array() < outer.low.array()).any() ||
          (inner.high.array() > outer.high.array()).any()) {
        continue;
      }
      if (winding_number(static_cast<Index>(q), x(corner[p])) > 0.5) ++inner.depth;
    }
    const bool cavity = inner.depth % 2 == 1;
    cavities += cavity;
    e_.volume += cavity ? -inner.volume : inner.volume;
  }
  if (e_.parts.size() > 1) {
    const auto solid = static_cast<std::int64_t>(e_.parts.size()) - cavities;
    add("parts", Severity::warning, static_cast<std::int64_t>(e_.parts.size()),
        fmt::format("{} closed parts: {}, {}", e_.parts.size(), fmt::format("{} filled", solid),
                    cavities == 0 ? std::string("none inside another")
                                  : fmt::format("{} inside another and left hollow", cavities)));
  }
}

}  // namespace

bool is_flat(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const double height = (b - a).cross(c - a).norm() / std::max(longest, 1e-300);
  return !(height > 1e-12 * longest);
}

std::string to_text(const Vec3& x) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", x.x(), x.y(), x.z());
}

bool Examination::usable() const {
  return std::all_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::warning; });
}

const Finding* Examination::find(const std::string& kind) const {
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&](const Finding& f) { return f.kind == kind; });
  return found == findings.end() ? nullptr : &*found;
}

Examination examine(const io::SurfaceSoup& soup) {
  return Examiner(soup).run();
}

}  // namespace sinew::mesher
