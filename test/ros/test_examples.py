"""The scenes under launch/ do what they are for."""

import math
import os
import subprocess
import unittest

import numpy as np
import rospkg

from node_client import LONG, PACKAGE, NodeClient, NodeProcess
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


class TestCalibration(unittest.TestCase):
    """calibrate_rig.py, the script of a recipe."""

    def test_the_wrong_measurement_stands_out(self):
        with NodeProcess(name='/' + PACKAGE, environment={'ROS_NAMESPACE': '/rig'}):
            NodeClient('/rig/' + PACKAGE)
            lines = subprocess.check_output(
                ['rosrun', PACKAGE, 'calibrate_rig.py'], timeout=LONG, text=True,
                env={**os.environ, 'ROS_NAMESPACE': '/rig'}).splitlines()
        self.assertIn('converged; ', lines[0])
        self.assertIn('free rotations: 1; mirror image as good: yes', lines[1])
        self.assertEqual('0:  1.000000  0.000000  0.000000  0.00 0.00', lines[3])
        misses = {line[:3]: abs(float(line[4:])) for line in lines[-15:]}
        self.assertEqual('1 3', max(misses, key=misses.get), lines)
        self.assertGreater(misses['1 3'], 4)


class TestClient(unittest.TestCase):
    """spread_directions.py, which talks to the node of its namespace."""

    def run_client(self, namespace):
        return subprocess.run(
            ['rosrun', PACKAGE, 'spread_directions.py'], timeout=LONG, text=True,
            env={**os.environ, 'ROS_NAMESPACE': namespace},
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def test_in_a_namespace(self):
        with NodeProcess(name='/' + PACKAGE, environment={'ROS_NAMESPACE': '/robot'}) as process:
            NodeClient('/robot/' + PACKAGE)
            outcome = self.run_client('/robot')
            self.assertEqual(0, outcome.returncode, outcome.stdout + process.output())
            directions = np.array([[float(number) for number in line.split()]
                                   for line in outcome.stdout.splitlines()[-12:]])
            self.assertEqual((12, 3), directions.shape, outcome.stdout)

    def test_a_refusal_is_shown(self):
        with NodeProcess(name='/' + PACKAGE, environment={'ROS_NAMESPACE': '/small'},
                         max_particles=11):
            NodeClient('/small/' + PACKAGE)
            outcome = self.run_client('/small')
            self.assertEqual(1, outcome.returncode)
            self.assertIn('/small/spherical_springs/add_particles: particles', outcome.stdout)

    def test_no_node(self):
        outcome = self.run_client('/nobody')
        self.assertEqual(1, outcome.returncode)
        self.assertEqual(1, len(outcome.stdout.splitlines()), outcome.stdout)
        self.assertIn('there is no node /nobody/spherical_springs', outcome.stdout)


class TestSharingOut(unittest.TestCase):
    """share_out.py, with two nodes of which one is not there."""

    def test_another_node_does_the_work(self):
        with NodeProcess(name='/' + PACKAGE, running='false', environment={'ROS_NAMESPACE': '/here'}):
            NodeClient('/here/' + PACKAGE)
            outcome = subprocess.run(
                ['rosrun', PACKAGE, 'share_out.py', '/here/' + PACKAGE, '/gone/' + PACKAGE,
                 '--starts', '5', '--directions', '6'], timeout=2 * LONG, text=True,
                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(0, outcome.returncode, outcome.stderr)
        self.assertIn('/gone/spherical_springs is given up', outcome.stderr)
        first, *directions = outcome.stdout.splitlines()
        # An octahedron: 12 angles of pi / 2, and 3 of pi.
        self.assertEqual('5 starts; the least energy is %.9g J' % (12 * math.pi ** 2 / 8), first)
        self.assertEqual(6, len(directions))
