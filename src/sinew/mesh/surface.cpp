#include "sinew/mesh/surface.h"

#include "sinew/mesh/faces.h"
#include "sinew/mesh/node_sets.h"

namespace sinew {
namespace {

template <typename Element>
Components components_of(std::span<const Element> elements, Index node_count) {
  NodeSets sets(node_count);
  for (const Element& element : elements) {
    for (const Index node : element) sets.join(element[0], node);
  }
  Components result;
  result.of.reserve(elements.size());
  std::vector<Index> number(uz(node_count), -1);  // of the component, at its root node
  for (const Element& element : elements) {
    Index& id = number[uz(sets.root(element[0]))];
    if (id < 0) id = result.count++;
    result.of.push_back(id);
  }
  return result;
}

}  // namespace

Surface build_surface(std::span<const Tet> tets, Index node_count) {
  const FaceTable table = build_faces(tets, node_count);
  Surface surface;
  for (Index f = 0; f < table.face_count(); ++f) {
    const auto sides = table.sides_of(f);
    if (sides.size() != 1) continue;
    surface.triangles.push_back(outward_face(tets, sides[0]));
    surface.tets.push_back(sides[0] / 4);
  }
  return surface;
}

Components connected_components(std::span<const Tet> tets, Index node_count) {
  return components_of(tets, node_count);
}

Components connected_components(std::span<const Triangle> triangles, Index node_count) {
  return components_of(triangles, node_count);
}

double surface_area(std::span<const Vec3> nodes, std::span<const Triangle> triangles) {
  double area = 0;
  for (const Triangle& t : triangles) {
    const Vec3& origin = nodes[uz(t[0])];
    area += (nodes[uz(t[1])] - origin).cross(nodes[uz(t[2])] - origin).norm() / 2;
  }
  return area;
}

}  // namespace sinew
