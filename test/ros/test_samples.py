"""~poses and ~energies, which are sampled together."""

import numpy as np
from geometry_msgs.msg import PoseArray
from spherical_springs.msg import Energies

from node_client import NodeProcess, NodeTest
from scenes import (
    add_mixed_octant, add_octant, add_random_scene, energies, particle, positions, vector)


def normals(poses):
    """Where each pose has turned the frame's z axis."""
    x, y, z, w = np.array([[getattr(p.orientation, c) for c in 'xyzw'] for p in poses]).T
    return np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]).T


def places(poses):
    return np.array([vector(p.position) for p in poses])


def norms(poses):
    return [np.linalg.norm([getattr(p.orientation, c) for c in 'xyzw']) for p in poses]


class TestPoses(NodeTest):
    def sampled(self, node):
        with node.listen('poses', PoseArray) as samples:
            count = len(node.get_scene().particles)
            return samples.first(lambda sample: len(sample.poses) == count)

    def test_stand_on_the_sphere_in_the_order_of_ids(self):
        # The poles, the axes, and places near the poles are where a frame may go wrong.
        directions = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (1e-9, 0, -1), (0, 1e-12, 1)]
        directions += list(np.random.default_rng(1).normal(size=(20, 3)))
        ids = self.node.add_particles([particle(d) for d in directions]).ids
        self.node.remove_particles(ids[8:9])
        sample = self.sampled(self.node)
        self.assertEqual('map', sample.header.frame_id)
        expected = positions(self.node.get_scene())
        np.testing.assert_array_equal(expected, places(sample.poses))
        np.testing.assert_allclose(normals(sample.poses), expected, atol=1e-15)
        np.testing.assert_allclose(norms(sample.poses), 1, rtol=1e-15)

    def test_nobody_there(self):
        self.assertEqual([], self.sampled(self.node).poses)

    def test_follow_the_particles(self):
        add_random_scene(self.node, seed=1)
        self.node.set_running(True)
        with self.node.listen('poses', PoseArray) as samples:
            samples.several(5)
            self.node.set_running(False)
            last = positions(self.node.get_scene())
            samples.first(lambda sample: np.array_equal(last, places(sample.poses)))
            for sample in samples.several(5):
                np.testing.assert_allclose(normals(sample.poses), places(sample.poses), atol=1e-15)
                np.testing.assert_allclose(norms(sample.poses), 1, rtol=1e-15)

    def test_frame_and_radius_are_parameters(self):
        with NodeProcess(running='false', frame_id='globe', radius=6.5) as process:
            node = process.client()
            add_octant(node, damping=0)
            sample = self.sampled(node)
            self.assertEqual('globe', sample.header.frame_id)
            expected = positions(node.get_scene())
            np.testing.assert_allclose(places(sample.poses), 6.5 * expected, rtol=1e-15)
            np.testing.assert_allclose(normals(sample.poses), expected, atol=1e-15)
            with node.listen('energies', Energies) as samples:
                self.assertEqual('globe', samples.first().header.frame_id)

    def test_a_frame_has_no_slash_before_it(self):
        with NodeProcess(running='false', frame_id='/globe/fixed') as process:
            self.assertEqual('globe/fixed', self.sampled(process.client()).header.frame_id)


class TestEnergies(NodeTest):
    def run_with_damping(self, add, seconds):
        """Samples of both topics from the beginning until some simulated time."""
        add(self.node)
        with self.node.listen('poses', PoseArray) as poses, \
                self.node.listen('energies', Energies) as samples:
            poses.first()
            samples.first()
            self.node.set_running(True)
            samples.first(lambda sample: sample.time > seconds)
            return poses.all(), samples.all()

    def test_have_the_stamps_of_the_poses(self):
        poses, samples = self.run_with_damping(add_mixed_octant, 1)
        first, last = samples[0].header.stamp, samples[-1].header.stamp
        stamps = [p.header.stamp for p in poses if first <= p.header.stamp <= last]
        self.assertGreater(len(stamps), 5)
        self.assertEqual(set(), set(stamps) - {s.header.stamp for s in samples})
        self.assertEqual({'map'}, {s.header.frame_id for s in samples})
        times = [s.time for s in samples]
        self.assertEqual(sorted(times), times)

    def test_add_up(self):
        _, samples = self.run_with_damping(add_mixed_octant, 1)
        for s in samples:
            self.assertAlmostEqual(s.potential, s.angle + s.solid_angle + s.oriented_angle,
                                   delta=1e-15 * s.potential)
            self.assertAlmostEqual(s.total, s.kinetic + s.potential, delta=1e-15 * s.total)
            self.assertGreater(min(s.angle, s.solid_angle, s.oriented_angle), 0)

    def test_are_conserved_with_what_is_dissipated(self):
        _, samples = self.run_with_damping(lambda node: add_octant(node, damping=0.5), 3)
        begin = samples[0]
        self.assertEqual((0, 0, 0), (begin.time, begin.kinetic, begin.dissipated))
        for before, after in zip(samples, samples[1:]):
            self.assertGreaterEqual(after.dissipated, before.dissipated)
            self.assertAlmostEqual(1, (after.total + after.dissipated) / begin.total, delta=1e-6)
        self.assertLess(samples[-1].total, 0.5 * begin.total)

    def test_are_those_of_the_scene(self):
        add_random_scene(self.node, seed=2)
        self.node.step(steps=100)
        expected = energies(self.node.get_scene())
        with self.node.listen('energies', Energies) as samples:
            sample = samples.first(lambda sample: sample.kinetic > 0)
        for kind, value in expected.items():
            self.assertAlmostEqual(1, getattr(sample, kind) / value, delta=1e-12, msg=kind)
