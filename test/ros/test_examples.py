"""The scenes under launch/ do what they are for."""

import math
import os
import unittest

import numpy as np
import rospkg

from node_client import PACKAGE, NodeProcess
from scenes import angle, positions

LAUNCH = os.path.join(rospkg.RosPack().get_path(PACKAGE), 'launch')


class TestExamples(unittest.TestCase):
    def relaxed(self, name):
        """The directions before and after."""
        with NodeProcess(running='false', scene=os.path.join(LAUNCH, name)) as process:
            node = process.client()
            before = positions(node.get_scene())
            outcome = node.relax()
            self.assertTrue(outcome.converged, outcome.message)
            return before, positions(node.get_scene())

    def test_viewing_directions_are_as_far_apart_as_twelve_can_be(self):
        _, directions = self.relaxed('viewing_directions.json')
        nearest = [sorted(angle(a, b) for b in directions)[1] for a in directions]
        np.testing.assert_allclose(nearest, math.atan(2), atol=1e-6)  # the icosahedron's edge

    def test_pan_tilt_keeps_its_distances_and_its_pins(self):
        before, after = self.relaxed('pan_tilt.json')
        steps = [angle(a, b) for a, b in zip(after, after[1:])]
        np.testing.assert_allclose(steps, math.radians(20), atol=1e-6)
        np.testing.assert_array_equal(before[::6], after[::6])
        self.assertGreater(min(map(angle, before[1:6], after[1:6])), 0.01)
