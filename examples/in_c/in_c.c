/* A ball is pressed into a slab, in C99: the force on the ball, and where the slab is deepest. */
#include <sinew/sinew.h>
#include <stdio.h>

static const char scene[] =
    "gravity = [0, 0, 0]\n"
    "[body.slab]\n"
    "shape = \"box\"\n"
    "size = [0.1, 0.02, 0.1]\n"
    "cells = [8, 2, 8]\n"
    "young = 5e3\n"
    "[pin.bottom]\n"
    "select = { side = \"-y\" }\n"
    "[obstacle.ball]\n"
    "shape = \"sphere\"\n"
    "center = [0, 0.031, 0]\n"
    "radius = 0.02\n";

static int failed(const char* what) {
  fprintf(stderr, "%s: %s\n", what, sinew_error());
  return 1;
}

int main(void) {
  const char* set[] = {"body.slab.poisson=0.45"};
  sinew_simulation* s = NULL;
  if (sinew_open_text(scene, NULL, set, 1, 0, &s) != SINEW_OK) return failed("the scene");
  sinew_obstacle ball;
  if (sinew_find_obstacle(s, "ball", &ball) != SINEW_OK) return failed("the ball");
  for (int ms = 0; ms < 50; ++ms) {
    const double center[3] = {0.0, 0.031 - 1e-4 * ms, 0.0};
    if (sinew_move_obstacle(s, ball, center, NULL) != SINEW_OK ||
        sinew_advance(s, 1e-3, NULL) != SINEW_OK)
      return failed("a step");
  }
  sinew_wrench w;
  if (sinew_obstacle_wrench(s, ball, &w) != SINEW_OK) return failed("the force");

  const sinew_array x = sinew_positions(s), rest = sinew_rest_positions(s);
  double deepest = 0.0;
  for (size_t i = 0; i < x.count; ++i) {
    const double* now = (const double*)((const char*)x.data + i * x.stride);
    const double* before = (const double*)((const char*)rest.data + i * rest.stride);
    if (now[1] - before[1] < deepest) deepest = now[1] - before[1];
  }
  printf("%.3f s: %.4f N on the ball, the slab %.2f mm deep\n", sinew_time(s), w.force[1],
         -1e3 * deepest);
  sinew_close(s);
  return 0;
}
