// A mesh that the program makes itself: a bar of two materials, told apart by the tets' labels.
#include <sinew/sinew.h>

#include <array>
#include <cstdio>

namespace {

constexpr int kAcross = 2, kAlong = 12;
constexpr double kEdge = 0.01;  // of a cube [m]

sinew::Index node_at(int i, int j, int k) {
  return (k * (kAcross + 1) + j) * (kAcross + 1) + i;
}

// Six tets around the diagonal of each cube. Label 1 in the half at z = 0, 2 in the other.
sinew::MeshArrays two_part_bar() {
  sinew::MeshArrays mesh;
  for (int k = 0; k <= kAlong; ++k)
    for (int j = 0; j <= kAcross; ++j)
      for (int i = 0; i <= kAcross; ++i) mesh.nodes.push_back({kEdge * i, kEdge * j, kEdge * k});
  constexpr std::array<std::array<int, 2>, 6> ways = {
      {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}};
  for (int k = 0; k < kAlong; ++k)
    for (int j = 0; j < kAcross; ++j)
      for (int i = 0; i < kAcross; ++i) {
        const auto corner = [&](int bits) {
          return node_at(i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2 & 1));
        };
        for (const std::array<int, 2>& way : ways) {
          mesh.tets.push_back({corner(0), corner(way[0]), corner(way[1]), corner(7)});
          mesh.tet_labels.push_back(k < kAlong / 2 ? 1 : 2);
        }
      }
  return mesh;
}

}  // namespace

int main() {
  try {
    sinew::SceneBuilder scene;
    scene.set_stepping({.stepper = "static"});  // the shape at rest, not the way there
    scene.add_body({.name = "bar",
                    .arrays = two_part_bar(),
                    .regions = {{.name = "stiff", .labels = {1}, .material = {.young = 400e3}},
                                {.name = "soft", .labels = {2}, .material = {.young = 100e3}}}});
    scene.add_pin({.name = "wall", .select = {.side = "-z"}});

    sinew::Simulation simulation(scene);
    const sinew::BodyInfo& bar = simulation.bodies().front();
    std::printf("%d nodes, %d tets, %.1f cm3, %.1f g\n", bar.nodes.count, bar.tets.count,
                1e6 * bar.rest_volume, 1e3 * bar.mass);
    simulation.step();
    for (int k = 0; k <= kAlong; k += 3) {
      const auto n = static_cast<std::size_t>(node_at(0, 0, k));
      const double sag = simulation.positions()[n][1] - simulation.rest_positions()[n][1];
      std::printf("at %2.0f mm: %7.3f mm\n", 1e3 * kEdge * k, 1e3 * sag);
    }
  } catch (const sinew::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
