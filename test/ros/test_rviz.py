"""What RViz shows of ~markers, looked at pixel by pixel.

Three of the pictures that this leaves, side by side, are doc/rviz.png.
"""

import math
import os
import sys
import unittest

import numpy as np
import rospkg

from node_client import PACKAGE, NodeClient, wait_until
from rviz_window import MISSING, Window, name_of, visible
from scenes import angle_spring, particle, positions, solid_angle_spring

sys.path.append(os.path.join(rospkg.RosPack().get_path(PACKAGE), 'scripts', 'demo_parts'))
import mesh  # noqa: E402


PICTURES = rospkg.get_test_results_dir()  # where they stay to be looked at


def middle(*points):
    total = np.sum(points, axis=0)
    return total / np.linalg.norm(total)


@unittest.skipIf(MISSING, 'not installed: ' + ', '.join(MISSING))
class TestRViz(unittest.TestCase):
    def assert_shows(self, window, expected, name):
        """Wait for the sphere, and on it colours by name at some points; save the picture."""
        def missing(picture):
            if not picture.is_drawn:
                return 'the view'
            if not picture.has_sphere():
                return 'the sphere'
            return [(point, colour, picture.colour_at(point)) for point, colour in expected
                    if name_of(picture.colour_at(point)) != colour]

        try:
            picture = wait_until(lambda: next(
                (p for p in [window.picture()] if not missing(p)), None))
        except AssertionError:
            self.fail('missing: %s' % missing(window.picture()))
        os.makedirs(PICTURES, exist_ok=True)
        picture.save(os.path.join(PICTURES, name + '.png'))

    def corners_and_arcs(self, node, colour):
        places = positions(node.get_scene())
        centre = middle(*places)
        # Beside the arcs, which hide the middle of the particles.
        corners = [place + 0.013 * middle(place - centre) for place in places]
        arcs = [middle(places[i], places[i - 1]) for i in range(3)]
        named = ([(corner, 'white') for corner in corners] + [(arc, colour) for arc in arcs] +
                 [(centre, 'dark')])
        return [(point, colour) for point, colour in named if visible(point, margin=0.6)]

    def test_octant(self):
        with Window('octant.launch') as window:
            node = NodeClient()
            self.assert_shows(window, [], 'rviz_octant_running')
            node.set_running(False)
            node.reset()
            springs = node.get_scene().angle_springs
            springs[0].rest_angle = 0.2
            node.set_springs(angle_spring_ids=[0], angle_springs=springs[:1])
            expected = self.corners_and_arcs(node, 'blue')
            expected[4] = (expected[4][0], 'orange')
            self.assert_shows(window, expected, 'rviz_octant_before')
            springs[0].rest_angle = math.pi / 2
            node.set_springs(angle_spring_ids=[0], angle_springs=springs[:1])
            node.relax()
            expected = self.corners_and_arcs(node, 'white')
            self.assertEqual(7, len(expected), 'all of it in front')
            self.assert_shows(window, expected, 'rviz_octant')

    def add_mesh(self, node):
        """Solid-angle springs on the sphere that want the areas of the faces of a bumpy ball.
        Return the faces, and what of that each has."""
        places, faces, _ = mesh.icosphere(4, 4)
        areas = mesh.areas(mesh.bumpy(places), faces)
        wanted = 4 * math.pi * areas / areas.sum()
        node.add_particles([particle(p) for p in places])
        node.add_springs(
            solid_angle_springs=[solid_angle_spring(f.tolist(), rest_solid_angle=w)
                                 for f, w in zip(faces, wanted)],
            angle_springs=[angle_spring(e.tolist(), 1e-6, at_rest=True)
                           for e in mesh.edges_of(faces)])
        return faces, mesh.solid_angles(places, faces) / wanted

    def test_mesh(self):
        with Window('spherical_springs.launch', 'running:=false') as window:
            node = NodeClient()
            faces, ratios = self.add_mesh(node)

            def faces_in_front(colours):
                corners = positions(node.get_scene())[faces]
                named = [(middle(*face), colour) for face, colour in zip(corners, colours)]
                return [(centre, colour) for centre, colour in named if colour and visible(centre)]

            expected = faces_in_front(['blue' if ratio < 0.7 else 'orange' if ratio > 1.45 else None
                                       for ratio in ratios])
            self.assertEqual({'blue', 'orange'}, {colour for _, colour in expected})
            self.assert_shows(window, expected, 'rviz_mesh_before')
            node.relax()
            self.assert_shows(window, faces_in_front(['white'] * len(faces))[::20], 'rviz_mesh')
