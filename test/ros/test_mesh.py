"""Texture coordinates of a head: every face of the sphere gets its share of the surface."""

import os

import numpy as np
import rospkg

from node_client import PACKAGE, NodeTest
from scenes import angle_spring, particle, positions, solid_angle_spring, solid_angles


def data(name):
    return os.path.join(rospkg.RosPack().get_path(PACKAGE), '..', 'shared', 'data', name)


SURFACE, START = data('maxplanck.obj'), data('maxplanck_sphere.obj')


def read_obj(path):
    """Vertices, and faces as indices of vertices."""
    rows = {'v': [], 'f': []}
    with open(path) as file:
        for kind, *fields in map(str.split, file):
            rows[kind].append([float(field) for field in fields])
    return np.array(rows['v']), np.array(rows['f'], int) - 1


def areas(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def edges_of(faces):
    edges = np.concatenate([faces[:, pair] for pair in ((0, 1), (1, 2), (2, 0))])
    return np.unique(np.sort(edges), axis=0)


class TestMesh(NodeTest):
    def test_faces_get_their_shares_of_the_sphere(self):
        if not (os.path.exists(SURFACE) and os.path.exists(START)):
            self.skipTest('there is no %s here' % SURFACE)
        surface, faces = read_obj(SURFACE)
        start, _ = read_obj(START)
        wanted = areas(surface, faces)
        wanted *= 4 * np.pi / wanted.sum()

        ids = np.array(self.node.add_particles([particle(p) for p in start]).ids)
        # Areas alone leave half of the freedom; very weak arcs take it without spoiling them.
        self.node.add_springs(
            solid_angle_springs=[solid_angle_spring(f.tolist(), rest_solid_angle=share)
                                 for f, share in zip(ids[faces], wanted)],
            angle_springs=[angle_spring(edge.tolist(), 1e-6, at_rest=True)
                           for edge in ids[edges_of(faces)]])
        outcome = self.node.relax()
        self.assertTrue(outcome.converged, outcome.message)

        corners = positions(self.node.get_scene())[faces]
        shares = solid_angles(*np.moveaxis(corners, 1, 0))
        self.assertGreater(shares.min(), 0)
        self.assertAlmostEqual(4 * np.pi, shares.sum(), delta=1e-9)
        self.assertLess(np.std(np.log(shares / wanted)), 0.03)
