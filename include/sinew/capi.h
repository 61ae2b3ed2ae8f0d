/* Sinew for C99, and for every language that calls C.
 *
 *   sinew_simulation* s = NULL;
 *   if (sinew_open_file("liver.toml", NULL, 0, 0, &s) != SINEW_OK) {
 *     fprintf(stderr, "%s\n", sinew_error());
 *     return 1;
 *   }
 *   sinew_advance(s, 0.1, NULL);
 *   sinew_array x = sinew_positions(s);
 *   sinew_close(s);
 *
 * Errors. A function that returns a sinew_status returns SINEW_OK, or the kind of what is wrong:
 * then nothing is changed and sinew_error() has the text. After SINEW_DIVERGED the simulation is at
 * an earlier frame. A null pointer or a handle of another simulation is SINEW_USAGE. Functions that
 * return a value return 0 or an empty array for a null simulation. Nothing is printed, nothing is
 * thrown.
 *
 * Threads. One thread at a time uses a simulation, several simulations may be used at once. Two
 * functions are free of this: sinew_interrupt(), from any thread, and sinew_latest(), from one
 * other thread.
 *
 * Arrays are in SI units. Their memory belongs to the simulation and is valid until its next call
 * that takes a pointer without const.
 *
 * What the functions do in detail is in sinew/simulation.h, for the C++ functions of these names.
 */
#ifndef SINEW_CAPI_H
#define SINEW_CAPI_H

#include <sinew/export.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum sinew_status {
  SINEW_OK = 0,
  SINEW_INTERNAL = 1, /* a fault of Sinew */
  SINEW_USAGE = 2,    /* a wrong call */
  SINEW_INPUT = 3,    /* a scene, a mesh or a value that cannot be used */
  SINEW_UNSTABLE = 4, /* a step longer than the stable one */
  SINEW_DIVERGED = 5, /* the state became infinite, or there is no rest state */
  SINEW_IO = 6        /* a file that cannot be read or written */
} sinew_status;

typedef struct sinew_simulation sinew_simulation;

/* Names an object of one simulation; {0, 0} names nothing. */
typedef struct sinew_obstacle {
  uint64_t simulation, id;
} sinew_obstacle;
typedef struct sinew_pin {
  uint64_t simulation, id;
} sinew_pin;
typedef struct sinew_grab {
  uint64_t simulation, id;
} sinew_grab;

typedef struct sinew_blade {
  uint64_t simulation, id;
} sinew_blade;

/* What a cut did; nothing changed if opened is 0. */
typedef struct sinew_cut_report {
  int32_t opened; /* faces */
  int32_t new_nodes, new_tets;
  int32_t parts_before, parts; /* connected pieces of all bodies */
  double area;                 /* of one side, at rest [m2] */
} sinew_cut_report;

/* `count` rows of `components` numbers, `stride` bytes from row to row; data is NULL if empty. */
typedef struct sinew_array {
  const void* data;
  size_t count, components, stride;
} sinew_array;

typedef struct sinew_wrench {
  double force[3];  /* [N] */
  double torque[3]; /* [N m] */
} sinew_wrench;

/* A finished state, for another thread: see sinew_latest(). */
typedef struct sinew_frame {
  uint64_t number; /* counts from 1 */
  double time;     /* [s] */
  size_t nodes;
  const double* positions;  /* [m] (3 nodes) */
  const double* velocities; /* [m/s] (3 nodes) */
} sinew_frame;

/* "0.2.0" */
SINEW_API const char* sinew_version(void);
/* The text of the last error on this thread: "file:line:column: message\n  remedy: ...". Valid
 * until the next call of this thread that fails. */
SINEW_API const char* sinew_error(void);

/* ---- opening and closing ----
 * set: set_count overrides like those of --set, "liver.young=5e3"; may be NULL.
 * threads: from 1 to 1024; 0: all of the machine. */
SINEW_API sinew_status sinew_open_file(const char* path, const char* const* set, size_t set_count,
                                       int threads, sinew_simulation** out);
/* toml: the text of a scene; base: the folder where relative paths start, NULL: the current one. */
SINEW_API sinew_status sinew_open_text(const char* toml, const char* base, const char* const* set,
                                       size_t set_count, int threads, sinew_simulation** out);
SINEW_API void sinew_close(sinew_simulation* s); /* NULL is allowed */

/* ---- time ---- */
SINEW_API sinew_status sinew_step(sinew_simulation* s);
SINEW_API sinew_status sinew_step_by(sinew_simulation* s, double dt); /* [s] */
/* done: 1, or 0 if interrupted; may be NULL. */
SINEW_API sinew_status sinew_advance(sinew_simulation* s, double seconds, int* done);
SINEW_API void sinew_interrupt(sinew_simulation* s);
SINEW_API double sinew_time(const sinew_simulation* s); /* [s] */
SINEW_API int64_t sinew_steps(const sinew_simulation* s);
SINEW_API double sinew_last_step(const sinew_simulation* s);   /* [s] */
SINEW_API double sinew_stable_step(const sinew_simulation* s); /* [s] */

