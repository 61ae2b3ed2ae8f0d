"""What a simulation hands out: obstacles, pins, grabs, blades, materials, and plain results."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _sinew
from .errors import UsageError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Point = Sequence[float] | Floats


def xyz(value: Point) -> tuple[float, float, float]:
    """Three numbers of anything that has three."""
    try:
        x, y, z = (float(v) for v in value)
    except (TypeError, ValueError):
        raise UsageError(f"{value!r} is no place or direction", "give three numbers") from None
    return x, y, z


class Wrench(NamedTuple):
    """A force [N] and a torque [N m], each of 3 numbers."""

    force: Floats
    torque: Floats


class Pose(NamedTuple):
    """A place [m] and a rotation, a unit quaternion w, x, y, z."""

    center: Floats
    rotation: Floats


class Motion(NamedTuple):
    """A translation [m], and a rotation vector: along the axis, its length the angle [rad]."""

    move: Floats
    turn: Floats


@dataclasses.dataclass(frozen=True)
class Body:
    """A body: its nodes are positions[nodes], its tets tets[tets]."""

    name: str
    nodes: slice
    tets: slice
    mass: float  # [kg]
    rest_volume: float  # [m3]


@dataclasses.dataclass(frozen=True)
class Probe:
    """The mean of a probe's nodes."""

    name: str
    position: Floats  # [m]
    displacement: Floats  # since the rest shape [m]


@dataclasses.dataclass(frozen=True)
class ContactPoint:
    """A point of a body that touches an obstacle."""

    place: Floats  # [m]
    normal: Floats  # unit, out of the obstacle
    depth: float  # [m] > 0: inside
    node: int  # the node at the point, or the nearest one


@dataclasses.dataclass(frozen=True)
class Event:
    """Something that nobody asked for.

    kind: "inverted" (tets; count: their number), "diverged", "stepper_changed" (text: the reason),
    "step_shortened", "parted" (count: pieces of the bodies after a cut).
    """

    kind: str
    time: float  # [s]
    count: int
    text: str


class Obstacle:
    """An obstacle of a simulation; from Simulation.obstacle()."""

    def __init__(self, simulation: _sinew.Simulation, handle: _sinew.ObstacleHandle, name: str) -> None:
        self._s, self._handle, self.name = simulation, handle, name

    def move(self, center: Point, rotation: Sequence[float] | None = None) -> None:
        """Moves it to the pose, straight and at constant speed, over the next step() or advance().

        It then stays there. This replaces the path of the scene.

        Args:
            center: (3,) [m].
            rotation: a quaternion w, x, y, z; default: as it is.
        """
        self._s.move_obstacle(self._handle, xyz(center), self._rotation(rotation))

    def place(self, center: Point, rotation: Sequence[float] | None = None) -> None:
        """Puts it at the pose at once, without a speed."""
        self._s.place_obstacle(self._handle, xyz(center), self._rotation(rotation))

    def _rotation(self, rotation: Sequence[float] | None) -> tuple[float, float, float, float]:
        if rotation is None:
            return self._s.pose_of_obstacle(self._handle)[1]
        w, x, y, z = (float(v) for v in rotation)
        return w, x, y, z

    @property
    def pose(self) -> Pose:
        """Its place and rotation."""
        center, rotation = self._s.pose_of_obstacle(self._handle)
        return Pose(np.array(center), np.array(rotation))

    @property
    def force(self) -> Floats:
        """(3,) the force of the bodies on it [N]. Hard obstacle: the mean over the last step."""
        return self.wrench().force

    def wrench(self, about: Point | None = None) -> Wrench:
        """The force on it, and the torque about a point [m]; default: its centre."""
        force, torque = self._s.wrench_on_obstacle(
            self._handle, None if about is None else xyz(about))
        return Wrench(np.array(force), np.array(torque))

    @property
    def depth(self) -> float:
        """The largest penetration [m]; 0: none."""
        return self._s.depth_in_obstacle(self._handle)

    def contacts(self) -> list[ContactPoint]:
        """The points of the bodies that touch it."""
        return [ContactPoint(np.array(place), np.array(normal), depth, node)
                for place, normal, depth, node in self._s.contacts_of_obstacle(self._handle)]

    def remove(self) -> None:
        """Removes it. Builds the model again, which takes as long as loading."""
        self._s.remove_obstacle(self._handle)

    def __repr__(self) -> str:
        return f"<sinew.Obstacle '{self.name}'>"


