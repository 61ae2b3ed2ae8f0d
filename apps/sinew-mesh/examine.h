// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with a surface: does it bound a volume?
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sinew/io/surface_file.h"
#include "sinew/mesh/doctor.h"

namespace sinew::mesher {

// kind: a short stable name for scripts. warning: put right without being asked, or harmless;
// repairable: --repair may help; fatal: nothing here does.
struct Finding {
  std::string kind;
  Severity severity;
  std::int64_t count;
  std::string text;    // "open: 2 holes; the largest has 12 edges around (0, 0, 1)"
  std::string remedy;  // empty for warnings
};

// Triangles that hang together by edges.
struct Part {
  Index triangles = 0;
  Index loops = 0;          // of edges with one triangle; 0: closed
  double area = 0;          // in the file's unit squared
  double volume = 0;        // that it encloses, if closed, in the unit cubed
  int depth = 0;            // in how many other closed parts it lies; odd: a cavity
  Vec3 low = Vec3::Zero();  // its box, in the file's unit
  Vec3 high = Vec3::Zero();
};

struct Examination {
  io::SurfaceSoup surface;  // nodes joined, triangles that count for nothing dropped, those of one
                            // part turned alike, closed parts outwards
  std::vector<Part> parts;
  std::vector<Index> part_of;  // (triangles)
  std::vector<Finding> findings;
  double area = 0;
  double volume = 0;  // cavities taken off; of use where nothing is repairable or fatal
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();

  bool usable() const;
  const Finding* find(const std::string& kind) const;
};

// The first step of examine(): joins nodes at the same place; leaves out triangles that name a
// place twice, stand twice or are a wall between bodies that touch, and nodes that no triangle
// names.
io::SurfaceSoup clean(const io::SurfaceSoup& soup, std::vector<Finding>& findings);

// Never throws for a bad surface.
Examination examine(const io::SurfaceSoup& soup);

// Pairs of triangles that meet in more than a common edge or corner; flat triangles are left out.
struct Crossings {
  std::int64_t pairs = 0;
  std::int64_t within_parts = 0;            // both triangles of one part
  Vec3 first = Vec3::Zero();                // where one is, in the file's unit
  std::vector<std::array<Index, 2>> parts;  // parts that cross each other, the smaller first
};
Crossings find_crossings(const io::SurfaceSoup& surface, const std::vector<Index>& part_of);

// Joins nodes that lie closer than a millionth of the extent, drops scraps, closes holes, unites
// parts that cross each other, cuts out where a part crosses itself. What was done goes to `log`,
// a line each. What comes back is for examine() to judge.
io::SurfaceSoup repair_surface(const Examination& examined, std::vector<std::string>& log);

// Whether all corners lie on one line, to rounding.
bool is_flat(const Vec3& a, const Vec3& b, const Vec3& c);
// "(0.1, 2, -3)"
std::string to_text(const Vec3& x);

}  // namespace sinew::mesher
