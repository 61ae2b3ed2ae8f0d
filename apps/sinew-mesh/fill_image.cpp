// SPDX-License-Identifier: GPL-3.0-or-later
#include "quiet_cgal.h"  // first

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Random.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "labels.h"
#include "mesh3.h"

namespace sinew::mesher {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;

}  // namespace

TetMesh fill_image(const io::LabelImage& source, Target target, Progress& progress) {
  progress.phase("looking at the labels");
  CGAL::get_default_random() = CGAL::Random(0);  // the same mesh every time
  CGAL::Random random(0);

  // The mesh is made in a frame along the image's axes, about its middle, with an extent near 1.
  const Vec3 spacing = source.axes.colwise().norm();
  const Vec3 count(source.size[0], source.size[1], source.size[2]);
  const double unit = std::exp2(std::round(std::log2(count.cwiseProduct(spacing).norm())));
  const Vec3 step = spacing / unit;
  const Vec3 middle = 0.5 * (count - Vec3::Ones());
  target.size /= unit;
  target.distance /= unit;

  io::LabelImage image = source;
  const double tet = std::pow(target.size, 3) / (6 * std::sqrt(2.0));
  const auto least = static_cast<std::int64_t>(std::min(1e15, std::floor(tet / step.prod())));
  std::int64_t dropped = 0;
  const std::vector<Blob> blobs = find_blobs(image, least, dropped);
  if (blobs.empty()) {
    throw Error(ErrorKind::input,
                dropped > 0
                    ? fmt::format("has no part as large as one tetrahedron of this size; {} "
                                  "are smaller",
                                  dropped)
                    : std::string("has no voxel with a label other than 0"),
                dropped > 0 ? "take a smaller --size" : "check that this is the image of labels");
  }
  const LabelField field(image);
  const auto label_at = [&](const Vec3& p) {
    const Vec3 v = p.cwiseQuotient(step) + middle;
    return field.at(v.x(), v.y(), v.z());
  };
  const auto function = [&](const Point& p) { return label_at(Vec3(p.x(), p.y(), p.z())); };
  const Vec3 half = (middle + Vec3::Constant(1.5)).cwiseProduct(step);
  const CGAL::Bbox_3 box(-half.x(), -half.y(), -half.z(), half.x(), half.y(), half.z());
  const std::function<int(const Point&)> labels = function;
  const std::function<bool(int)> is_outside = [](int label) { return label == 0; };
  const Domain domain(labels, box, 1e-3 * step.minCoeff() / (2 * half).norm(), is_outside, &random);

  // Points on the border of every blob, so that none is missed.
  std::vector<std::pair<Point, Domain::Index>> start;
  for (const Blob& blob : blobs) {
    for (const auto& pair : blob.border) {
      const auto place = [&](const std::array<Index, 3>& v) -> Vec3 {
        return (Vec3(v[0], v[1], v[2]) - middle).cwiseProduct(step);
      };
      Vec3 in = place(pair[0]), out = place(pair[1]);
      const int label = image.labels[blob.label];
      if (label_at(out) == label) continue;
      int other = label_at(out);
      for (int i = 0; i < 20; ++i) {
        const Vec3 mid = 0.5 * (in + out);
        const int found = label_at(mid);
        if (found == label) {
          in = mid;
        } else {
          out = mid;
          other = found;
        }
      }
      const Vec3 p = 0.5 * (in + out);
      const auto patch = std::make_pair(std::min(label, other), std::max(label, other));
      start.emplace_back(Point(p.x(), p.y(), p.z()), domain.index_from_surface_patch_index(patch));
    }
  }

  const auto label_of = [](const auto& c3t3, const auto& facet) {
    const auto outside = c3t3.triangulation().mirror_facet(facet).first;
    return c3t3.is_in_complex(outside) ? 0 : static_cast<int>(c3t3.subdomain_index(facet.first));
  };
  TetMesh mesh =
      fill<Domain, CGAL::Default, CGAL::Default>(domain, start, target, label_of, progress);
  // Transforms back into the image's own frame, which may be mirrored.
  const Mat3 turn = source.axes * spacing.cwiseInverse().asDiagonal();
  const Vec3 centre = source.origin + source.axes * middle;
  for (Vec3& x : mesh.nodes) x = turn * (unit * x) + centre;
  if (turn.determinant() < 0) {
    for (Tet& t : mesh.tets) std::swap(t[2], t[3]);
    for (Triangle& t : mesh.faces) std::swap(t[1], t[2]);
  }
  return mesh;
}

}  // namespace sinew::mesher
