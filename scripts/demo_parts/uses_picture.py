"""Pictures of directions that spread and of angles that are kept."""
import io

import drawing
import mesh
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from PIL import Image
from picture import ARC_COLOURS, STONE

EYE = drawing.Eye((0.6, -1.0, 0.5))
ABOVE = drawing.Eye((0.12, -0.25, 1.0))
PIXELS = 420  # of a sphere
SAMPLES = 100000  # by which areas of cells are measured
BORDER = 0.008  # half the width of the lines between cells
CLOSE = np.radians(0.5)
TOO_NARROW, TOO_WIDE = ARC_COLOURS[:2]


def even_samples(count):
    """Points on a spiral from pole to pole, each with the same share of the sphere."""
    index = np.arange(count) + 0.5
    z, longitude = 1 - 2 * index / count, 2 * np.pi * index / mesh.GOLDEN
    radius = np.sqrt(1 - z ** 2)
    return np.stack([radius * np.cos(longitude), radius * np.sin(longitude), z], axis=1)


def cell_shares(points):
    """Areas of the cells of all that is nearest to one point each, beside the mean."""
    nearest = (even_samples(SAMPLES) @ points.T).argmax(axis=1)
    return np.bincount(nearest, minlength=len(points)) * len(points) / SAMPLES


def nearest_neighbours(points):
    """The angle from each point to the next one [deg]."""
    cosines = points @ points.T - 3 * np.eye(len(points))
    return np.degrees(np.arccos(cosines.max(axis=1)))


def save(path, figure):
    """A third of the bytes that a PNG of full colour takes."""
    full = io.BytesIO()
    figure.savefig(full, dpi=100, facecolor="white")
    Image.open(full).convert("RGB").quantize(256).save(path, optimize=True)


def draw_cells(axes, points, scale):
    drawing.prepare(axes, drawing.BALL)
    x, y = np.meshgrid(*2 * [np.linspace(-1, 1, PIXELS)])
    inside = x ** 2 + y ** 2 <= 1
    z = np.sqrt(np.where(inside, 1 - x ** 2 - y ** 2, 0))
    cosines = np.stack([x, y, z], axis=2) @ EYE.see(points).T
    order = np.argsort(-cosines, axis=2)
    nearest, second = order[:, :, 0], order[:, :, 1]
    colours = scale.to_rgba(cell_shares(points))[nearest, :3]
    ordered = np.take_along_axis(cosines, order, axis=2)
    from_border = ((ordered[:, :, 0] - ordered[:, :, 1])
                   / np.linalg.norm(points[nearest] - points[second], axis=2))
    colours[from_border < BORDER] = drawing.INK
    image = axes.imshow(colours, extent=(-1, 1, -1, 1), origin="lower")
    image.set_clip_path(drawing.rim(axes))
    seen = EYE.see(points)
    seen = seen[seen[:, 2] > 0]
    axes.plot(seen[:, 0], seen[:, 1], "o", color=drawing.INK, markersize=5, zorder=4)


def save_directions(path, directions):
    figure = Figure(figsize=(8.4, 3.9))
    left, right = figure.subplots(1, 2)
    figure.subplots_adjust(0.01, 0.02, 0.86, 0.87, 0.02)
    scale = ScalarMappable(LogNorm(1 / 3, 3), "RdBu_r")
    for axes, name, points in ((left, "random", directions.before),
                               (right, "relaxed", directions.after)):
        draw_cells(axes, points, scale)
        neighbours = nearest_neighbours(points)
        axes.set_title("%d directions, %s:\nthe nearest one is %.0f° to %.0f° away" % (
            len(points), name, neighbours.min(), neighbours.max()), fontsize=11)
    bar = figure.colorbar(scale, cax=figure.add_axes([0.89, 0.12, 0.018, 0.65]),
                          ticks=[1 / 3, 1, 3], format="%.2g")
    bar.ax.minorticks_off()
    bar.set_label("area of a cell / mean")
    save(path, figure)


def colour_of(error):
    if abs(error) < CLOSE:
        return drawing.INK
    return TOO_WIDE if error > 0 else TOO_NARROW


def draw_rig(axes, rig, points, errors):
    drawing.prepare(axes, drawing.BALL)
    axes.add_patch(Circle((0, 0), 1, facecolor=STONE, edgecolor=drawing.INK, linewidth=0.7,
                          zorder=0))
    drawing.net(axes, ABOVE)
    for (a, b), error in zip(rig.pairs, errors):
        line = ABOVE.see(drawing.great_circle(points[a], points[b]))
        axes.plot(line[:, 0], line[:, 1], color=colour_of(error), linewidth=1.6)
    for place, was in zip(ABOVE.see(points), ABOVE.see(rig.before)):
        axes.plot(was[0], was[1], "o", color="white", markeredgecolor=drawing.INK, markersize=7,
                  zorder=4)
        axes.annotate("", place[:2], was[:2], zorder=4, arrowprops={"arrowstyle": "-"})
    for index, place in enumerate(ABOVE.see(points)):
        axes.text(place[0], place[1], str(index), color="white", fontsize=10, fontweight="bold",
                  ha="center", va="center", zorder=6,
                  bbox={"boxstyle": "square" if index == 0 else "circle",
                        "facecolor": drawing.INK, "edgecolor": "none"})


def save_angles(path, rig, present):
    figure = Figure(figsize=(8.4, 4.4))
    for axes, name, points, angles in zip(
            figure.subplots(1, 2), ("as drawn", "relaxed"), (rig.before, rig.after), present):
        errors = angles - rig.measured
        draw_rig(axes, rig, points, errors)
        axes.set_title("six cameras, %s: 15 measured\nangles are off by %.2g° (rms)" % (
            name, np.degrees(np.sqrt((errors ** 2).mean()))), fontsize=11)
    figure.subplots_adjust(0.01, 0.11, 0.99, 0.88, 0.02)
    lines = [Line2D([], [], color=colour, linewidth=2)
             for colour in (TOO_WIDE, TOO_NARROW, drawing.INK)]
    figure.legend(lines, ["wider than measured", "narrower", "within 0.5°"], ncol=3,
                  loc="lower center", frameon=False)
    save(path, figure)
