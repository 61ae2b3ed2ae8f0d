// SPDX-License-Identifier: GPL-3.0-or-later
// Faults of a surface: whether it bounds a volume.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sinew/io/surface_file.h"
#include "sinew/mesh/doctor.h"

namespace sinew::mesher {

// kind: a short stable name for scripts. warning: harmless, or corrected without a request;
// repairable: --repair may help; fatal: cannot be repaired here.
struct Finding {
  std::string kind;
  Severity severity;
  std::int64_t count;
  std::string text;    // "open: 2 holes; the largest has 12 edges around (0, 0, 1)"
  std::string remedy;  // empty for warnings
};

// Triangles connected by edges.
struct Part {
  Index triangles = 0;
  Index loops = 0;          // number of holes: loops of edges with one triangle; 0: closed
  double area = 0;          // in the file's unit squared
  double volume = 0;        // enclosed volume if closed, in the unit cubed
  int depth = 0;            // number of other closed parts around it; odd: a cavity
  Vec3 low = Vec3::Zero();  // its box, in the file's unit
  Vec3 high = Vec3::Zero();
};

struct Examination {
  io::SurfaceSoup surface;  // nodes joined, unusable triangles dropped, the triangles of a part
                            // turned alike, closed parts outwards
  std::vector<Part> parts;
  std::vector<Index> part_of;  // (triangles)
  std::vector<Finding> findings;
  double area = 0;
  double volume = 0;  // without cavities; valid if nothing is repairable or fatal
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();

  bool usable() const;
  const Finding* find(const std::string& kind) const;
};

// The first step of examine(): joins coincident nodes; drops triangles that repeat a node,
// duplicates, walls between bodies that touch, and nodes that no triangle uses.
io::SurfaceSoup clean(const io::SurfaceSoup& soup, std::vector<Finding>& findings);

// Does not throw for a faulty surface.
Examination examine(const io::SurfaceSoup& soup);

// Pairs of triangles that meet in more than a common edge or corner; flat triangles do not count.
struct Crossings {
  std::int64_t pairs = 0;
  std::int64_t within_parts = 0;            // both triangles of one part
  Vec3 first = Vec3::Zero();                // place of one, in the file's unit
  std::vector<std::array<Index, 2>> parts;  // parts that cross each other, the smaller first
};
Crossings find_crossings(const io::SurfaceSoup& surface, const std::vector<Index>& part_of);

// Joins nodes that lie closer than a millionth of the extent, drops scraps, closes holes, unites
// parts that cross each other, and cuts out where a part crosses itself. Each change is a line in
// `log`. Call examine() on the result.
io::SurfaceSoup repair_surface(const Examination& examined, std::vector<std::string>& log);

// Whether all corners lie on one line, to rounding.
bool is_flat(const Vec3& a, const Vec3& b, const Vec3& c);
// "(0.1, 2, -3)"
std::string to_text(const Vec3& x);

}  // namespace sinew::mesher
