"""A mesh on the sphere as springs of the node."""
import numpy as np
from geometry_msgs.msg import Point
from spherical_springs.msg import AngleSpring, Particle, SolidAngleSpring
from spherical_springs.srv import AddParticles, AddSprings
from std_srvs.srv import Trigger

AREA_STIFFNESS = 1.0  # [J/sr^2]
ARC_STIFFNESS = 1e-6  # [J/rad^2]


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
