"""Triangle meshes pixel by pixel: which face is seen, and where in it."""
import mesh
import numpy as np
from drawing import INK, LIGHT

SAMPLES = 3  # a pixel, each way
LINE = 0.5  # half the width of edges [samples]


class Raster:
    """What is seen of a mesh in a square of pixels: faces that face the eye, the nearest first."""

    def __init__(self, eye, points, faces, pixels):
        seen = eye.see(points)
        low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
        self.size = SAMPLES * pixels
        self._half_width = 0.52 * (high - low).max()
        self._middle = (low + high) / 2
        self.faces = faces
        self._seen = seen
        scaled = (seen[:, :2] - self._middle) / self._half_width
        self._places = np.column_stack([(scaled + 1) / 2 * self.size, seen[:, 2]])
        self.face = np.full((self.size, self.size), -1)
        self.weights = np.zeros((self.size, self.size, 3))  # of the face's corners
        self._depth = np.full((self.size, self.size), -np.inf)
        for index in range(len(faces)):
            self._add(index)

    def _add(self, index):
        corners = self._places[self.faces[index]]
        (ax, ay), (bx, by), (cx, cy) = corners[:, :2]
        double_area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if double_area <= 0:
            return
        x0, y0 = np.maximum(np.ceil(corners[:, :2].min(axis=0) - 0.5), 0).astype(int)
        x1, y1 = np.minimum(np.floor(corners[:, :2].max(axis=0) - 0.5) + 1,
                            self.size).astype(int)
        if x0 >= x1 or y0 >= y1:
            return
        x, y = np.arange(x0, x1) + 0.5, np.arange(y0, y1)[:, None] + 0.5
        b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / double_area
        c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / double_area
        weights = np.stack([1 - b - c, b, c], axis=2)
        depth = weights @ corners[:, 2]
        window = slice(y0, y1), slice(x0, x1)
        nearer = (weights.min(axis=2) >= 0) & (depth > self._depth[window])
        self._depth[window][nearer] = depth[nearer]
        self.face[window][nearer] = index
        self.weights[window][nearer] = weights[nearer]

    def interpolated(self, values):
        """Of what is given for each vertex, at each sample that shows a face."""
        shown = self.face >= 0
        return np.einsum("sc,scd->sd", self.weights[shown], values[self.faces[self.face[shown]]])

    def on_edge(self):
        """Whether each sample that shows a face shows an edge of it."""
        shown = self.face >= 0
        corners = self._places[self.faces, :2]
        sides = np.linalg.norm(np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1), axis=2)
        ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        heights = np.abs(ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0])[:, None] / sides
        return (self.weights[shown] * heights[self.face[shown]]).min(axis=1) < LINE

    def picture(self, colours):
        """Pixels, white where no face is shown; a colour a sample that shows one."""
        samples = np.ones((self.size, self.size, 3))
        samples[self.face >= 0] = colours
        pixels = self.size // SAMPLES
        return samples.reshape(pixels, SAMPLES, pixels, SAMPLES, 3).mean(axis=(1, 3))


def vertex_normals(points, faces):
    a, b, c = (points[faces[:, i]] for i in range(3))
    normals = np.zeros_like(points)
    for i in range(3):
        np.add.at(normals, faces[:, i], np.cross(b - a, c - a))
    return mesh.unit(normals)


def shaded(raster, eye, points, colours):
    """Colours under the light of the demo's pictures."""
    normals = mesh.unit(raster.interpolated(vertex_normals(points, raster.faces)))
    light = np.clip(eye.see(normals) @ LIGHT, 0, 1)
    return colours * (0.45 + 0.55 * light)[:, None]


def with_edges(raster, colours):
    edge = raster.on_edge()[:, None]
    return np.where(edge, 0.45 * colours + 0.55 * np.array(INK), colours)
