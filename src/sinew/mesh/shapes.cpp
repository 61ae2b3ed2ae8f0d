#include "sinew/mesh/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/mesh/jitter.h"

namespace sinew {
namespace {

// The bounds keep every volume far from underflow and overflow.
void require_length(const char* shape, const char* name, double value) {
  if (value >= 1e-6 && value <= 1e6) return;
  throw Error(ErrorKind::input,
              fmt::format("{}: {} is {}, expected a length from 1e-6 to 1e6 m", shape, name, value),
              fmt::format("give {} in metres, for example 0.05", name));
}

void require_count(const char* shape, const char* name, Index value) {
  if (value >= 1) return;
  throw Error(ErrorKind::input, fmt::format("{}: {} is {}, expected 1 or more", shape, name, value),
              fmt::format("give a positive whole number for {}", name));
}

// tets as a double: the product of the user's counts may overflow any integer.
void require_tets(const char* shape, const char* name, double tets) {
  if (tets <= static_cast<double>(kMaxShapeTets)) return;
  throw Error(ErrorKind::input,
              fmt::format("{}: {} asks for {:.3g} million tets, expected {} million or fewer",
                          shape, name, tets / 1e6, kMaxShapeTets / 1'000'000),
              fmt::format("give smaller numbers for {}", name));
}

void require_grid(const char* shape, const Vec3& size, const std::array<Index, 3>& cells,
                  double jitter, int tets_per_cell) {
  constexpr std::array<const char*, 3> kSize = {"size[0]", "size[1]", "size[2]"};
  constexpr std::array<const char*, 3> kCells = {"cells[0]", "cells[1]", "cells[2]"};
  double tets = tets_per_cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    require_length(shape, kSize[axis], size[static_cast<Eigen::Index>(axis)]);
    require_count(shape, kCells[axis], cells[axis]);
    tets *= cells[axis];
  }
  require_tets(shape, "cells", tets);
  if (!(jitter >= 0.0 && jitter <= kMaxJitter))
    throw Error(
        ErrorKind::input,
        fmt::format("{}: jitter is {}, expected a share from 0 to {}", shape, jitter, kMaxJitter),
        "0.2 makes an irregular mesh");
}

Vec3 cell_size(const Vec3& size, const std::array<Index, 3>& cells) {
  return {size.x() / cells[0], size.y() / cells[1], size.z() / cells[2]};
}

// The nodes of a grid of cells, x fastest, from origin to origin + size; no tets yet.
TetMesh grid_nodes(const Vec3& origin, const Vec3& size, const std::array<Index, 3>& cells) {
  const auto [nx, ny, nz] = cells;
  const Vec3 h = cell_size(size, cells);
  TetMesh mesh;
  mesh.nodes.reserve((uz(nx) + 1) * (uz(ny) + 1) * (uz(nz) + 1));
  for (Index l = 0; l <= nz; ++l) {
    for (Index j = 0; j <= ny; ++j) {
      for (Index i = 0; i <= nx; ++i) {
        mesh.nodes.emplace_back(i * h.x() + origin.x(), j * h.y() + origin.y(),
                                l * h.z() + origin.z());
      }
    }
  }
  return mesh;
}

void add_positive_tet(TetMesh& mesh, Tet tet) {
  if (signed_volume(mesh.nodes, tet) < 0) std::swap(tet[2], tet[3]);
  mesh.tets.push_back(tet);
}

// Calls f(i, j, l, corners) for every cell of the grid, x fastest; corner bits x = 1, y = 2, z = 4.
template <typename F>
void for_each_cell(const std::array<Index, 3>& cells, F&& f) {
  const auto [nx, ny, nz] = cells;
  for (Index l = 0; l < nz; ++l) {
    for (Index j = 0; j < ny; ++j) {
      for (Index i = 0; i < nx; ++i) {
        std::array<Index, 8> corners;
        for (Index b = 0; b < 8; ++b) {
          const Index x = i + (b & 1), y = j + (b >> 1 & 1), z = l + (b >> 2);
          corners[uz(b)] = (z * (ny + 1) + y) * (nx + 1) + x;
        }
        f(i, j, l, corners);
      }
    }
  }
}

}  // namespace

