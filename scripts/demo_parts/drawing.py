"""Spheres, arcs and meshes as a distant eye sees them, in matplotlib."""
import mesh
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Circle

BALL = np.array([(-1.0, -1.0, 0.0), (1.0, 1.0, 0.0)])  # corners of what is seen of the sphere
INK = (0.13, 0.16, 0.2)
LIGHT = mesh.unit(np.array([-0.45, 0.55, 0.7]))  # right, up, towards the eye


class Eye:
    """Looks at the origin from one direction, with z up."""

    def __init__(self, direction):
        towards = mesh.unit(np.array(direction, float))
        right = mesh.unit(np.cross((0, 0, 1), towards))
        self.axes = np.stack([right, np.cross(towards, right), towards], axis=1)

    def see(self, points):
        """Right, up, and towards the eye."""
        return points @ self.axes


def prepare(axes, seen):
    """No frame, and room for all that is seen."""
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    half_width = 0.525 * (high - low).max()
    x, y = (low + high) / 2
    axes.set_aspect("equal")
    axes.set_xlim(x - half_width, x + half_width)
    axes.set_ylim(y - half_width, y + half_width)
    axes.axis("off")


def rim(axes):
    """The outline of the unit sphere."""
    return axes.add_patch(Circle((0, 0), 1, facecolor="none", edgecolor=INK, linewidth=0.7,
                                 zorder=3))


def ball(axes, eye, colour, pixels=300):
    """The unit sphere, shaded, with its net."""
    x, y = np.meshgrid(*2 * [np.linspace(-1, 1, pixels)])
    z = np.sqrt(np.clip(1 - x ** 2 - y ** 2, 0, 1))
    shade = 0.72 + 0.28 * np.clip(np.stack([x, y, z], axis=2) @ LIGHT, 0, 1)
    image = np.clip(shade[..., None] * colour, 0, 1)
    disc = axes.imshow(image, extent=(-1, 1, -1, 1), origin="lower", interpolation="bilinear")
    disc.set_clip_path(rim(axes))
    net(axes, eye)


def net(axes, eye):
    """Meridians and parallels every 30 degrees."""
    turn = np.linspace(-np.pi, np.pi, 181)
    for angle in np.radians(np.arange(-60, 90, 30)):
        parallel = np.stack([np.cos(angle) * np.cos(turn), np.cos(angle) * np.sin(turn),
                             np.full_like(turn, np.sin(angle))], axis=1)
        curve(axes, eye.see(parallel), "white", 0.5)
    for angle in np.radians(np.arange(0, 180, 30)):
        meridian = np.stack([np.cos(turn) * np.cos(angle), np.cos(turn) * np.sin(angle),
                             np.sin(turn)], axis=1)
        curve(axes, eye.see(meridian), "white", 0.5)


def curve(axes, seen, colour, width):
    """The part of a line on the sphere that faces the eye."""
    pieces = np.stack([seen[:-1], seen[1:]], axis=1)
    front = pieces[:, :, 2].mean(axis=1) > 0
    axes.add_collection(LineCollection(pieces[front][:, :, :2], colors=[colour],
                                       linewidths=width, capstyle="round"))


def great_circle(a, b, count=60):
    weights = np.linspace(0, 1, count)[:, None]
    angle = np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)
    return (np.sin((1 - weights) * angle) * a + np.sin(weights * angle) * b) / np.sin(angle)


def surface(axes, eye, points, faces, lines, colours):
    """The faces that face the eye, the far ones first, and lines that run through vertices."""
    seen = eye.see(points)
    corners = seen[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    front = normals[:, 2] > 0
    corners, colours = corners[front], colours[front]

    sides = np.stack([lines[:, :-1], lines[:, 1:]], axis=2).reshape(-1, 2)
    near = np.zeros(len(points), bool)
    near[faces[front].ravel()] = True
    sides = sides[near[sides].all(axis=1)]
    # A triangle of no area is a line, and takes its turn among the faces.
    strokes = seen[sides[:, [0, 1, 1]]]

    depths = np.concatenate([corners[:, :, 2].mean(axis=1), strokes[:, :, 2].mean(axis=1) + 0.08])
    order = np.argsort(depths)
    ink = np.tile((*INK, 1), (len(strokes), 1))
    widths = np.repeat([0.3, 0.5], [len(corners), len(strokes)])
    painted = np.concatenate([colours, ink])[order]
    axes.add_collection(PolyCollection(
        np.concatenate([corners, strokes])[order][:, :, :2], facecolors=painted,
        edgecolors=painted, linewidths=widths[order]))


def lit(eye, points, faces, colour):
    """Colours of the faces of a surface in one colour, by the light that falls on them."""
    corners = eye.see(points)[faces]
    normals = mesh.unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    shade = 0.45 + 0.55 * np.clip(normals @ LIGHT, 0, 1)
    return np.concatenate([shade[:, None] * colour, np.ones((len(faces), 1))], axis=1)
