"""Closed surfaces, and texts of files that hold none."""

import os
import sys

import numpy as np
import rospkg

from node_client import PACKAGE

sys.path.append(os.path.join(rospkg.RosPack().get_path(PACKAGE), 'scripts', 'demo_parts'))
import mesh  # noqa: E402

CORNERS = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
TETRAHEDRON = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])


def bumpy(levels=3):
    directions, faces, _ = mesh.icosphere(levels, levels)
    return mesh.bumpy(directions), faces


def star(levels=4, arms=5, length=3):
    """Long arms round a middle."""
    directions, faces, _ = mesh.icosphere(levels, levels)
    turn = 2 * np.pi * np.arange(arms) / arms
    towards = np.stack([np.cos(turn), np.sin(turn), np.zeros(arms)], axis=1)
    radius = 1 + length * np.exp(12 * (directions @ towards.T - 1)).sum(axis=1)
    return directions * radius[:, None], faces


def double_pyramid(count):
    """Two vertices of so many faces."""
    turn = 2 * np.pi * np.arange(count) / count
    rim = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    here = np.arange(2, count + 2)
    following = np.roll(here, -1)
    faces = [np.stack([0 * here, here, following], axis=1),
             np.stack([0 * here + 1, following, here], axis=1)]
    return np.concatenate([[(0, 0, 1), (0, 0, -1)], rim]), np.concatenate(faces)


def torus(count=6):
    i, j = np.meshgrid(np.arange(count), np.arange(count))
    big, small = 2 * np.pi * i.ravel() / count, 2 * np.pi * j.ravel() / count
    vertices = np.stack([(2 + np.cos(small)) * np.cos(big), (2 + np.cos(small)) * np.sin(big),
                         np.sin(small)], axis=1)

    def at(di, dj):
        return ((i + di) % count + count * ((j + dj) % count)).ravel()

    lower = np.stack([at(0, 0), at(1, 0), at(1, 1)], axis=1)
    upper = np.stack([at(0, 0), at(1, 1), at(0, 1)], axis=1)
    return vertices, np.concatenate([lower, upper])


def projective_plane():
    """Six vertices, no inside: the icosahedron with opposite points made one."""
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1),
             (1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)]
    return np.random.RandomState(1).normal(size=(6, 3)), np.array(faces)


def obj(vertices, faces):
    return ''.join(['v %.17g %.17g %.17g\n' % tuple(v) for v in vertices] +
                   ['f' + ''.join(' %d' % (i + 1) for i in face) + '\n' for face in faces])


def _broken():
    vertices, faces = bumpy(1)
    points = np.random.RandomState(2).normal(size=(7, 3))
    flipped = faces.copy()
    flipped[3] = flipped[3, ::-1]
    doubled = faces.copy()
    doubled[3, 1] = doubled[3, 0]
    text = obj(vertices, faces)

    def with_coordinate(value):
        changed = vertices.copy()
        changed[1, 2] = value
        return obj(changed, faces), 'line 2: a vertex is not three finite numbers'

    return {
        'open': (obj(vertices, faces[1:]), 'open: it has 1 hole, of 3 edges; edge .* has no face but'),
        'flipped': (obj(vertices, flipped), 'runs the same way in the face of line'),
        'not orientable': (obj(*projective_plane()), 'runs the same way in the face of line'),
        'joined at a vertex': (obj(points, np.concatenate([TETRAHEDRON, TETRAHEDRON + 3])),
                               '2 pieces, of 4 and 4 faces'),
        'joined at an edge': (
            obj(points[:6], np.concatenate([TETRAHEDRON, np.array([0, 1, 4, 5])[TETRAHEDRON]])),
            'edge 1-2 from .* runs the same way in the face of line'),
        'several pieces': (obj(np.concatenate([vertices, vertices + 9]),
                               np.concatenate([faces, faces + len(vertices)])), '2 pieces'),
        'torus': (obj(*torus()), 'genus 1'),
        'degenerate': (obj(vertices, doubled), 'the face of line 46 has one vertex twice; --weld'),
        'no area': (obj(0 * vertices, faces), 'the areas of all faces are 0'),
        'three faces': (obj(points[:4], TETRAHEDRON[:3]), 'number of faces is 3; allowed: 4 or more'),
        'two corners': (text + 'f 1 2\n', 'line 123: a face has 2 corners; allowed: 3 or more'),
        'nan': with_coordinate(np.nan),
        'infinite': with_coordinate(np.inf),
        'empty': ('', 'not an OBJ file'),
        'truncated': (text[:-20], 'a face has|not the number of a vertex|is open'),
        'truncated vertices': (text[:300], 'three finite numbers|no face'),
        'binary': (bytes(range(256)) * 99, 'not an OBJ file'),
    }


# Name: the file's text or bytes, and a pattern of the reason why it is refused.
BROKEN = _broken()