TetMesh beam(const Vec3& size, const std::array<Index, 3>& cells, double jitter) {
  constexpr int kTets[5][4] = {
      {0, 1, 3, 5}, {0, 3, 2, 6}, {0, 5, 6, 4}, {3, 6, 5, 7}, {0, 3, 6, 5}};
  require_grid("beam", size, cells, jitter, 5);
  TetMesh mesh = grid_nodes({-size.x() / 2, -size.y() / 2, 0}, size, cells);
  mesh.tets.reserve(5 * uz(cells[0]) * uz(cells[1]) * uz(cells[2]));
  for_each_cell(cells, [&](Index i, Index j, Index l, const std::array<Index, 8>& corners) {
    const int mirror = (i + j + l) % 2;  // neighbours mirrored in x, so that their diagonals match
    for (const auto& tet : kTets) {
      Tet nodes;
      for (std::size_t c = 0; c < 4; ++c) nodes[c] = corners[uz(tet[c] ^ mirror)];
      add_positive_tet(mesh, nodes);
    }
  });
  jitter_grid(mesh, cells, cell_size(size, cells), jitter);
  return mesh;
}

TetMesh box(const Vec3& size, const std::array<Index, 3>& cells, double jitter) {
  // A path from corner 0 to corner 7 for every order of the three axes.
  constexpr std::size_t kPaths[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
  require_grid("box", size, cells, jitter, 6);
  TetMesh mesh = grid_nodes(-size / 2, size, cells);
  mesh.tets.reserve(6 * uz(cells[0]) * uz(cells[1]) * uz(cells[2]));
  for_each_cell(cells, [&](Index, Index, Index, const std::array<Index, 8>& c) {
    for (const auto& [a, b] : kPaths) add_positive_tet(mesh, {c[0], c[a], c[b], c[7]});
  });
  jitter_grid(mesh, cells, cell_size(size, cells), jitter);
  return mesh;
}

namespace {

// The icosahedron's 12 unit vertices, its 30 edges and 20 triangles.
struct Icosahedron {
  std::vector<Vec3> vertices;
  std::vector<Triangle> faces;                          // increasing vertex ids
  std::array<std::array<Index, 12>, 12> edge_number{};  // of the edge between two vertices

  Icosahedron() {
    const double s = 1 / std::sqrt(1 + std::numbers::phi * std::numbers::phi);
    for (const double a : {-s, s}) {
      for (const double b : {-s * std::numbers::phi, s * std::numbers::phi}) {
        vertices.insert(vertices.end(), {{0, a, b}, {a, b, 0}, {b, 0, a}});
      }
    }
    // An edge is 2 s long; the next distance is 2 s phi.
    const auto near = [&](Index i, Index j) {
      return (vertices[uz(i)] - vertices[uz(j)]).norm() < 1.3 * 2 * s;
    };
    Index edge_count = 0;
    for (Index a = 0; a < 12; ++a) {
      for (Index b = a + 1; b < 12; ++b) {
        if (!near(a, b)) continue;
        edge_number[uz(a)][uz(b)] = edge_count++;
        for (Index c = b + 1; c < 12; ++c) {
          if (near(a, c) && near(b, c)) faces.push_back({a, b, c});
        }
      }
    }
  }

  // Nodes in the shells below r: shell 0 is the centre, shell r has 10 r^2 + 2 nodes.
  static Index shell_start(Index r) {
    return r == 0 ? 0 : 1 + 2 * (r - 1) + 10 * ((r - 1) * r * (2 * r - 1) / 6);
  }

  // The node of sector `face` with the weights w at its vertices, in shell r = w[0] + w[1] + w[2]:
  // shells from inside out; in a shell the vertices, the edges, then the insides of the triangles.
  Index node(std::size_t face, const std::array<Index, 3>& w) const {
    const Index r = w[0] + w[1] + w[2];
    const Index start = shell_start(r);
    std::array<std::size_t, 3> held;  // the corners with a weight
    std::size_t count = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (w[c] > 0) held[count++] = c;
    }
    if (count == 0) return 0;
    const Triangle& v = faces[face];
    if (count == 1) return start + v[held[0]];
    if (count == 2) {
      const Index edge = edge_number[uz(v[held[0]])][uz(v[held[1]])];
      return start + 12 + edge * (r - 1) + w[held[1]] - 1;
    }
    const Index row = w[1] + w[2] - 2;
    return start + 12 + 30 * (r - 1) + static_cast<Index>(face) * ((r - 1) * (r - 2) / 2) +
           row * (row + 1) / 2 + w[2] - 1;
  }
};

// The unit ball's mesh, scaled. A sector is the set n >= x >= y >= z >= 0 of the integer lattice,
// which Kuhn's subdivision of the lattice cubes fills exactly; its weights at the face's vertices
// are x - y, y - z, z.
TetMesh ball(const Vec3& radii, Index n) {
  const Icosahedron ico;
  TetMesh mesh;
  mesh.nodes.assign(uz(Icosahedron::shell_start(n + 1)), Vec3::Zero());
  mesh.tets.reserve(20 * uz(n) * uz(n) * uz(n));
  for (std::size_t f = 0; f < ico.faces.size(); ++f) {
    const Triangle& v = ico.faces[f];
    const auto node = [&](const std::array<Index, 3>& p) {
      return ico.node(f, {p[0] - p[1], p[1] - p[2], p[2]});
    };
    for (Index x = 1; x <= n; ++x) {
      for (Index y = 0; y <= x; ++y) {
        for (Index z = 0; z <= y; ++z) {
          const Vec3 direction = ((x - y) * ico.vertices[uz(v[0])] +
                                  (y - z) * ico.vertices[uz(v[1])] + z * ico.vertices[uz(v[2])])
                                     .normalized();
          mesh.nodes[uz(node({x, y, z}))] = (direction * x / n).cwiseProduct(radii);
        }
      }
    }
    for (Index x = 0; x < n; ++x) {
      for (Index y = 0; y <= x; ++y) {
        for (Index z = 0; z <= y; ++z) {
          std::array<std::size_t, 3> axes = {0, 1, 2};
          do {
            std::array<Index, 3> p = {x, y, z};
            Tet tet = {node(p)};
            bool inside = true;
            for (std::size_t step = 0; step < 3 && inside; ++step) {
              ++p[axes[step]];
              inside = p[0] >= p[1] && p[1] >= p[2];
              if (inside) tet[step + 1] = node(p);
            }
            if (inside) add_positive_tet(mesh, tet);
          } while (std::next_permutation(axes.begin(), axes.end()));
        }
      }
    }
  }
  return mesh;
}

void require_resolution(const char* shape, Index n, double tets_per_cubed) {
  require_count(shape, "resolution", n);
  require_tets(shape, "resolution", tets_per_cubed * n * n * n);
}

// The icosahedron's triangles, each divided into m^2, their nodes moved out to the unit sphere.
struct UnitSphere {
  std::vector<Vec3> nodes;
  std::vector<Triangle> triangles;
};

UnitSphere unit_sphere(Index m) {
  const Icosahedron ico;
  const Index first = Icosahedron::shell_start(m);
  UnitSphere sphere;
  sphere.nodes.assign(uz(Icosahedron::shell_start(m + 1) - first), Vec3::Zero());
  sphere.triangles.reserve(20 * uz(m) * uz(m));
  for (std::size_t f = 0; f < ico.faces.size(); ++f) {
    const auto node = [&](Index i, Index j) { return ico.node(f, {i, j, m - i - j}) - first; };
    for (Index i = 0; i <= m; ++i) {
      for (Index j = 0; i + j <= m; ++j) {
        Vec3 direction = Vec3::Zero();
        const std::array<Index, 3> weights = {i, j, m - i - j};
        for (std::size_t c = 0; c < 3; ++c)
          direction += weights[c] * ico.vertices[uz(ico.faces[f][c])];
        sphere.nodes[uz(node(i, j))] = direction.normalized();
        if (i + j < m) sphere.triangles.push_back({node(i, j), node(i + 1, j), node(i, j + 1)});
        if (i + j + 2 <= m)
          sphere.triangles.push_back({node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)});
      }
    }
  }
  return sphere;
}

