// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <cstdlib>
#include "examine.h"
#include "mesher.h"
#include "sinew/io/mesh_io.h"
using namespace sinew;
int main(int, char** argv) {
  mesher::Progress progress(false);
  mesher::Target target;
  target.size = std::atof(argv[3]);
  target.distance = target.size / 8;
  if (io::is_image_name(argv[1])) {
    target.manifold = false;
    const auto mesh = mesher::fill_image(io::read_image(argv[1]), target, progress);
    io::write_mesh(argv[2], mesh);
    return 0;
  }
  const auto e = mesher::examine(io::read_surface(argv[1]));
  for (auto& f : e.findings) fmt::print("{} {} {}\n", f.kind, int(f.severity), f.text);
  if (!e.usable()) return 3;
  const auto mesh = mesher::fill_surface(e.surface, target, progress);
  io::write_mesh(argv[2], mesh);
}
