#include "sinew/model/obstacle.h"

namespace sinew {

Pose obstacle_pose(const Obstacle& obstacle, double time) {
  return {obstacle.path.at(time, obstacle.center),
          obstacle.path.rotation(time) * obstacle.rotation};
}

}  // namespace sinew