// Three tets in every prism between layers of the same triangles; mesh.nodes holds their nodes
// layer by layer. A prism's sides are divided from the lower node in one layer to the higher node
// in the other, so neighbours match. Layers alternate, so the mesh has no twist.
void fill_layers(TetMesh& mesh, std::vector<Triangle> triangles, Index layer_nodes, Index layers) {
  for (Triangle& t : triangles) std::sort(t.begin(), t.end());
  mesh.tets.reserve(3 * triangles.size() * uz(layers));
  for (Index l = 0; l < layers; ++l) {
    Index from = l * layer_nodes, to = from + layer_nodes;
    if (l % 2 == 1) std::swap(from, to);
    for (const auto& [a, b, c] : triangles) {
      add_positive_tet(mesh, {from + a, from + b, from + c, to + c});
      add_positive_tet(mesh, {from + a, from + b, to + b, to + c});
      add_positive_tet(mesh, {from + a, to + a, to + b, to + c});
    }
  }
}

// Triangles of a disc of n rings: node 0 is the centre, ring r has 6 r nodes.
std::vector<Triangle> disc_triangles(Index n) {
  const auto node = [](Index ring, Index k) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring);
  };
  std::vector<Triangle> triangles;
  triangles.reserve(6 * uz(n) * uz(n));
  for (Index r = 1; r <= n; ++r) {
    for (Index sector = 0; sector < 6; ++sector) {
      const Index inner = sector * (r - 1);
      const Index outer = sector * r;
      for (Index k = 0; k < r; ++k) {
        triangles.push_back({node(r - 1, inner + k), node(r, outer + k), node(r, outer + k + 1)});
        if (k + 1 == r) break;
        triangles.push_back(
            {node(r - 1, inner + k), node(r, outer + k + 1), node(r - 1, inner + k + 1)});
      }
    }
  }
  return triangles;
}

}  // namespace

