// Forceps: two jaws that hold tissue by friction. docs/methods/grasping.md.
#ifndef SINEW_FORCEPS_H
#define SINEW_FORCEPS_H

#include <sinew/export.h>
#include <sinew/simulation.h>
#include <sinew/types.h>

#include <initializer_list>
#include <string>

namespace sinew {

// In the frame of the forceps, x leads along the jaws to their tips, and the jaws close along y.
// The origin lies between the tips, in the middle of the jaws' width.
struct ForcepsDescription {
  std::string name = "forceps";  // its obstacles are NAME-upper (y > 0) and NAME-lower
  double length = 0.02;          // of the jaws [m]
  double width = 0.008;          // along z [m]
  double thickness = 0.004;      // along y [m]
  double opening = 0.02;         // between the jaws at the start, and the most [m]
  double friction = 0.6;         // Coulomb's, of the jaws
  double speed = 0.1;            // the most at which the opening changes [m/s]
  RigidPose pose = {};           // at the start
};

// Two jaws, hard obstacles of a Simulation, that stay parallel. They close to an opening, whatever
// it takes, or until the tissue between them resists with a force. Their mass is left out: under a
// force the opening changes at a speed that is in proportion to what is missing of it.
//
// Not thread-safe; the Simulation must outlive it. The state of the grip (opening, force) is not
// part of Simulation::save(): a host that restores a state sets them again.
class SINEW_API Forceps {
 public:
  // Adds the jaws to the simulation. Error(usage) for sizes that are not above 0, a negative
  // friction, or a name that the scene has already.
  Forceps(Simulation& simulation, const ForcepsDescription& description);

  // The pose at the end of the next advance(); as Simulation::move().
  void move(const RigidPose& pose);
  // The jaws go to this opening [m], from 0 to the one of the description.
  void open_to(double opening);
  // The jaws close until each presses with this force [N] > 0.
  void close_with(double force);

  const RigidPose& pose() const { return pose_; }
  double opening() const { return opening_; }  // between the jaws [m]
  double grip() const { return grip_; }        // mean force of the jaws along y [N]
  // The force of the bodies on both jaws, and the torque about the origin: what the hand feels.
  Wrench wrench() const;
  ObstacleHandle upper() const { return upper_; }
  ObstacleHandle lower() const { return lower_; }

 private:
  friend SINEW_API bool advance(Simulation&, std::initializer_list<Forceps*>, double);
  void begin(double share, double dt);
  void end();
  RigidPose jaw(double side) const;

  Simulation* simulation_;
  ForcepsDescription description_;
  ObstacleHandle upper_, lower_;
  RigidPose pose_, goal_, from_;
  double opening_, goal_opening_;  // [m]
  double force_ = 0.0;             // wanted [N]; 0: by opening
  double grip_ = 0.0, last_grip_ = 0.0, last_opening_;
  double stiffness_ = 200.0;  // of what is between the jaws, as it was felt [N/m]
};

// Advances the simulation by `seconds` and the forceps with it, in steps of at most 1 ms: the time
// in which a grip answers. Returns false if it was interrupted, as Simulation::advance().
SINEW_API bool advance(Simulation& simulation, std::initializer_list<Forceps*> forceps,
                       double seconds);

}  // namespace sinew

#endif
