"""A small renderer for tools/picture: a z-buffer with soft shadows and sky light, in numpy."""

import numpy as np


def normalized(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-30)


def vertex_normals(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    normal = np.zeros_like(points)
    face = np.cross(b - a, c - a)
    for i in range(3):
        np.add.at(normal, triangles[:, i], face)
    return normalized(normal)


def basis_of(direction):
    """Two unit vectors that complete `direction` to a right-handed frame: right, up."""
    helper = np.array([0.0, 1.0, 0.0]) if abs(direction[1]) < 0.99 else np.array([0.0, 0.0, 1.0])
    right = normalized(np.cross(helper, direction))
    return right, np.cross(direction, right)


class Camera:
    """Perspective camera that sees all of `points`; angles in degrees, y is up.

    Azimuth 0 looks along -z (from the front), 90 from the right; elevation is above the horizon.
    margins: the shares of the picture left free at either side, at the top, at the bottom.
    """

    def __init__(self, points, azimuth, elevation, width, height, margins=(0.06, 0.08, 0.08),
                 field_of_view=28.0):
        az, el = np.radians([azimuth, elevation])
        self.toward = np.array([np.cos(el) * np.sin(az), np.sin(el), np.cos(el) * np.cos(az)])
        self.right, self.up = basis_of(self.toward)
        self.width, self.height = width, height
        half_y = np.tan(np.radians(field_of_view) / 2)
        self.half = np.array([half_y * width / height, half_y])
        self.target = (points.min(axis=0) + points.max(axis=0)) / 2
        side, top, bottom = margins
        room = self.half * [1 - 2 * side, 1 - top - bottom]
        for _ in range(8):  # centre the visible part, then step back until it fits
            x, y, z = self._local(points)
            self.distance = np.max(np.maximum(np.abs(x) / room[0], np.abs(y) / room[1]) + z)
            u, v = x / (self.distance - z), y / (self.distance - z)
            self.target = (self.target + self.right * self.distance * (u.min() + u.max()) / 2 +
                           self.up * self.distance * (v.min() + v.max()) / 2)
        self.target = self.target - self.up * self.distance * self.half[1] * (bottom - top)
        self.eye = self.target + self.distance * self.toward

    def _local(self, points):
        d = points - self.target
        return d @ self.right, d @ self.up, d @ self.toward

    def project(self, points):
        """Pixel coordinates x, y (y down) and the distance along the view [m]."""
        x, y, z = self._local(points)
        depth = self.distance - z
        return ((x / (depth * self.half[0]) + 1) * self.width / 2,
                (1 - y / (depth * self.half[1])) * self.height / 2, depth)

    def rays(self):
        """Unit direction of each pixel (height, width, 3)."""
        x = ((np.arange(self.width) + 0.5) / self.width * 2 - 1) * self.half[0]
        y = (1 - (np.arange(self.height) + 0.5) / self.height * 2) * self.half[1]
        return normalized(x[None, :, None] * self.right + y[:, None, None] * self.up - self.toward)


class Visible:
    """The visible part of a closed surface: triangle id (-1: none), depth, corner weights."""

    def __init__(self, camera, points, triangles):
        x, y, depth = camera.project(points)
        shape = (camera.height, camera.width)
        self.triangle = np.full(shape, -1)
        self.depth = np.full(shape, np.inf)
        self.weights = np.zeros(shape + (3,))
        inverse = 1.0 / depth
        tx, ty, ti = x[triangles], y[triangles], inverse[triangles]
        area = ((tx[:, 1] - tx[:, 0]) * (ty[:, 2] - ty[:, 0]) -
                (tx[:, 2] - tx[:, 0]) * (ty[:, 1] - ty[:, 0]))
        for t in np.flatnonzero(area < 0):  # y runs down, so these face the camera
            self._draw(t, tx[t], ty[t], ti[t], area[t])
        # Heights of the triangle in pixels, for lines along its edges.
        length = np.stack([np.hypot(tx[:, i - 2] - tx[:, i - 1], ty[:, i - 2] - ty[:, i - 1])
                           for i in range(3)], axis=1)
        self.pixel_heights = np.abs(area)[:, None] / np.maximum(length, 1e-9)
        self.mask = self.triangle >= 0

    def _draw(self, t, x, y, inverse, area):
        height, width = self.depth.shape
        x0, x1 = max(int(x.min()), 0), min(int(x.max()) + 2, width)
        y0, y1 = max(int(y.min()), 0), min(int(y.max()) + 2, height)
        if x0 >= x1 or y0 >= y1:
            return
        px, py = np.arange(x0, x1) + 0.5, np.arange(y0, y1)[:, None] + 0.5
        w0 = ((x[1] - px) * (y[2] - py) - (x[2] - px) * (y[1] - py)) / area
        w1 = ((x[2] - px) * (y[0] - py) - (x[0] - px) * (y[2] - py)) / area
        w2 = 1.0 - w0 - w1
        depth = 1.0 / np.maximum(w0 * inverse[0] + w1 * inverse[1] + w2 * inverse[2], 1e-30)
        window = np.s_[y0:y1, x0:x1]
        wins = (w0 >= 0) & (w1 >= 0) & (w2 >= 0) & (depth < self.depth[window])
        self.triangle[window][wins] = t
        self.depth[window][wins] = depth[wins]
        perspective = np.stack([w0 * inverse[0], w1 * inverse[1], w2 * inverse[2]], axis=-1)
        self.weights[window][wins] = (perspective * depth[..., None])[wins]

    def interpolate(self, triangles, values):
        """Node values at the visible pixels (pixels of the mask, ...)."""
        corners = values[triangles[self.triangle[self.mask]]]
        weights = self.weights[self.mask]
        return np.einsum("pk,pk...->p...", weights, corners)

    def edge_distance(self):
        """Distance of each visible pixel from its triangle's nearest edge [pixels]."""
        heights = self.pixel_heights[self.triangle[self.mask]]
        return np.min(self.weights[self.mask] * heights, axis=1)


class Occluder:
    """Tests whether a direction of light is blocked, by depth maps of points on the surface."""

    SAMPLES_PER_PIXEL = 3

    def __init__(self, points, triangles, resolution):
        self.resolution = resolution  # cells of a depth map's side
        self.radius = np.linalg.norm(points.max(axis=0) - points.min(axis=0)) / 2
        self.center = (points.max(axis=0) + points.min(axis=0)) / 2
        a, b, c = (points[triangles[:, i]] for i in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        pixel = 2 * self.radius / self.resolution
        count = int(self.SAMPLES_PER_PIXEL * area.sum() / pixel**2)
        rng = np.random.default_rng(0)
        t = np.searchsorted(np.cumsum(area), (np.arange(count) + 0.5) / count * area.sum())
        t = np.minimum(t, len(triangles) - 1)
        u, v = np.sqrt(rng.random(count))[:, None], rng.random(count)[:, None]
        self.samples = (1 - u) * a[t] + u * (1 - v) * b[t] + u * v * c[t]

    def visibility(self, queries, directions, bias):
        """Share of the directions (k, 3) that reach each query point (n)."""
        lit = np.zeros(len(queries))
        for direction in directions:
            right, up = basis_of(direction)
            axes = np.stack([right, up, direction], axis=1)
            scale = (self.resolution - 4) / (2 * self.radius)
            grid = self._depth_map((self.samples - self.center) @ axes, scale)
            q = (queries - self.center) @ axes
            ij = np.clip((q[:, :2] * scale + self.resolution / 2).astype(int), 0,
                         self.resolution - 1)
            lit += q[:, 2] > grid[ij[:, 0], ij[:, 1]] - bias
        return lit / len(directions)

    def _depth_map(self, p, scale):
        """Largest height over each cell; then the largest of the neighbours, to close gaps."""
        n = self.resolution
        ij = np.clip((p[:, :2] * scale + n / 2).astype(int), 0, n - 1)
        level = ((p[:, 2] / self.radius + 1) * 32767).astype(np.uint16)  # 16 bits sort fast
        order = np.argsort(level, kind="stable")  # the last write wins
        grid = np.full((n, n), -np.inf)
        grid[ij[order, 0], ij[order, 1]] = p[order, 2]
        closed = grid.copy()
        closed[1:] = np.maximum(closed[1:], grid[:-1])
        closed[:-1] = np.maximum(closed[:-1], grid[1:])
        return np.where(np.isfinite(grid), grid, closed)


def cone(direction, spread, count):
    """Directions around one, for a light of some size."""
    right, up = basis_of(direction)
    i = np.arange(count) + 0.5
    radius, angle = spread * np.sqrt(i / count), i * 2.399963
    return normalized(direction + radius[:, None] * (np.cos(angle)[:, None] * right +
                                                     np.sin(angle)[:, None] * up))


def dome(count):
    """Directions over the upper half, denser where they light a level ground more."""
    i = np.arange(count) + 0.5
    up, angle = np.sqrt(1 - i / count), i * 2.399963
    side = np.sqrt(1 - up**2)
    return np.stack([side * np.cos(angle), up, side * np.sin(angle)], axis=1)


def smoothstep(x, low, high):
    """Rises smoothly from 0 at low to 1 at high."""
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def blurred(field, passes=3):
    """A grid smoothed with its neighbours."""
    for _ in range(passes):
        for axis in (0, 1):
            p = np.pad(field, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
            n = field.shape[axis]
            field = (p.take(range(n), axis) + 2 * field + p.take(range(2, n + 2), axis)) / 4
    return field


class Studio:
    """Lights and ground around a subject, seen by one camera; renders linear RGB on white."""

    GHOST = np.array([0.16, 0.20, 0.26])
    KEY, FILL, RIM, SKY, GLOSS = 0.84, 0.24, 0.10, 0.56, 0.08

    def __init__(self, camera, ground):
        self.camera = camera
        self.ground = ground  # height of the ground [m]
        self.resolution = int(np.clip(camera.height / 5, 48, 256))  # cells of a depth map's side
        toward, right = camera.toward, camera.right
        level = normalized(toward * [1, 0, 1])
        self.key = normalized(0.75 * level - 0.75 * right + 1.5 * np.array([0, 1, 0]))
        self.fill = normalized(toward + 1.2 * right + 0.2 * camera.up)
        self.rim = normalized(-toward + 0.3 * right + 0.8 * camera.up)

    def render(self, points, triangles, albedo, edges=0.0, ghost=None):
        """The picture (height, width, 3): albedo is linear RGB of the nodes; ghost other points.

        edges is how dark the lines of the mesh are, 0 to 1.
        """
        seen = Visible(self.camera, points, triangles)
        normals = vertex_normals(points, triangles)
        n = normalized(seen.interpolate(triangles, normals))
        position = seen.interpolate(triangles, points)

        # Every direction of light is traced once, for the subject and the ground together.
        occluder = Occluder(points, triangles, self.resolution)
        bias = 0.012 * occluder.radius
        spots = self._ground_spots(occluder)
        key = occluder.visibility(np.concatenate([position + 2 * bias * n, spots]),
                                  cone(self.key, 0.2, 32), bias)
        sky = occluder.visibility(np.concatenate([points + 2 * bias * normals, spots]),
                                  dome(80), bias)
        image = self._ground_image(occluder, key[len(position):], sky[len(points):])
        ambient = seen.interpolate(triangles, 0.30 + 0.70 * sky[:len(points)])
        color = seen.interpolate(triangles, albedo)
        image[seen.mask] = self._shade(position, n, color, key[:len(position)], ambient)
        if edges > 0:
            image[seen.mask] *= 1 - edges * np.clip(1.4 - seen.edge_distance(), 0, 1)[:, None]
        if ghost is not None:
            self._draw_ghost(image, seen, ghost, triangles)
        return image

    def _shade(self, position, n, color, key, ambient):
        to_eye = normalized(self.camera.eye - position)

        def toward(direction):
            return np.clip(np.sum(n * direction, axis=1), 0, None)

        light = (self.KEY * key * toward(self.key) + self.FILL * toward(self.fill) +
                 self.SKY * ambient * (0.70 + 0.30 * n[:, 1]))
        white = (self.GLOSS * key * toward(normalized(self.key + to_eye)) ** 50 +
                 self.RIM * toward(self.rim) * (1 - toward(to_eye)) ** 3)
        return color * light[:, None] + white[:, None]

    def _ground_spots(self, occluder):
        """A square grid of points on the ground around the subject."""
        self.reach = 3.0 * occluder.radius
        side = np.linspace(-self.reach, self.reach, self.resolution)
        x, z = np.meshgrid(occluder.center[0] + side, occluder.center[2] + side, indexing="ij")
        return np.stack([x, np.full_like(x, self.ground), z], axis=-1).reshape(-1, 3)

    def _ground_image(self, occluder, key, sky):
        """White, with the subject's shadow on the ground; it fades towards the picture's edges."""
        camera, n = self.camera, self.resolution
        dark = blurred((0.30 * (1 - key) + 0.55 * (1 - sky)).reshape(n, n))
        side = np.linspace(-self.reach, self.reach, n) / (1.15 * occluder.radius)
        dark *= np.exp(-(side[:, None] ** 2 + side**2))
        rays = camera.rays()
        with np.errstate(divide="ignore"):
            travel = (self.ground - camera.eye[1]) / rays[..., 1]
        hit = (travel > 0) & np.isfinite(travel)
        place = camera.eye + rays[hit] * travel[hit][:, None]
        u = (place[:, [0, 2]] - occluder.center[[0, 2]] + self.reach) / (2 * self.reach) * (n - 1)
        inside = np.all((u >= 0) & (u < n - 1), axis=1)
        u = np.clip(u, 0, n - 1.001)
        i, f = u.astype(int).T, (u - u.astype(int)).T
        value = ((1 - f[0]) * ((1 - f[1]) * dark[i[0], i[1]] + f[1] * dark[i[0], i[1] + 1]) +
                 f[0] * ((1 - f[1]) * dark[i[0] + 1, i[1]] + f[1] * dark[i[0] + 1, i[1] + 1]))
        shadow = np.zeros(rays.shape[:2])
        shadow[hit] = np.where(inside, value, 0.0)
        below = 1 - (np.arange(camera.height) + 0.5) / camera.height
        beside = 0.5 - np.abs((np.arange(camera.width) + 0.5) / camera.width - 0.5)
        shadow *= smoothstep(below, 0.07, 0.25)[:, None] * smoothstep(beside, 0.0, 0.2)
        return np.repeat(1 - shadow[..., None], 3, axis=2)

    def _draw_ghost(self, image, seen, points, triangles):
        """A glass shell around the subject: clear where it faces the camera, darker at its rim."""
        ghost = Visible(self.camera, points, triangles)
        n = normalized(ghost.interpolate(triangles, vertex_normals(points, triangles)))
        to_eye = normalized(self.camera.eye - ghost.interpolate(triangles, points))
        facing = np.clip(np.sum(n * to_eye, axis=1), 0, 1)
        alpha = np.zeros(ghost.mask.shape)
        alpha[ghost.mask] = 0.06 + 0.40 * (1 - facing) ** 3
        alpha = np.maximum(alpha, 0.65 * self._outline(ghost.mask)) * ~seen.mask
        image[:] = image * (1 - alpha[..., None]) + self.GHOST * alpha[..., None]

    @staticmethod
    def _outline(mask, width=2):
        inner = mask.copy()
        for _ in range(width):
            m = inner.copy()
            m[1:] &= inner[:-1]
            m[:-1] &= inner[1:]
            m[:, 1:] &= inner[:, :-1]
            m[:, :-1] &= inner[:, 1:]
            inner = m
        return mask & ~inner
