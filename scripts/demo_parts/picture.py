"""The picture of both parts of the demo."""
import drawing
import mesh
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from octant import SIDES

WIDTH, HEIGHT = 12.0, 7.95  # [in]
STONE = np.array([0.80, 0.84, 0.89])
ARC_COLOURS = ("#0072b2", "#d55e00", "#009e73")  # Okabe and Ito's, for every kind of eye
MESH_EYE = (0.6, -1.0, 0.4)


def place(figure, left, bottom, size):
    """A square, all in inches."""
    return figure.add_axes([left / WIDTH, bottom / HEIGHT, size / WIDTH, size / HEIGHT])


def heading(figure, bottom, text):
    figure.text(0.35 / WIDTH, bottom / HEIGHT, text, fontsize=13, fontweight="bold",
                color=drawing.INK)


def draw_moment(axes, eye, moment):
    drawing.prepare(axes, drawing.BALL)
    drawing.ball(axes, eye, STONE)
    for index, ((a, b), colour) in enumerate(zip(SIDES, ARC_COLOURS)):
        line = drawing.great_circle(moment.points[a], moment.points[b])
        drawing.curve(axes, eye.see(line), colour, 2.4)
        axes.text(0.62 * (index - 1), -1.12, "%.0f°" % np.degrees(moment.arcs[index]),
                  ha="center", va="top", color=colour, fontsize=11)
    seen = eye.see(moment.points)
    seen = seen[seen[:, 2] > 0]
    axes.plot(seen[:, 0], seen[:, 1], "o", color=drawing.INK, markersize=5, zorder=4)
    axes.set_title("%g s" % round(moment.time, 3), fontsize=11)


def draw_octant(figure, moments):
    heading(figure, 7.55, "Three damped angle springs of rest angle 90° open into an octant")
    eye = drawing.Eye(mesh.unit(moments[-1].points.sum(axis=0)))
    size = 1.85
    for index, moment in enumerate(moments):
        draw_moment(place(figure, 0.3 + index * (size + 0.06), 5.25, size), eye, moment)


def draw_relaxation(figure, relaxed):
    heading(figure, 4.45, "A map gives each face of a mesh of {:,} vertices its fair share of the "
            "sphere".format(len(relaxed.surface)))
    eye = drawing.Eye(MESH_EYE)
    size = 3.5
    surface, before, after = (place(figure, 0.25 + i * (size + 0.05), 0.35, size)
                              for i in range(3))

    drawing.prepare(surface, eye.see(relaxed.surface))
    colours = drawing.lit(eye, relaxed.surface, relaxed.faces, STONE)
    drawing.surface(surface, eye, relaxed.surface, relaxed.faces, relaxed.lines, colours)
    surface.set_title("the surface", fontsize=11)

    limit = np.abs(relaxed.before.log_ratios).max()
    scale = ScalarMappable(Normalize(-limit, limit), "RdBu_r")
    scale.set_array([])
    for axes, name, state in ((before, "before", relaxed.before), (after, "after", relaxed.after)):
        drawing.prepare(axes, drawing.BALL)
        drawing.rim(axes)
        drawing.surface(axes, eye, state.points, relaxed.faces, relaxed.lines,
                        scale.to_rgba(state.log_ratios))
        axes.set_title("on the sphere, %s: spread %.3f" % (name, state.log_ratios.std()),
                       fontsize=11)
    bar = figure.add_axes([11.0 / WIDTH, 0.7 / HEIGHT, 0.16 / WIDTH, 2.8 / HEIGHT])
    figure.colorbar(scale, cax=bar).set_label("log (share of the sphere / of the surface)")


def save(path, moments, relaxed):
    figure = Figure(figsize=(WIDTH, HEIGHT))
    draw_octant(figure, moments)
    draw_relaxation(figure, relaxed)
    figure.savefig(path, dpi=120, facecolor="white")
