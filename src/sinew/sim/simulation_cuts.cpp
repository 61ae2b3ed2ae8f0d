// The cuts of the public Simulation.
#include <sinew/simulation.h>

#include "sinew/sim/mover.h"
#include "sinew/sim/world.h"

namespace sinew {

namespace {

CutReport report_of(const sim::CutResult& r) {
  return {r.opened,
          r.area,
          r.new_nodes,
          r.new_tets,
          r.parts_before,
          r.parts,
          r.smallest_angle_before,
          r.smallest_angle,
          r.stable_step_before,
          r.stable_step,
          r.elastic_before,
          r.elastic};
}

}  // namespace

CutReport Simulation::cut(const CutDescription& description) {
  return report_of(any_world().cut(description));
}
BladeHandle Simulation::add_blade(std::string_view body) {
  return any_world().add_blade(body);
}
CutReport Simulation::move(BladeHandle handle, const Point& heel, const Point& tip) {
  return report_of(any_world().move(handle, sim::vec(heel), sim::vec(tip)));
}
void Simulation::lift(BladeHandle handle) {
  any_world().lift(handle);
}
void Simulation::remove(BladeHandle handle) {
  any_world().remove(handle);
}
void Simulation::undo() {
  any_world().undo();
}
void Simulation::redo() {
  any_world().redo();
}
bool Simulation::can_undo() const {
  return world().can_undo();
}
bool Simulation::can_redo() const {
  return world().can_redo();
}
std::int64_t Simulation::topology() const {
  return world().topology();
}

}  // namespace sinew
