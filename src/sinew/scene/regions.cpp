#include "sinew/scene/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "sinew/scene/select.h"

namespace sinew {

namespace {

// Where the labels come from, and what else the file offers.
std::string label_source(const io::ReadNotes& notes) {
  std::string text;
  if (!notes.tet_labels.empty()) text += fmt::format(" (from the file's {})", notes.tet_labels);
  const std::string others = io::unused_cell_arrays(notes);
  if (!others.empty())
    text += fmt::format(
        "; arrays of whole numbers that are not used: {}; labels = \"NAME\" takes one", others);
  return text;
}

std::string name_of(const PlacedBody& placed, const SceneRegion& region) {
  return fmt::format("[body.{}.region.{}]", placed.body->name, region.name);
}

[[noreturn]] void refuse_label(const PlacedBody& placed, const SceneRegion& region, int label,
                               const std::set<int>& known) {
  std::string list;
  for (const int l : known) list += (list.empty() ? "" : ", ") + std::to_string(l);
  throw Error(ErrorKind::input,
              fmt::format("{} covers label {}, which the mesh does not have",
                          name_of(placed, region), label),
              "its tets have the labels: " + list + label_source(placed.notes), region.where);
}

void by_labels(const PlacedBody& placed, std::vector<int>& of_tet) {
  const TetMesh& mesh = placed.mesh;
  std::set<int> known(mesh.tet_label.begin(), mesh.tet_label.end());
  if (mesh.tet_label.empty()) known = {0};
  std::map<int, int> region_of;
  for (std::size_t r = 0; r < placed.body->regions.size(); ++r)
    for (const int label : placed.body->regions[r].labels) {
      if (known.count(label) == 0) refuse_label(placed, placed.body->regions[r], label, known);
      region_of[label] = static_cast<int>(r);
    }
  for (std::size_t t = 0; t < of_tet.size(); ++t) {
    const auto found = region_of.find(mesh.tet_label.empty() ? 0 : mesh.tet_label[t]);
    if (found != region_of.end()) of_tet[t] = found->second;
  }
}

void by_place(const PlacedBody& placed, int number, std::vector<int>& of_tet) {
  const TetMesh& mesh = placed.mesh;
  const SceneRegion& region = placed.body->regions[static_cast<std::size_t>(number)];
  bool found = false;
  for (std::size_t t = 0; t < of_tet.size(); ++t) {
    Vec3 centroid = Vec3::Zero();
    for (const Index corner : mesh.tets[t])
      centroid += mesh.nodes[static_cast<std::size_t>(corner)] / 4.0;
    if (!in_places(*region.select, centroid, 1e-9 * placed.diagonal())) continue;
    found = true;
    if (of_tet[t] >= 0)
      throw Error(
          ErrorKind::input,
          fmt::format("tet {} of body '{}', at ({:.4g}, {:.4g}, {:.4g}) m, is in region "
                      "'{}' and in region '{}'",
                      t, placed.body->name, centroid.x(), centroid.y(), centroid.z(),
                      placed.body->regions[static_cast<std::size_t>(of_tet[t])].name, region.name),
          "a tet belongs to one region; make their places or labels apart", region.where);
    of_tet[t] = number;
  }
  if (found) return;
  const Vec3 &a = placed.low, &b = placed.high;
  throw Error(ErrorKind::input,
              fmt::format("'select' of {} holds no tet's centroid; the body reaches from ({:.4g}, "
                          "{:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m",
                          name_of(placed, region), a.x(), a.y(), a.z(), b.x(), b.y(), b.z()),
              "places are in the world at the start, in metres; a place smaller than a tet needs "
              "a finer mesh",
              region.where);
}

}  // namespace

std::vector<int> regions_of_tets(const PlacedBody& placed) {
  std::vector<int> of_tet(placed.mesh.tets.size(), -1);
  by_labels(placed, of_tet);
  for (std::size_t r = 0; r < placed.body->regions.size(); ++r)
    if (placed.body->regions[r].select) by_place(placed, static_cast<int>(r), of_tet);
  return of_tet;
}

}  // namespace sinew
