"""Two uses of the node, with a picture of each; scripts/uses_pictures sets up what this needs."""
import collections
import itertools
import os
import signal
import sys

import mesh
import node
import numpy as np
import rospy
import uses_picture
from geometry_msgs.msg import Point
from octant import arc
from spherical_springs.msg import AngleSpring, Particle
from spherical_springs.srv import AddParticles, AddSprings, Relax
from std_srvs.srv import Trigger

LOG = "build/uses.log"
DIRECTIONS = 30
ERROR = np.radians(0.2)  # standard deviation of a measured angle [rad]
MOUNTING = np.radians(7)  # standard deviation of a camera's place, each way [rad]

Relaxed = collections.namedtuple("Relaxed", "before after")
Rig = collections.namedtuple("Rig", "pairs measured before after")


def angles(points, pairs):
    return np.array([arc(points[a], points[b]) for a, b in pairs])


def relaxed(springs, starts, pairs, rest_angles, stiffness, pinned=()):
    """Where the particles come to from their starts."""
    springs.call("clear", Trigger)
    particles = [Particle(position=Point(*start), pinned=i in pinned)
                 for i, start in enumerate(starts)]
    ids = springs.call("add_particles", AddParticles, particles=particles).ids
    springs.call("add_springs", AddSprings, angle_springs=[
        AngleSpring(particles=(ids[a], ids[b]), rest_angle=angle, stiffness=stiffness)
        for (a, b), angle in zip(pairs, rest_angles)])
    outcome = springs.call("relax", Relax)
    if not outcome.converged:
        raise RuntimeError(outcome.message)
    return springs.positions()


def spread_directions(springs):
    """Springs of rest angle pi between all pairs push the directions apart."""
    starts = mesh.unit(np.random.RandomState(4).normal(size=(DIRECTIONS, 3)))
    pairs = list(itertools.combinations(range(DIRECTIONS), 2))
    return Relaxed(starts, relaxed(springs, starts, pairs, np.full(len(pairs), np.pi), 1.0))


def fit_angles(springs):
    """Six cameras as drawn, and as 15 measured angles have them; the first one is pinned."""
    random = np.random.RandomState(7)
    turns = np.radians(72) * np.arange(5)
    around = np.stack([np.cos(turns), np.sin(turns), np.full(5, np.tan(np.radians(40)))], axis=1)
    drawn = mesh.unit(np.concatenate([[(0, 0, 1)], around]))
    built = mesh.unit(drawn + MOUNTING * random.normal(size=drawn.shape))
    pairs = list(itertools.combinations(range(len(drawn)), 2))
    measured = angles(built, pairs) + ERROR * random.normal(size=len(pairs))
    fitted = relaxed(springs, drawn, pairs, measured, ERROR ** -2, pinned=[0])
    return Rig(pairs, measured, drawn, fitted)


def interrupted(number, _):
    sys.exit("uses: stopped by " + signal.Signals(number).name)


def main():
    directory = sys.argv[1]
    for number in node.INTERRUPTIONS:
        signal.signal(number, interrupted)
    try:
        with node.launched("spherical_springs.launch", "running:=false", log=LOG) as springs:
            directions = spread_directions(springs)
            rig = fit_angles(springs)
    except (RuntimeError, rospy.ROSException, rospy.ServiceException) as fault:
        sys.exit("uses: %s; more is in %s" % (fault, LOG))
    uses_picture.save_directions(os.path.join(directory, "directions.png"), directions)
    uses_picture.save_angles(os.path.join(directory, "angles.png"), rig,
                             [angles(p, rig.pairs) for p in (rig.before, rig.after)])
    print("The pictures are directions.png and angles.png in %s" % directory)


main()
