#include "sinew/scene/select.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "sinew/mesh/surface.h"

namespace sinew {

namespace {

class Selector {
 public:
  Selector(const PlacedBody& placed, const Selection& select, const std::string& what)
      : placed_(placed), mesh_(placed.mesh), select_(select), what_(what) {}

  std::vector<Index> run() {
    chosen_.assign(mesh_.nodes.size(), true);
    tolerance_ = 1e-9 * placed_.diagonal();
    by_labels();
    by_places();
    if (!select_.nodes.empty()) by_ids();
    if (select_.surface) by_surface();
    if (select_.nearest) by_nearest(*select_.nearest);
    std::vector<Index> nodes;
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      if (chosen_[i]) nodes.push_back(static_cast<Index>(i));
    if (nodes.empty()) refuse_empty();
    return nodes;
  }

 private:
  template <typename Predicate>
  void keep(Predicate inside) {
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      chosen_[i] = chosen_[i] && inside(mesh_.nodes[i]);
  }

  void keep_listed(const std::vector<bool>& listed) {
    for (std::size_t i = 0; i < chosen_.size(); ++i) chosen_[i] = chosen_[i] && listed[i];
  }

  // Keeps the corners of the cells with this label.
  template <typename Cell>
  void keep_corners(const std::vector<Cell>& cells, const std::vector<int>& labels, int label,
                    std::string_view key) {
    std::vector<bool> listed(chosen_.size(), false);
    bool found = false;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if ((labels.empty() ? 0 : labels[c]) != label) continue;
      found = true;
      for (const Index corner : cells[c]) listed[static_cast<std::size_t>(corner)] = true;
    }
    if (!found) refuse_label(key, label, cells.empty() ? std::vector<int>{} : labels);
    keep_listed(listed);
  }

  void by_labels() {
    if (select_.label)
      keep_corners(
          mesh_.tets,
          mesh_.tet_label.empty() ? std::vector<int>(mesh_.tets.size(), 0) : mesh_.tet_label,
          *select_.label, "label");
    if (select_.face_label)
      keep_corners(mesh_.faces, mesh_.face_label, *select_.face_label, "face_label");
    if (select_.node_label) {
      std::vector<bool> listed(chosen_.size(), false);
      for (std::size_t i = 0; i < mesh_.node_label.size(); ++i)
        listed[i] = mesh_.node_label[i] == *select_.node_label;
      if (std::find(listed.begin(), listed.end(), true) == listed.end())
        refuse_label("node_label", *select_.node_label, mesh_.node_label);
      keep_listed(listed);
    }
  }

  void by_places() {
    keep([&](const Vec3& x) { return in_places(select_, x, tolerance_); });
    if (const auto& side = select_.side) {
      const double depth = side->depth.value_or(1e-6 * placed_.diagonal()) + tolerance_;
      const double edge = side->upper ? placed_.high[side->axis] : placed_.low[side->axis];
      keep([&](const Vec3& x) { return std::abs(x[side->axis] - edge) <= depth; });
    }
  }

  void by_ids() {
    std::vector<bool> listed(chosen_.size(), false);
    for (const Index id : select_.nodes) {
      const auto i = static_cast<std::size_t>(id);
      if (i >= placed_.node_of_file.size())
        throw Error(ErrorKind::input,
                    fmt::format("{} names node {}; the mesh of body '{}' has nodes 0 to {}", what_,
                                id, placed_.body->name, placed_.node_of_file.size() - 1),
                    "ids count from 0, in the order of the mesh file", select_.where);
      if (placed_.node_of_file[i] < 0)
        throw Error(ErrorKind::input,
                    fmt::format("{} names node {} of body '{}', which no tet has", what_, id,
                                placed_.body->name),
                    "name a node of a tet", select_.where);
      listed[static_cast<std::size_t>(placed_.node_of_file[i])] = true;
    }
    keep_listed(listed);
  }

  void by_surface() {
    std::vector<bool> listed(chosen_.size(), false);
    for (const Triangle& t : build_surface(mesh_.tets, mesh_.node_count()).triangles)
      for (const Index corner : t) listed[static_cast<std::size_t>(corner)] = true;
    keep_listed(listed);
  }

  // Of equals the lowest id.
  void by_nearest(const Vec3& point) {
    std::size_t best = chosen_.size();
    double best_distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      const double distance = (mesh_.nodes[i] - point).squaredNorm();
      if (!chosen_[i] || distance >= best_distance) continue;
      best = i;
      best_distance = distance;
    }
    for (std::size_t i = 0; i < chosen_.size(); ++i) chosen_[i] = i == best;
  }

  [[noreturn]] void refuse_label(std::string_view key, int label,
                                 const std::vector<int>& labels) const {
    const std::set<int> known(labels.begin(), labels.end());
    std::string list;
    for (const int l : known) {
      if (list.size() > 60) {
        list += ", ...";
        break;
      }
      list += (list.empty() ? "" : ", ") + std::to_string(l);
    }
    throw Error(ErrorKind::input,
                fmt::format("{} wants {} = {}, which body '{}' does not have", what_, key, label,
                            placed_.body->name),
                known.empty() ? fmt::format("its mesh has no {}", key)
                              : fmt::format("its mesh has {} {}", key, list),
                select_.where);
  }

  [[noreturn]] void refuse_empty() const {
    const Vec3& a = placed_.low;
    const Vec3& b = placed_.high;
    throw Error(ErrorKind::input,
                fmt::format("{} selects no node of body '{}', which reaches from ({:.4g}, {:.4g}, "
                            "{:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m",
                            what_, placed_.body->name, a.x(), a.y(), a.z(), b.x(), b.y(), b.z()),
                "places are in the world at the start, in metres, and a node has to meet every "
                "condition",
                select_.where);
  }

  const PlacedBody& placed_;
  const TetMesh& mesh_;
  const Selection& select_;
  const std::string& what_;
  std::vector<bool> chosen_;  // (nodes)
  double tolerance_ = 0.0;    // [m]
};

}  // namespace

bool in_places(const Selection& select, const Vec3& x, double tolerance) {
  if (const auto& box = select.box; box && ((x.array() < box->min.array() - tolerance).any() ||
                                            (x.array() > box->max.array() + tolerance).any()))
    return false;
  if (const auto& sphere = select.sphere;
      sphere && (x - sphere->center).norm() > sphere->radius + tolerance)
    return false;
  const auto& half = select.half_space;
  return !half || half->normal.dot(x - half->point) >= -tolerance;
}

std::vector<Index> select_nodes(const PlacedBody& body, const Selection& select,
                                const std::string& what) {
  return Selector(body, select, what).run();
}

}  // namespace sinew
