"""Reads a run's folder for tools/picture: the frames of its .pvd, their surface and their scalars."""

import pathlib
import xml.etree.ElementTree

import meshio
import numpy as np

# Units of the arrays of a run; other arrays have none.
UNITS = {"displacement": "m", "velocity": "m/s", "pressure": "Pa"}


class PictureError(Exception):
    """A message for the user: the object that cannot be drawn, and the reason."""


class Frame:
    """One instant of a run: node positions [m] (n, 3), tets (t, 4), named node scalars (n)."""

    def __init__(self, time, path):
        self.time = time
        try:
            mesh = meshio.read(path)
        except Exception as error:  # meshio raises whatever its reader meets
            raise PictureError(f"{path}: cannot be read: {error}") from error
        tets = [block.data for block in mesh.cells if block.type == "tetra"]
        if not tets:
            raise PictureError(f"{path}: no tetrahedra in it")
        self.points = np.asarray(mesh.points, dtype=float)
        self.tets = np.concatenate(tets)
        self.arrays = {name: np.asarray(a, dtype=float) for name, a in mesh.point_data.items()}
        for name, parts in mesh.cell_data.items():
            values = [a for block, a in zip(mesh.cells, parts) if block.type == "tetra"]
            values = np.concatenate(values).astype(float)
            if values.size == len(values):  # scalars, of whatever shape meshio gives them
                values = values.reshape(-1)
                self.arrays.setdefault(name, self._cells_to_nodes(values))

    def rest_points(self):
        if "displacement" not in self.arrays:
            raise PictureError("no array 'displacement', so the rest shape is not known")
        return self.points - self.arrays["displacement"]

    def scalar(self, name):
        """The node values of an array; of a vector, its length."""
        if name not in self.arrays:
            raise PictureError(f"no array '{name}'; there are: {', '.join(sorted(self.arrays))}")
        values = self.arrays[name]
        return values if values.ndim == 1 else np.linalg.norm(values, axis=1)

    def _cells_to_nodes(self, values):
        total = np.zeros(len(self.points))
        count = np.zeros(len(self.points))
        for corner in self.tets.T:
            np.add.at(total, corner, values)
            np.add.at(count, corner, 1.0)
        return total / np.maximum(count, 1.0)


class Run:
    """The frames that the .pvd of a run's folder lists; `path` is the folder or the .pvd."""

    def __init__(self, path):
        path = pathlib.Path(path)
        if path.is_dir():
            found = sorted(path.glob("*.pvd"))
            if len(found) != 1:
                raise PictureError(f"{path}: expected one .pvd file there, found {len(found)}")
            path = found[0]
        try:
            root = xml.etree.ElementTree.parse(path).getroot()
        except (OSError, xml.etree.ElementTree.ParseError) as error:
            raise PictureError(f"{path}: cannot be read: {error}") from error
        self.name = path.stem
        self.entries = [(float(e.get("timestep")), path.parent / e.get("file"))
                        for e in root.iter("DataSet")]
        if not self.entries:
            raise PictureError(f"{path}: it lists no frames")

    def frames(self, which):
        """Frames by a list such as "0,15,last" (the default of a picture: "last")."""
        indices = []
        if which == "all":
            return [Frame(*entry) for entry in self.entries]
        for word in which.split(","):
            count = len(self.entries)
            try:
                index = count - 1 if word.strip() == "last" else int(word)
            except ValueError:
                raise PictureError(f"--frame: '{word}' is neither a number nor 'last'") from None
            if not 0 <= index < count:
                raise PictureError(f"--frame: no frame {index}; the last one is {count - 1}")
            indices.append(index)
        return [Frame(*self.entries[i]) for i in indices]


def surface(points, tets):
    """Triangles (m, 3) on the boundary of the tets, counter-clockwise seen from outside."""
    faces = np.concatenate([tets[:, [1, 2, 3]], tets[:, [0, 3, 2]], tets[:, [0, 1, 3]],
                            tets[:, [0, 2, 1]]])
    opposite = tets.T.reshape(-1)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True,
                                return_counts=True)
    once = np.sort(first[count == 1])
    faces, inside = faces[once], points[opposite[once]]
    a, b, c = (points[faces[:, i]] for i in range(3))
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - inside) > 0
    return np.where(outward[:, None], faces, faces[:, ::-1])
