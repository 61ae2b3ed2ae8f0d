// Cost of Bullet's soft body on the same beams, for `sinew bench --peer`: the mesh's edges as links
// of a btSoftBody, the nodes at the wall fixed, under gravity; in one thread and single precision,
// as Debian builds the library. Collisions are off. Two rows a mesh:
//
//   bullet links   btSoftBody::PSolve_Links: one iteration of its position solver over all links
//   bullet step    predictMotion, solveConstraints and integrateMotion with the default one
//                  iteration: what btSoftRigidDynamicsWorld does in a step, less collisions
//
// Prints the JSON of `sinew bench`.
#include <BulletSoftBody/btSoftBody.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "sinew/mesh/edges.h"
#include "sinew/mesh/shapes.h"
#include "sinew/study/bench.h"

namespace {

using namespace sinew;

constexpr double density = 1060.0;        // [kg/m3]
constexpr btScalar step = 1.0f / 240.0f;  // [s]
constexpr int steps_before = 20;

// W(k) as Bullet's body; `info` must outlive it.
std::unique_ptr<btSoftBody> soft_body(const TetMesh& mesh, const std::vector<Edge>& edges,
                                      btSoftBodyWorldInfo& info) {
  std::vector<btVector3> x;
  for (const Vec3& p : mesh.nodes) {
    x.emplace_back(static_cast<btScalar>(p.x()), static_cast<btScalar>(p.y()),
                   static_cast<btScalar>(p.z()));
  }
  std::vector<double> mass(mesh.nodes.size(), 0.0);
  for (const Tet& tet : mesh.tets) {
    for (const Index i : tet) mass[uz(i)] += 0.25 * density * signed_volume(mesh.nodes, tet);
  }
  std::vector<btScalar> m;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    m.push_back(mesh.nodes[i].z() < 1e-9 ? 0.0f : static_cast<btScalar>(mass[i]));  // 0: fixed
  }
  auto body = std::make_unique<btSoftBody>(&info, static_cast<int>(x.size()), x.data(), m.data());
  for (const Edge& e : edges) body->appendLink(e[0], e[1]);
  body->m_cfg.collisions = 0;
  return body;
}

void advance(btSoftBody& body) {
  body.predictMotion(step);
  body.solveConstraints();
  body.integrateMotion();
}

void measure_mesh(int k, const study::TimerOptions& options, std::vector<study::BenchRow>& rows) {
  const TetMesh mesh = beam(Vec3(0.1, 0.1, 0.4), {k, k, 4 * k});
  const auto edges = build_edges(mesh.tets, static_cast<Index>(mesh.nodes.size())).edges;
  btSoftBodyWorldInfo info;
  info.m_gravity = btVector3(0.0f, -9.81f, 0.0f);
  // Every repetition starts from the same state, because the cost of a step changes as the body
  // falls.
  std::unique_ptr<btSoftBody> body;
  const auto begin = [&] {
    body = soft_body(mesh, edges, info);
    for (int i = 0; i < steps_before; ++i) advance(*body);
  };
  study::TimerOptions few = options;
  few.most_in_batch = steps_before;

  study::BenchRow row;
  row.mesh = fmt::format("W({})", k);
  row.precision = "single";
  row.nodes = static_cast<Index>(mesh.nodes.size());
  row.tets = static_cast<Index>(mesh.tets.size());
  row.springs = static_cast<Index>(edges.size());
  row.unit = "link";
  row.items = row.springs;
  const auto add = [&](const char* kernel, const std::function<void()>& call) {
    row.kernel = kernel;
    row.time = *study::measure(few, begin, call);
    rows.push_back(row);
  };
  add("bullet links", [&] { btSoftBody::PSolve_Links(body.get(), 1.0f, 0.0f); });
  row.steps = 1;
  add("bullet step", [&] { advance(*body); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures Bullet's soft body on the beams of sinew bench; prints JSON."};
  std::vector<int> meshes = {4, 8, 17};
  sinew::study::TimerOptions options;
  app.add_option("--meshes", meshes, "k of the beams W(k)")
      ->delimiter(',')
      ->check(CLI::Range(1, 60))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "Seconds a measurement goes on for")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  sinew::study::BenchResult result;
  for (const int k : meshes) measure_mesh(k, options, result.rows);
  nlohmann::ordered_json json = sinew::study::to_json(result);
  json.erase("machine");
  json.erase("limits");
  json["peer"] = fmt::format("Bullet {}.{:02d}", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100);
  fmt::print("{}\n", json.dump(2));
}
