"""A bumpy mesh of unequal areas, relaxed on the sphere until each face has its fair share."""
import collections
import time

import mesh
import numpy as np
from geometry_msgs.msg import Point
from spherical_springs.msg import AngleSpring, Particle, SolidAngleSpring
from spherical_springs.srv import AddParticles, AddSprings, Relax
from std_srvs.srv import Trigger

AREA_STIFFNESS = 1.0  # [J/sr^2]
ARC_STIFFNESS = 1e-6  # [J/rad^2]
MAX_TIME = 60.0  # [s]

Relaxed = collections.namedtuple("Relaxed", "surface faces lines before after")
Map = collections.namedtuple("Map", "points log_ratios")


def particles_at(points):
    return [Particle(position=Point(*point)) for point in points.tolist()]


def arcs_at_rest(pairs):
    return [AngleSpring(particles=pair, stiffness=ARC_STIFFNESS, at_rest=True)
            for pair in pairs.tolist()]


def triangles_of(triples, rest_solid_angles):
    return [SolidAngleSpring(particles=triple, stiffness=AREA_STIFFNESS, rest_solid_angle=rest)
            for triple, rest in zip(triples.tolist(), rest_solid_angles.tolist())]


def send(node, points, edges, faces, shares):
    """The whole scene in two calls."""
    node.call("clear", Trigger)
    ids = np.array(node.call("add_particles", AddParticles, particles=particles_at(points)).ids)
    node.call("add_springs", AddSprings,
              angle_springs=arcs_at_rest(ids[edges]),
              solid_angle_springs=triangles_of(ids[faces], 4 * np.pi * shares))


def relax(node):
    """Makes the mesh, sends it, relaxes it, and prints and returns what became of it."""
    print("\n2. A bumpy mesh on the sphere: solid-angle springs at the faces' shares of 4 pi,")
    print("   and weak angle springs at rest on the edges\n")
    start, faces, lines = mesh.icosphere(levels=5, line_level=3)
    surface = mesh.bumpy(start)
    edges = mesh.edges_of(faces)
    areas = mesh.areas(surface, faces)
    shares = areas / areas.sum()
    print("   mesh                {:,} vertices, {:,} faces".format(len(start), len(faces)))

    begin = time.monotonic()
    send(node, start, edges, faces, shares)
    print("   sent                {:,} particles, {:,} angle springs, {:,} solid-angle springs "
          "in {:.2f} s".format(len(start), len(edges), len(faces), time.monotonic() - begin))

    result = node.call("relax", Relax, max_time=MAX_TIME)
    end = node.positions()
    before, after = (Map(points, mesh.log_area_ratios(points, faces, shares))
                     for points in (start, end))
    folded = [np.count_nonzero(mesh.solid_angles(m.points, faces) <= 0) for m in (before, after)]
    print("   relaxed             %d iterations of Newton's method, %.2f s: %s" % (
        result.iterations, result.wall_time, result.message))
    print("\n                       before        after")
    print("   spread of areas     %-12.4f  %.4f     (std of log of share on sphere / on surface)" %
          (before.log_ratios.std(), after.log_ratios.std()))
    print("   energy [J]          %-12.3e  %.3e" % (result.energy_before, result.energy_after))
    print("   folded triangles    %-12d  %d" % tuple(folded))
    if not result.converged:
        raise RuntimeError("the mesh did not come to rest")
    return Relaxed(surface, faces, lines, before, after)
