// The scalpel of a session, and what follows from cuts.
#include <fmt/format.h>

#include <cmath>

#include "sinew/base/error.h"
#include "sinew/live/session.h"

namespace sinew::live {
namespace {

void require_edge(const Vec3& heel, const Vec3& tip) {
  for (const Vec3& p : {heel, tip})
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > 1e6)
      throw Error(ErrorKind::usage, "an end of the blade is not within 1e6 m",
                  "give x, y, z in metres");
}

}  // namespace

void Session::execute(const MoveBlade& c) {
  require_edge(c.heel, c.tip);
  if (other_)
    throw Error(ErrorKind::usage, "two bodies are compared, and only one would be cut",
                "end the comparison, then cut");
  if (c.node) {
    if (*c.node < 0 || uz(*c.node) >= topology_->node.size())
      throw Error(ErrorKind::usage, "no such node of the surface",
                  fmt::format("from 0 to {}", topology_->node.size() - 1));
    lift_blade();
    const Index node = topology_->node[uz(*c.node)];
    for (const Body& body : model().bodies)
      if (body.nodes.contains(node)) blade_ = world().add_blade(body.name);
  }
  if (blade_) world().move(*blade_, c.heel, c.tip);
}

void Session::execute(const LiftBlade&) {
  lift_blade();
}

void Session::lift_blade() {
  if (blade_) world().remove(*blade_);
  blade_.reset();
}

void Session::execute(const Undo&) {
  lift_blade();
  world().undo();
  changed();
}

void Session::execute(const Redo&) {
  lift_blade();
  world().redo();
  changed();
}

// Shows the surface of a body that was cut. A compared body may have other nodes from then on.
void Session::follow_cuts() {
  if (shown_ == world().topology()) return;
  show(cut_, springs_);
  if (!other_ || other_->model().tets == model().tets) return;
  execute(SetCompare{});
  report(Error(ErrorKind::usage, "the body was cut, and the compared one has other nodes now",
               "compare it again after a reset"));
}

}  // namespace sinew::live
