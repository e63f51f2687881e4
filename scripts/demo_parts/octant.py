"""Figure 3 of the report: three damped angle springs of rest angle pi/2 open into an octant."""
import collections

import numpy as np
from spherical_springs.srv import Step

TIMES = (0.0, 1.5, 3.0, 5.0, 8.0, 200.0)  # [s]
TIME_STEP = 0.001  # [s], the node's default
SIDES = ((0, 1), (1, 2), (2, 0))

Moment = collections.namedtuple("Moment", "time points arcs")


def arc(a, b):
    return np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)


def watch(node):
    """Steps the scene of octant.launch from moment to moment, and prints and returns these."""
    print("\n1. Three particles, three damped angle springs of rest angle 90 deg (figure 3)\n")
    print("   time      arcs [deg]                      kinetic    potential  dissipated")
    print("   [s]       0-1       1-2       2-0         [J]        [J]        [J]")
    moments = []
    steps_done = 0
    for time in TIMES:
        steps = round(time / TIME_STEP)
        step = node.call("step", Step, steps=steps - steps_done)
        steps_done = steps
        points = node.positions()
        arcs = [arc(points[a], points[b]) for a, b in SIDES]
        moments.append(Moment(step.time, points, arcs))
        energies = step.energies
        print("   %6.2f %8.3f  %8.3f  %8.3f     %10.3e %10.3e %10.3e" % (
            step.time, *np.degrees(arcs), energies.kinetic, energies.potential,
            energies.dissipated))
    error = np.abs(np.array(arcs) - np.pi / 2).max()
    print("\n   at the end each arc is a right angle to within %.0e rad" % error)
    if error > 1e-10:
        raise RuntimeError("the triangle did not come to rest as an octant")
    return moments