/* ---- arrays ---- */
SINEW_API sinew_array sinew_positions(const sinew_simulation* s);      /* double x 3 [m] */
SINEW_API sinew_array sinew_rest_positions(const sinew_simulation* s); /* double x 3 [m] */
SINEW_API sinew_array sinew_velocities(const sinew_simulation* s);     /* double x 3 [m/s] */
SINEW_API sinew_array sinew_forces(const sinew_simulation* s);         /* double x 3 [N] */
SINEW_API sinew_array sinew_masses(const sinew_simulation* s);         /* double x 1 [kg] */
SINEW_API sinew_array sinew_tets(const sinew_simulation* s);           /* int32 x 4 */
SINEW_API sinew_array sinew_surface(const sinew_simulation* s);        /* int32 x 3 */

/* ---- a picture for another thread ----
 * After sinew_publish(s, 1) every step and advance ends with a copy of the state, which
 * sinew_latest() gives to one other thread without a lock: the newest finished one, NULL before the
 * first. It is valid until the next call of sinew_latest(). */
SINEW_API sinew_status sinew_publish(sinew_simulation* s, int on);
SINEW_API const sinew_frame* sinew_latest(sinew_simulation* s);

/* ---- obstacles, pins, grabs ---- */
SINEW_API sinew_status sinew_find_obstacle(const sinew_simulation* s, const char* name,
                                           sinew_obstacle* out);
/* Moves it to the pose over the next step or advance. rotation: w, x, y, z; NULL: as it is. */
SINEW_API sinew_status sinew_move_obstacle(sinew_simulation* s, sinew_obstacle obstacle,
                                           const double center[3], const double rotation[4]);
/* The force of the bodies on it, and the torque about its centre. */
SINEW_API sinew_status sinew_obstacle_wrench(const sinew_simulation* s, sinew_obstacle obstacle,
                                             sinew_wrench* out);
SINEW_API sinew_status sinew_find_pin(const sinew_simulation* s, const char* name, sinew_pin* out);
/* move [m] and turn, a rotation vector [rad], since the start; NULL: none. */
SINEW_API sinew_status sinew_move_pin(sinew_simulation* s, sinew_pin pin, const double move[3],
                                      const double turn[3]);
/* The load on the pin, and the torque about `about` [m]; NULL: the origin. */
SINEW_API sinew_status sinew_pin_wrench(const sinew_simulation* s, sinew_pin pin,
                                        const double about[3], sinew_wrench* out);
/* The node of the surface nearest to a place [m]; -1 for a null pointer. */
SINEW_API int32_t sinew_nearest_node(const sinew_simulation* s, const double place[3]);
SINEW_API sinew_status sinew_grab_nodes(sinew_simulation* s, int32_t node, double radius,
                                        sinew_grab* out);
SINEW_API sinew_status sinew_move_grab(sinew_simulation* s, sinew_grab grab,
                                       const double target[3]);
SINEW_API sinew_status sinew_release_grab(sinew_simulation* s, sinew_grab grab);

/* ---- cuts ----
 * body: NULL or "" for every body that the surface meets; for a blade, the only one. All arrays
 * change. report may be NULL. */
SINEW_API sinew_status sinew_cut_plane(sinew_simulation* s, const char* body, const double point[3],
                                       const double normal[3], sinew_cut_report* report);
/* vertices: [m] (3 vertex_count); triangles: (3 triangle_count), of any orientation. */
SINEW_API sinew_status sinew_cut_triangles(sinew_simulation* s, const char* body,
                                           const double* vertices, size_t vertex_count,
                                           const int32_t* triangles, size_t triangle_count,
                                           sinew_cut_report* report);
SINEW_API sinew_status sinew_add_blade(sinew_simulation* s, const char* body, sinew_blade* out);
/* Draws the blade on to an edge [m]; the first edge of a stroke cuts nothing. */
SINEW_API sinew_status sinew_move_blade(sinew_simulation* s, sinew_blade blade,
                                        const double heel[3], const double tip[3],
                                        sinew_cut_report* report);
SINEW_API sinew_status sinew_lift_blade(sinew_simulation* s, sinew_blade blade);
SINEW_API sinew_status sinew_remove_blade(sinew_simulation* s, sinew_blade blade);
/* To the moment before the last cut or stroke, and back. */
SINEW_API sinew_status sinew_undo(sinew_simulation* s);
SINEW_API sinew_status sinew_redo(sinew_simulation* s);

/* ---- materials and gravity ----
 * region: NULL or "" for the body itself. key: as in a scene, of those with a number: "young".
 * Builds the model again, which takes as long as loading; positions do not change. */
SINEW_API sinew_status sinew_set_material(sinew_simulation* s, const char* body, const char* region,
                                          const char* key, double value);
SINEW_API sinew_status sinew_set_gravity(sinew_simulation* s, const double gravity[3]);

/* ---- states ----
 * Writes the state into bytes if *size is enough, and its size into *size; bytes may be NULL. */
SINEW_API sinew_status sinew_save(const sinew_simulation* s, void* bytes, size_t* size);
SINEW_API sinew_status sinew_restore(sinew_simulation* s, const void* bytes, size_t size);
/* Writes 16 hexadecimal digits and a zero. */
SINEW_API sinew_status sinew_hash(const sinew_simulation* s, char out[17]);

#ifdef __cplusplus
}
#endif
#endif
