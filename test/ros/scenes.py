"""Messages that describe scenes, and what they should come to."""

import io
import math

import numpy as np
from geometry_msgs.msg import Point, Vector3
from spherical_springs.msg import AngleSpring, OrientedAngleSpring, Particle, SolidAngleSpring

KINDS = ('angle_springs', 'solid_angle_springs', 'oriented_angle_springs')
OCTANT_CORNERS = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def particle(position, angular_velocity=(0, 0, 0), **fields):
    return Particle(position=Point(*position), angular_velocity=Vector3(*angular_velocity),
                    **fields)


def angle_spring(particles, stiffness=1, **fields):
    return AngleSpring(particles=particles, stiffness=stiffness, **fields)


def solid_angle_spring(particles, stiffness=1, **fields):
    return SolidAngleSpring(particles=particles, stiffness=stiffness, **fields)


def oriented_angle_spring(particles, stiffness=1, **fields):
    return OrientedAngleSpring(particles=particles, stiffness=stiffness, **fields)


def springs_of(message):
    """The three arrays of springs of a message, by name."""
    return {kind: getattr(message, kind) for kind in KINDS}


def ids_of(message):
    """The three arrays of ids of springs of a message, by name."""
    return {kind: list(getattr(message, kind[:-1] + '_ids')) for kind in KINDS}


def same_ids(ids):
    """Ids by kind as the fields of a request."""
    return {kind[:-1] + '_ids': ids[kind] for kind in KINDS}


def add_octant(node, damping):
    """Figure 3 of the report: from somewhere to three right angles. Return the ids."""
    particles = [particle(p, damping=damping)
                 for p in ((1, 0.15, 0.05), (0.9, 0.5, 0.1), (0.9, 0.1, 0.5))]
    ids = node.add_particles(particles).ids
    node.add_springs(angle_springs=[
        angle_spring([a, b], rest_angle=math.pi / 2) for a, b in zip(ids, ids[1:] + ids[:1])])
    return ids


def add_mixed_octant(node):
    """Springs of all kinds that do not agree on the shape of an octant, some damped."""
    ids = add_octant(node, damping=0.05)
    node.add_springs(
        angle_springs=[angle_spring(ids[:2], damping=0.2)],
        solid_angle_springs=[solid_angle_spring(ids, rest_solid_angle=2, damping=0.1)],
        oriented_angle_springs=[oriented_angle_spring(ids, rest_angle=1, width=1, damping=0.1)])
    return ids


def random_particles(generator, count):
    return [particle(generator.normal(size=3), generator.normal(size=3),
                     mass=generator.uniform(0.5, 2), damping=generator.choice([0, 0.1]),
                     pinned=bool(generator.random() < 0.1))
            for _ in range(count)]


def random_springs(generator, ids, count):
    """As many springs of each kind, with every field at random, as arguments of add_springs."""
    def ends(number):
        first = generator.integers(len(ids))
        gaps = generator.integers(1, len(ids) // number + 1, size=number - 1)
        return [ids[(first + gap) % len(ids)] for gap in (0, *np.cumsum(gaps))]

    def common():
        return {'stiffness': generator.uniform(0.5, 2), 'damping': generator.choice([0, 0.1]),
                'at_rest': bool(generator.random() < 0.3)}

    return {
        'angle_springs': [
            angle_spring(ends(2), rest_angle=generator.uniform(0, math.pi), **common())
            for _ in range(count)],
        'solid_angle_springs': [
            solid_angle_spring(ends(3), rest_solid_angle=generator.uniform(-6, 6), **common())
            for _ in range(count)],
        'oriented_angle_springs': [
            oriented_angle_spring(ends(3), rest_angle=generator.uniform(-3, 3),
                                  width=generator.choice([0, 0.3]), **common())
            for _ in range(count)],
    }


def add_random_scene(node, seed, particles=20, springs=30):
    generator = np.random.default_rng(seed)
    ids = node.add_particles(random_particles(generator, particles)).ids
    node.add_springs(**random_springs(generator, ids, springs))


def add_knot(node, particles=2500):
    """A tangle; one of thousands takes far longer to relax than any test lasts."""
    generator = np.random.default_rng(1)
    ids = node.add_particles([particle(p) for p in generator.normal(size=(particles, 3))]).ids
    ends = generator.integers(particles, size=3 * particles)
    others = (ends + generator.integers(1, particles, size=ends.size)) % particles
    node.add_springs(angle_springs=[
        angle_spring([ids[a], ids[b]], rest_angle=1) for a, b in zip(ends, others)])


def exact(messages):
    """Texts, in the same lists and dictionaries, that differ where any bit of any number does."""
    if isinstance(messages, dict):
        return {name: exact(value) for name, value in messages.items()}
    if isinstance(messages, list):
        return [exact(message) for message in messages]
    # Once over the wire, so that numbers have their types; then Python writes them out in full.
    wire = io.BytesIO()
    messages.serialize(wire)
    return str(type(messages)().deserialize(wire.getvalue()))


def vector(message):
    return np.array([message.x, message.y, message.z])


def positions(scene):
    return np.array([vector(p.position) for p in scene.particles])


def angular_velocities(scene):
    return np.array([vector(p.angular_velocity) for p in scene.particles])


def masses(scene):
    return np.array([p.mass for p in scene.particles])


def angle(a, b):
    """Of the arc between two unit vectors."""
    return math.atan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b))


def solid_angles(a, b, c):
    """Signed areas of spherical triangles, a corner a row (Oosterom and Strackee 1983)."""
    triple_product = np.sum(a * np.cross(b - a, c - a), axis=-1)
    denominator = 1 + np.sum(a * b, axis=-1) + np.sum(b * c, axis=-1) + np.sum(c * a, axis=-1)
    return 2 * np.arctan2(triple_product, denominator)


def orientation(a, b, c, width):
    """The sign of an oriented-angle spring, which changes smoothly over the width."""
    u = np.clip(np.dot(a, np.cross(b, c)) / width, -1, 1)
    return u * (15 - 10 * u ** 2 + 3 * u ** 4) / 8


def energies(scene):
    """What the springs of each kind hold and the particles carry, by the definitions."""
    places = dict(zip(scene.particle_ids, positions(scene)))

    def stored(springs, deviation):
        return sum(s.stiffness * deviation(s, *[places[i] for i in s.particles]) ** 2 / 2
                   for s in springs)

    def oriented_deviation(spring, a, b, c):
        width = spring.width or 0.2 * math.sin(spring.rest_angle / 2) ** 2
        return orientation(a, b, c, width) * angle(a, b) - spring.rest_angle

    return {
        'angle': stored(scene.angle_springs, lambda s, a, b: angle(a, b) - s.rest_angle),
        'solid_angle': stored(
            scene.solid_angle_springs,
            lambda s, *corners: math.remainder(
                solid_angles(*corners) - s.rest_solid_angle, 4 * math.pi)),
        'oriented_angle': stored(scene.oriented_angle_springs, oriented_deviation),
        'kinetic': np.sum(masses(scene) * np.sum(angular_velocities(scene) ** 2, axis=1)) / 2,
    }