class Pin:
    """A pin of a simulation; from Simulation.pin()."""

    def __init__(self, simulation: _sinew.Simulation, handle: _sinew.PinHandle, name: str) -> None:
        self._s, self._handle, self.name = simulation, handle, name

    def move(self, move: Point = (0.0, 0.0, 0.0), turn: Point = (0.0, 0.0, 0.0)) -> None:
        """Moves it to this motion since the start, over the next step() or advance().

        Args:
            move: (3,) translation [m].
            turn: (3,) rotation vector [rad], about the pin's pivot.
        """
        self._s.move_pin(self._handle, xyz(move), xyz(turn))

    @property
    def motion(self) -> Motion:
        """Its motion since the start."""
        move, turn = self._s.motion_of_pin(self._handle)
        return Motion(np.array(move), np.array(turn))

    def wrench(self, about: Point = (0.0, 0.0, 0.0)) -> Wrench:
        """The load of its nodes on the pin, and the torque about a point [m]."""
        force, torque = self._s.wrench_on_pin(self._handle, xyz(about))
        return Wrench(np.array(force), np.array(torque))

    @property
    def force(self) -> Floats:
        """(3,) the load of its nodes on the pin [N]."""
        return self.wrench().force

    def __repr__(self) -> str:
        return f"<sinew.Pin '{self.name}'>"


class Grab:
    """A patch of tissue that is pulled by springs; from Simulation.grab()."""

    def __init__(self, simulation: _sinew.Simulation, handle: _sinew.GrabHandle) -> None:
        self._s, self._handle = simulation, handle

    def move(self, target: Point) -> None:
        """Sets the target of the patch's centre [m], at once."""
        self._s.move_grab(self._handle, xyz(target))

    @property
    def target(self) -> Floats:
        """(3,) [m]."""
        return np.array(self._s.target_of_grab(self._handle))

    @property
    def force(self) -> Floats:
        """(3,) on the tissue [N]."""
        return np.array(self._s.force_of_grab(self._handle))

    def release(self) -> None:
        """Lets go."""
        self._s.release_grab(self._handle)


@dataclasses.dataclass(frozen=True)
class CutReport:
    """What a cut did. Nothing changed if `opened` is 0."""

    opened: int  # faces
    area: float  # of one side of the cut, at rest [m2]
    new_nodes: int
    new_tets: int
    parts_before: int  # connected pieces of all bodies
    parts: int
    smallest_angle_before: float  # dihedral, at rest [rad]
    smallest_angle: float
    stable_step_before: float  # [s]; inf unless steps are explicit
    stable_step: float
    elastic_before: float  # energy [J]
    elastic: float  # never more than before


class Blade:
    """A blade that cuts a body as it moves; from Simulation.blade()."""

    def __init__(self, simulation: _sinew.Simulation, handle: _sinew.BladeHandle) -> None:
        self._s, self._handle = simulation, handle

    def move(self, heel: Point, tip: Point) -> CutReport:
        """Draws the blade on to an edge from heel to tip [m], through the tissue where it is now.

        The first edge of a stroke cuts nothing.
        """
        return CutReport(*self._s.move_blade(self._handle, xyz(heel), xyz(tip)))

    def lift(self) -> None:
        """Ends the stroke: undo() takes back strokes."""
        self._s.lift_blade(self._handle)

    def remove(self) -> None:
        """Puts the blade away; the cut stays."""
        self._s.remove_blade(self._handle)


class Material:
    """The material of a body or a region; from Simulation.material()."""

    def __init__(self, simulation: _sinew.Simulation, handle: _sinew.MaterialHandle) -> None:
        self._s, self._handle = simulation, handle

    def change(self, **keys: Any) -> None:
        """Sets values: change(young=8e3). The others stay.

        Keys are those of materials in docs/scene-format.md. Builds the model again, which takes as
        long as loading; positions do not change.

        Raises:
            InputError: a value is not valid; nothing is changed.
        """
        self._s.change_material(self._handle, keys)
