"""Closed meshes: one made from an icosphere, files of others, what a map to the sphere does to areas."""
import numpy as np

GOLDEN = (1 + 5 ** 0.5) / 2


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def icosahedron():
    vertices = [(0, s, t * GOLDEN) for s in (-1, 1) for t in (-1, 1)]
    vertices = np.array([np.roll(v, i) for i in range(3) for v in vertices], float)
    near = np.linalg.norm(vertices[:, None] - vertices, axis=2) < 2.1
    corners = [(a, b, c) for a in range(12) for b in range(a) for c in range(b)
               if near[a, b] and near[b, c] and near[c, a]]
    faces = np.array([f if np.linalg.det(vertices[list(f)]) > 0 else f[::-1] for f in corners])
    return unit(vertices), faces


def edges_of(faces):
    """Each edge once, lower vertex first."""
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(sides, axis=1), axis=0)


def subdivided(vertices, faces, lines):
    """Cuts each face in four, and each side of the lines in two."""
    edges = edges_of(faces)
    count = len(vertices)
    keys = edges[:, 0] * count + edges[:, 1]

    def midpoints(a, b):
        return count + np.searchsorted(keys, np.minimum(a, b) * count + np.maximum(a, b))

    a, b, c = faces.T
    ab, bc, ca = midpoints(a, b), midpoints(b, c), midpoints(c, a)
    faces = np.stack([a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca], axis=1).reshape(-1, 3)
    finer = np.empty((len(lines), 2 * lines.shape[1] - 1), int)
    finer[:, ::2] = lines
    finer[:, 1::2] = midpoints(lines[:, :-1], lines[:, 1:])
    middles = unit(vertices[edges[:, 0]] + vertices[edges[:, 1]])
    return np.concatenate([vertices, middles]), faces, finer


def icosphere(levels, line_level):
    """The vertices, the faces, and the edges of a coarser level as lines through vertices."""
    vertices, faces = icosahedron()
    lines = np.empty((0, 2), int)
    for level in range(levels):
        if level == line_level:
            lines = edges_of(faces)
        vertices, faces, lines = subdivided(vertices, faces, lines)
    return vertices, faces, lines


def bumpy(directions, bumps=12, seed=2):
    """A surface over the sphere, with smooth hills of random height and width."""
    random = np.random.RandomState(seed)
    index = np.arange(bumps) + 0.5
    latitude, longitude = np.arcsin(1 - 2 * index / bumps), 2 * np.pi * index / GOLDEN
    peaks = np.stack([np.cos(latitude) * np.cos(longitude),
                      np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=1)
    heights = random.uniform(0.4, 1.2, bumps)
    widths = random.uniform(0.25, 0.3, bumps)
    radius = 1 + np.exp((directions @ peaks.T - 1) / widths ** 2) @ heights
    return directions * radius[:, None]


def write_obj(path, vertices, faces):
    with open(path, "w") as file:
        np.savetxt(file, vertices, "v %.17g %.17g %.17g")
        np.savetxt(file, faces + 1, "f %d %d %d")


def read_obj(path):
    """Vertices and faces; of a vertex only its place, of a face's corners only their vertices."""
    vertices, faces = [], []
    with open(path) as file:
        for kind, *fields in (line.split() for line in file if line[:2] in ("v ", "f ")):
            if kind == "v":
                vertices.append(fields[:3])
                continue
            numbers = [int(field.split("/")[0]) for field in fields]
            # Negative ones count back from the last vertex so far.
            faces.append([n + len(vertices) if n < 0 else n - 1 for n in numbers])
    return np.array(vertices, float), np.array(faces, int)


def areas(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def solid_angles(points, faces):
    """Of spherical triangles, positive when counter-clockwise seen from outside."""
    a, b, c = (points[faces[:, i]] for i in range(3))
    triple = np.einsum("ij,ij->i", a, np.cross(b - a, c - a))
    dots = sum(np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    return 2 * np.arctan2(triple, 1 + dots)


def log_area_ratios(points, faces, surface_shares):
    """log(share of the sphere / share of the surface) of each face."""
    return np.log(np.abs(solid_angles(points, faces)) / (4 * np.pi) / surface_shares)