TetMesh sphere(double radius, Index resolution) {
  require_length("sphere", "radius", radius);
  require_resolution("sphere", resolution, 20);
  return ball(Vec3::Constant(radius), resolution);
}

TetMesh ellipsoid(const Vec3& radii, Index resolution) {
  require_length("ellipsoid", "radii[0]", radii.x());
  require_length("ellipsoid", "radii[1]", radii.y());
  require_length("ellipsoid", "radii[2]", radii.z());
  require_resolution("ellipsoid", resolution, 20);
  return ball(radii, resolution);
}

TetMesh cylinder(double radius, double length, Index resolution) {
  require_length("cylinder", "radius", radius);
  require_length("cylinder", "length", length);
  const double layer_count = std::max(1.0, std::round(length / radius * resolution));
  require_resolution("cylinder", resolution, 18 * layer_count / resolution);

  const Index layers = static_cast<Index>(layer_count);
  const Index disc_nodes = 1 + 3 * resolution * (resolution + 1);
  TetMesh mesh;
  mesh.nodes.reserve(uz(disc_nodes) * (uz(layers) + 1));
  for (Index l = 0; l <= layers; ++l) {
    const double z = l * (length / layers) - length / 2;
    mesh.nodes.emplace_back(0, 0, z);
    for (Index ring = 1; ring <= resolution; ++ring) {
      for (Index k = 0; k < 6 * ring; ++k) {
        const double angle = std::numbers::pi * k / (3 * ring);
        const double r = radius * ring / resolution;
        mesh.nodes.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
      }
    }
  }

  fill_layers(mesh, disc_triangles(resolution), disc_nodes, layers);
  return mesh;
}

TetMesh hollow_sphere(double radius, double inner_radius, Index resolution) {
  require_length("hollow_sphere", "radius", radius);
  require_length("hollow_sphere", "inner_radius", inner_radius);
  if (inner_radius >= radius)
    throw Error(ErrorKind::input,
                fmt::format("hollow_sphere: inner_radius is {}, expected less than the radius {}",
                            inner_radius, radius),
                "the wall lies between the two");
  const double wall = std::log(radius / inner_radius);
  const double cuts = std::max(1.0, std::round(0.95 * resolution / wall));
  require_resolution("hollow_sphere", resolution, 60 * cuts * cuts / resolution / resolution);

  const UnitSphere sphere = unit_sphere(static_cast<Index>(cuts));
  TetMesh mesh;
  mesh.nodes.reserve(sphere.nodes.size() * (uz(resolution) + 1));
  for (Index shell = 0; shell <= resolution; ++shell) {
    const double r =
        shell == resolution ? radius : inner_radius * std::exp(wall * shell / resolution);
    for (const Vec3& direction : sphere.nodes) mesh.nodes.push_back(r * direction);
  }
  const auto layer_nodes = static_cast<Index>(sphere.nodes.size());
  fill_layers(mesh, sphere.triangles, layer_nodes, resolution);
  for (const int label : {1, 2}) {
    const Index first = label == 1 ? resolution * layer_nodes : 0;
    for (const Triangle& t : sphere.triangles)
      mesh.faces.push_back({first + t[0], first + t[1], first + t[2]});
    mesh.face_label.resize(mesh.faces.size(), label);
  }
  return mesh;
}

}  // namespace sinew
