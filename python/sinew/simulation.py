"""A simulation that Python owns and steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _sinew
from .errors import UsageError
from .handles import (Blade, Body, CutReport, Event, Floats, Grab, Ints, Material, Obstacle,
                      Pin, Point, Probe, xyz)
from .live import View
from .scene import Path, Scene, source_of

Settings = Mapping[str, Any] | Sequence[str]
Points = Sequence[Point] | Floats
Triangles = Sequence[Sequence[int]] | Ints


class Simulation:
    """A simulation of soft bodies.

        sim = sinew.Simulation("liver.toml", set={"liver.young": 5e3})
        tool = sim.obstacle("tool")
        for i in range(1000):
            tool.move([0, 0.2 - 1e-4 * i, 0])
            sim.advance(1e-3)
            print(sim.time, tool.force)

    Arrays (positions, velocities, forces, stress) are read-only numpy arrays of double precision,
    the same array at every call. One that you hold follows the simulation from call to call. After
    a change that builds the model again (materials, obstacles added or removed, restore) it keeps
    the values of before: ask for it again. Arrays live on after the simulation.

    Threads: one thread at a time uses a simulation; step() and advance() let other Python threads
    run meanwhile, which may read the arrays. interrupt() may be called by any thread at any time.
    Ctrl-C ends a step and raises KeyboardInterrupt; the simulation can go on.

    Results have the same bits for every number of threads, and the bits of `sinew run`.

    Args:
        scene: a Scene, the path of a scene file or of a mesh, or the text of a scene (with line
            breaks).
        set: values that override those of the scene, {"liver.young": 5e3} or
            ["liver.young=5e3"].
        threads: from 1 to 1024; 0: all of the machine.

    Raises:
        InputError: a fault in the scene or a mesh, with file, line and column.
        IoError: a file cannot be read.
        UnstableError: the scene's step is longer than the stable one.
    """

    def __init__(self, scene: Scene | Path, *, set: Settings | None = None,
                 threads: int = 0) -> None:
        self._s = _sinew.Simulation(source_of(scene, set), threads)

    def show(self, *, height: int = 480, port: int = 0) -> View:
        """Shows the simulation live in a notebook: as the last value of a cell, or by display(). The
        view has the simulation until its close().

            page = sim.show()
            page
        """
        return View(self, port=port, framed=True, height=height)

    # ---- time ----

    def step(self, dt: float | None = None) -> None:
        """Takes the next step of the scene, or one of `dt` seconds (above 0, at most 10).

        With stepper = "static": finds the rest state at the end of the next frame.

        Raises:
            UnstableError: an explicit step may not be that long; see stable_step.
            DivergedError: the state became infinite; the simulation is at an earlier frame.
        """
        if dt is None:
            self._s.step()
        else:
            self._s.step_by(dt)

    def advance(self, seconds: float) -> bool:
        """Takes steps until `seconds` more have passed, from 0 to 3600.

        Returns:
            True if done, False if interrupt() ended it.
        """
        return self._s.advance(seconds)

    def interrupt(self) -> None:
        """Ends a step() or advance() of another thread; without one, it ends the next one."""
        self._s.interrupt()

    @property
    def time(self) -> float:
        """[s]"""
        return self._s.time

    @property
    def steps(self) -> int:
        """The number of steps taken."""
        return self._s.steps

    @property
    def last_step(self) -> float:
        """The length of the last step [s]; 0 before the first."""
        return self._s.last_step

    @property
    def stable_step(self) -> float:
        """The longest stable explicit step at the last estimate [s]; inf for other steppers."""
        return self._s.stable_step

    @property
    def stepper(self) -> str:
        """verlet, implicit or static."""
        return self._s.stepper

    # ---- arrays ----

    @property
    def positions(self) -> Floats:
        """(nodes, 3) [m]."""
        return self._s.floats("positions")

    @property
    def rest_positions(self) -> Floats:
        """(nodes, 3) [m]."""
        return self._s.floats("rest_positions")

    @property
    def displacements(self) -> Floats:
        """(nodes, 3) positions - rest_positions [m]; a new array."""
        return self.positions - self.rest_positions

    @property
    def velocities(self) -> Floats:
        """(nodes, 3) the displacement of the last step over its length [m/s]."""
        return self._s.floats("velocities")

    @property
    def forces(self) -> Floats:
        """(nodes, 3) the force on each node [N].

        Of the material; on free nodes also gravity, loads, soft obstacles and grabs; contacts of
        the last step. Limits of springs and distances are not part of it. The first call after a
        step costs about as much as a step.
        """
        return self._s.floats("forces")

    @property
    def stress(self) -> Floats:
        """(tets, 6) the Cauchy stress [Pa]: xx, yy, zz, yz, xz, xy; > 0 under tension."""
        return self._s.floats("stress")

    @property
    def masses(self) -> Floats:
        """(nodes,) [kg]."""
        return self._s.floats("masses")

    @property
    def tets(self) -> Ints:
        """(tets, 4) node numbers."""
        return self._s.ints("tets")

    @property
    def surface(self) -> Ints:
        """(triangles, 3) node numbers of the bodies' surfaces."""
        return self._s.ints("surface")

    @property
    def bodies(self) -> dict[str, Body]:
        """The bodies by name, in the scene's order."""
        return {name: Body(name, slice(n, n + nodes), slice(t, t + tets), mass, volume)
                for name, n, nodes, t, tets, mass, volume in self._s.bodies()}

    @property
    def probes(self) -> dict[str, Probe]:
        """The probes by name, measured now."""
        return {name: Probe(name, np.array(position), np.array(displacement))
                for name, position, displacement in self._s.probes()}

    @property
    def inverted_tets(self) -> int:
        """The current number of tets with negative volume."""
        return self._s.inverted_tets

    def nearest_node(self, place: Point) -> int:
        """The node of the surface that is nearest to a place [m]."""
        return self._s.nearest_node(xyz(place))

    # ---- obstacles, pins, grabs, materials ----

    def obstacle(self, name: str) -> Obstacle:
        """The obstacle of that name.

        Raises:
            UsageError: there is none; the message has the valid names.
        """
        return Obstacle(self._s, self._s.obstacle(name), name)

    @property
    def obstacle_names(self) -> list[str]:
        """The names of all obstacles."""
        return self._s.obstacle_names()

    def add_obstacle(self, name: str, **keys: Any) -> Obstacle:
        """Adds an obstacle with the keys of [obstacle.NAME]: shape, center, radius, friction ...

        Builds the model again, which takes as long as loading.
        """
        return Obstacle(self._s, self._s.add_obstacle(name, keys), name)

    def pin(self, name: str) -> Pin:
        """The pin of that name."""
        return Pin(self._s, self._s.pin(name), name)

    @property
    def pin_names(self) -> list[str]:
        """The names of all pins."""
        return self._s.pin_names()

    def grab(self, node: int, radius: float) -> Grab:
        """Holds the nodes of the node's body within `radius` [m] of it at their places."""
        return Grab(self._s, self._s.grab(node, radius))

    def material(self, body: str, region: str = "") -> Material:
        """The material of a body, or of one of its regions."""
        return Material(self._s, self._s.material(body, region))

    # ---- cuts ----

    def cut(self, *, body: str = "", at_rest: bool = False,
            plane: tuple[Point, Point] | None = None,
            disc: tuple[Point, Point, float] | None = None,
            blade: Sequence[tuple[Point, Point]] | None = None,
            triangles: tuple[Points, Triangles] | None = None) -> CutReport:
        """Cuts tissue along a surface, at once.

        Args:
            body: the body to cut; empty: every body that the surface meets; with a blade, the only
                one.
            at_rest: the coordinates are those of the rest shape, not of the current one.
            plane: all through, (point [m], normal); or
            disc: (center [m], normal, radius [m]); or
            blade: edges (heel [m], tip [m]), two or more: what lies between them is cut; or
            triangles: (vertices [m], (n, 3) indices into them), of any orientation.

        Arrays of before keep their values and their length.

        Raises:
            UsageError: not exactly one surface is given, or there is no such body.
            InputError: the surface is not valid.
        """
        given = [s for s in (plane, disc, blade, triangles) if s is not None]
        if len(given) != 1:
            raise UsageError(f"a cut has one surface, not {len(given)}",
                             "give plane, disc, blade or triangles")
        if plane is not None:
            report = self._s.cut_by_plane(body, at_rest, xyz(plane[0]), xyz(plane[1]))
        elif disc is not None:
            report = self._s.cut_by_disc(body, at_rest, xyz(disc[0]), xyz(disc[1]), float(disc[2]))
        elif blade is not None:
            edges = [(xyz(heel), xyz(tip)) for heel, tip in blade]
            report = self._s.cut_by_blade(body, at_rest, edges)
        else:
            assert triangles is not None
            corners = [(int(a), int(b), int(c)) for a, b, c in triangles[1]]
            report = self._s.cut_by_triangles(body, at_rest, [xyz(p) for p in triangles[0]], corners)
        return CutReport(*report)

    def blade(self, body: str = "") -> Blade:
        """A blade that cuts a body as it moves; without a name, the only body."""
        return Blade(self._s, self._s.add_blade(body))

    def undo(self) -> None:
        """Returns to the moment before the last cut() or stroke, with its bits.

        Raises:
            UsageError: there is none. A change that builds the model again forgets them.
        """
        self._s.undo()

    def redo(self) -> None:
        """Returns to the moment of the undo()."""
        self._s.redo()

    @property
    def can_undo(self) -> bool:
        """Whether there is a cut to undo."""
        return self._s.can_undo

    @property
    def can_redo(self) -> bool:
        """Whether there is a cut to redo."""
        return self._s.can_redo

    @property
    def topology(self) -> int:
        """Another number after every cut: nodes, tets and surface may be others."""
        return self._s.topology

    @property
    def gravity(self) -> Floats:
        """(3,) [m/s2]; may be set."""
        return np.array(self._s.gravity)

    @gravity.setter
    def gravity(self, gravity: Point) -> None:
        self._s.set_gravity(xyz(gravity))

    # ---- states ----

    def save(self) -> bytes:
        """Everything that decides how it continues; for restore() of the same version of Sinew."""
        return self._s.save()

    def restore(self, state: bytes) -> None:
        """Continues from a state of this simulation or of another one of the same scene, with the
        same bits as without the interruption.

        Raises:
            InputError: the state is of another model, or damaged.
        """
        self._s.restore(state)

    def hash(self) -> str:
        """16 hexadecimal digits over positions, velocities, time and steps, as `sinew run`
        prints them."""
        return self._s.hash()

    def take_events(self) -> list[Event]:
        """The events since the last call; the newest 1000 are kept."""
        return [Event(*event) for event in self._s.take_events()]

    @property
    def warnings(self) -> list[str]:
        """Warnings about the scene: repaired meshes, implausible sizes, overlaps."""
        return self._s.warnings()

    # ---- for other packages ----

    def to_meshio(self) -> Any:
        """The tets at their current places as meshio.Mesh, with displacement, velocity, stress.

        Raises:
            ImportError: meshio is not installed.
        """
        import meshio  # type: ignore[import]
        return meshio.Mesh(self.positions.copy(), [("tetra", self.tets.copy())],
                           point_data={"displacement": self.displacements,
                                       "velocity": self.velocities.copy()},
                           cell_data={"stress": [self.stress.copy()]})

    def to_pyvista(self) -> Any:
        """The tets at their current places as pyvista.UnstructuredGrid, with the same data.

        Raises:
            ImportError: pyvista is not installed.
        """
        import pyvista  # type: ignore[import]
        count = len(self.tets)
        cells = np.hstack([np.full((count, 1), 4, np.int32), self.tets]).ravel()
        grid = pyvista.UnstructuredGrid(cells, np.full(count, 10, np.uint8), self.positions.copy())
        grid.point_data["displacement"] = self.displacements
        grid.point_data["velocity"] = self.velocities.copy()
        grid.cell_data["stress"] = self.stress.copy()
        return grid

    def __repr__(self) -> str:
        return (f"<sinew.Simulation of {', '.join(self.bodies)}: {len(self.tets)} tets, "
                f"{self.time:.4g} s>")
