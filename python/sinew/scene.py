"""A scene that is built in Python, with the keys of docs/scene-format.md."""

from __future__ import annotations

import math
import os
import pathlib
import re
import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from .errors import UsageError

Numbers = npt.ArrayLike
Path = str | os.PathLike[str]

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+\Z")


def _key(name: str) -> str:
    return name if _BARE_KEY.match(name) else _text(name)


def _text(value: str) -> str:
    out = value.replace("\\", "\\\\").replace('"', '\\"')
    out = re.sub(r"[\x00-\x1f\x7f]", lambda m: f"\\u{ord(m[0]):04x}", out)
    return f'"{out}"'


def _value(value: Any) -> str:
    """A value as TOML."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isnan(value):
            return "nan"
        if math.isinf(value):
            return "inf" if value > 0 else "-inf"
        return repr(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, os.PathLike):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    raise UsageError(f"a value of type {type(value).__name__} has no form in a scene",
                     "numbers, texts, True and False, lists, dicts and numpy arrays do")


def _whole(values: Numbers | None, what: str) -> npt.NDArray[np.int32]:
    """Whole numbers of 32 bits; numpy would cut fractions off and wrap large ones around."""
    array = np.asarray([] if values is None else values)
    if array.size == 0:
        return np.empty(0, np.int32)
    out = array.astype(np.int64) if array.dtype.kind in "iuf" and np.isfinite(array).all() else None
    if out is None or (out != array).any() or (np.abs(out) > 2**31 - 1).any():
        raise UsageError(f"{what} are not all whole numbers of 32 bits", "give integers, from 0")
    return out.astype(np.int32)


class Scene:
    """A scene: bodies with their meshes and materials, supports, motions, loads.

    Every keyword is a key of docs/scene-format.md, with the same meaning, unit, default and range.
    Values are checked when a Simulation is made of it, by the same code as for a file.

    Every method adds one table and returns the scene:

        scene = sinew.Scene(gravity=[0, -9.81, 0])
        scene.body("slab", shape="box", size=[0.1, 0.02, 0.1], cells=[10, 2, 10], young=5e3)
        scene.pin("bottom", select={"side": "-y"})
        scene.obstacle("tool", shape="sphere", center=[0, 0.04, 0], radius=0.02)
        scene.probe("top", select={"nearest": [0, 0.01, 0]})

    Args:
        base: the folder where relative paths of meshes start; default: the current one.
        keys: keys of the scene itself: title, duration, gravity, stepper, dt ...
    """

    def __init__(self, /, *, base: Path | None = None, **keys: Any) -> None:
        self.base = pathlib.Path(base if base is not None else os.getcwd())
        self._root: dict[str, Any] = dict(keys)
        self._tables: dict[str, dict[str, dict[str, Any]]] = {}
        self._bodies: dict[str, tuple[Any, ...]] = {}
        self._obstacles: dict[str, tuple[Any, ...]] = {}

    @classmethod
    def from_text(cls, text: str, *, base: Path | None = None) -> Scene:
        """A scene from the text of a scene file, to change in Python.

        Raises:
            InputError: the text is no TOML.
        """
        try:
            document = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            from .errors import InputError
            raise InputError(str(error), "see docs/scene-format.md") from None
        scene = cls(base=base)
        named = {"body", "pin", "attachment", "distance", "force", "probe", "obstacle"}
        for key, value in document.items():
            if key in named and isinstance(value, dict):
                scene._tables[key] = {name: dict(table) for name, table in value.items()}
            else:
                scene._root[key] = value
        return scene

    @classmethod
    def from_file(cls, file: Path) -> Scene:
        """A scene from a scene file; paths in it stay relative to its folder.

        Raises:
            OSError: the file cannot be read.
            InputError: it is no TOML.
        """
        path = pathlib.Path(file)
        return cls.from_text(path.read_text(encoding="utf-8"), base=path.resolve().parent)

    def __setitem__(self, key: str, value: Any) -> None:
        """Sets a key of the scene itself: scene["gravity"] = [0, 0, 0]."""
        self._root[key] = value

    def __getitem__(self, key: str) -> Any:
        return self._root[key]

    def _add(self, kind: str, name: str, keys: Mapping[str, Any]) -> Scene:
        tables = self._tables.setdefault(kind, {})
        if name in tables:
            raise UsageError(f"there is a {kind} '{name}' in the scene already",
                             "give it another name")
        tables[name] = {k: v for k, v in keys.items() if v is not None}
        return self

    def body(self, name: str, /, *, nodes: Numbers | None = None, tets: Numbers | None = None,
             tet_labels: Numbers | None = None, faces: Numbers | None = None,
             face_labels: Numbers | None = None, **keys: Any) -> Scene:
        """Adds a body, [body.NAME]: mesh="FILE", shape="box" ..., or arrays.

        Args:
            nodes: (n, 3) places [m], or in units of `scale` metres.
            tets: (t, 4) node numbers, from 0.
            tet_labels: (t,) a label for each tet; default: all 0.
            faces: (f, 3) labelled triangles, for selections.
            face_labels: (f,) their labels.
        """
        if (nodes is None) != (tets is None):
            raise UsageError(f"body '{name}' has nodes or tets, not both", "give both arrays")
        if nodes is not None:
            keys["mesh"] = f"memory:{name}"
            of = f"of body '{name}'"
            self._bodies[name] = (
                np.asarray(nodes, np.float64), _whole(tets, f"the tets {of}"),
                _whole(tet_labels, f"the tet_labels {of}"), _whole(faces, f"the faces {of}"),
                _whole(face_labels, f"the face_labels {of}"))
        return self._add("body", name, keys)

    def region(self, body: str, name: str, /, **keys: Any) -> Scene:
        """Adds a region of a body, [body.BODY.region.NAME]: label, labels or select, and its
        material."""
        tables = self._tables.get("body", {})
        if body not in tables:
            raise UsageError(f"there is no body '{body}' in the scene", "add the body first")
        regions = tables[body].setdefault("region", {})
        if name in regions:
            raise UsageError(f"there is a region '{name}' of '{body}' already",
                             "give it another name")
        regions[name] = {k: v for k, v in keys.items() if v is not None}
        return self

    def pin(self, name: str, /, **keys: Any) -> Scene:
        """Adds a pin, [pin.NAME]: nodes that are held or moved on a path."""
        return self._add("pin", name, keys)

    def attachment(self, name: str, /, **keys: Any) -> Scene:
        """Adds an attachment, [attachment.NAME]: springs to a point or another body, or glue."""
        return self._add("attachment", name, keys)

    def distance(self, name: str, /, **keys: Any) -> Scene:
        """Adds a distance that is kept, [distance.NAME]."""
        return self._add("distance", name, keys)

    def force(self, name: str, /, **keys: Any) -> Scene:
        """Adds a load, [force.NAME]: a force, a traction or a pressure."""
        return self._add("force", name, keys)

    def probe(self, name: str, /, **keys: Any) -> Scene:
        """Adds a probe, [probe.NAME]: the mean place of some nodes."""
        return self._add("probe", name, keys)

    def obstacle(self, name: str, /, *, nodes: Numbers | None = None,
                 triangles: Numbers | None = None, **keys: Any) -> Scene:
        """Adds an obstacle, [obstacle.NAME]: a shape, a surface file, or arrays.

        Args:
            nodes: (n, 3) places [m].
            triangles: (t, 3) node numbers, counter-clockwise seen from outside.
        """
        if (nodes is None) != (triangles is None):
            raise UsageError(f"obstacle '{name}' has nodes or triangles, not both",
                             "give both arrays")
        if nodes is not None:
            keys["mesh"] = f"memory:{name}"
            self._obstacles[name] = (np.asarray(nodes, np.float64),
                                     _whole(triangles, f"the triangles of obstacle '{name}'"))
        return self._add("obstacle", name, keys)

    def ground(self, /, **keys: Any) -> Scene:
        """Sets the ground, [ground]."""
        self._root["ground"] = keys
        return self

    def contact(self, /, **keys: Any) -> Scene:
        """Sets contact between bodies and of bodies with themselves, [contact]."""
        self._root["contact"] = keys
        return self

    def output(self, /, **keys: Any) -> Scene:
        """Sets what runs write, [output]."""
        self._root["output"] = keys
        return self

    def toml(self) -> str:
        """The scene as the text of a scene file. Arrays are not part of it."""
        lines = [f"{_key(k)} = {_value(v)}" for k, v in self._root.items()]
        for kind, tables in self._tables.items():
            for name, keys in tables.items():
                lines += ["", f"[{kind}.{_key(name)}]"]
                lines += [f"{_key(k)} = {_value(v)}" for k, v in keys.items() if k != "region"]
                for region, values in keys.get("region", {}).items():
                    lines += ["", f"[{kind}.{_key(name)}.region.{_key(region)}]"]
                    lines += [f"{_key(k)} = {_value(v)}" for k, v in values.items()]
        return "\n".join(lines) + "\n"

    def __repr__(self) -> str:
        bodies = ", ".join(self._tables.get("body", {}))
        return f"<sinew.Scene of {bodies or 'no body'}>"


def overrides(settings: Mapping[str, Any] | Sequence[str] | None) -> list[str]:
    """The argument `set` as the command line takes it: ["liver.young=5000.0"]."""
    if settings is None:
        return []
    if isinstance(settings, Mapping):
        return [f"{key}={_value(value)}" for key, value in settings.items()]
    return list(settings)


def source_of(scene: Scene | Path, settings: Mapping[str, Any] | Sequence[str] | None = None
              ) -> _sinew.SceneSource:
    """A scene, the path of a scene file or of a mesh, or the text of a scene."""
    values = overrides(settings)
    if isinstance(scene, Scene):
        return _sinew.SceneSource(text=scene.toml(), base=str(scene.base), set=values,
                                  bodies=scene._bodies, obstacles=scene._obstacles)
    if isinstance(scene, str) and "\n" in scene:
        return _sinew.SceneSource(text=scene, base=os.getcwd(), set=values)
    return _sinew.SceneSource(file=os.fspath(scene), set=values)
