"""What each parameter of the node does."""

import math
import os
import tempfile
import time
import unittest

import numpy as np
import rospkg
from spherical_springs.msg import Energies, Status

from node_client import PACKAGE, NodeProcess, Refused, wait_until
from scenes import (
    add_octant, add_random_scene, angle, angle_spring, angular_velocities, exact, masses, particle,
    positions)


def paused(**parameters):
    return NodeProcess(running='false', **parameters)


class TestTime(unittest.TestCase):
    def test_time_step(self):
        with paused(time_step=0.125) as process:
            node = process.client()
            self.assertEqual(0.375, node.step(steps=3).time)
            with node.listen('status', Status) as statuses:
                self.assertEqual(0.125, statuses.first().time_step)

    def error_after_a_second(self, integrator, steps):
        """Of a pair that swings on one arc, against the closed form."""
        with paused(integrator=integrator, time_step=1 / steps) as process:
            node = process.client()
            ids = node.add_particles([particle((1, 0, 0)), particle((0, 1, 0))]).ids
            node.add_springs(angle_springs=[angle_spring(ids, rest_angle=1)])
            node.step(steps=steps)
            with node.listen('status', Status) as statuses:
                self.assertEqual(integrator, statuses.first().integrator)
            expected = 1 + (math.pi / 2 - 1) * math.cos(math.sqrt(2))
            return abs(angle(*positions(node.get_scene())) - expected)

    def test_integrator(self):
        for integrator, order, steps in (('euler', 1, 16), ('verlet', 2, 16),
                                         ('fourth_order', 4, 16), ('implicit_euler', 1, 512)):
            coarse = self.error_after_a_second(integrator, steps)
            fine = self.error_after_a_second(integrator, 2 * steps)
            self.assertAlmostEqual(order, math.log2(coarse / fine), delta=0.05, msg=integrator)

    def test_running(self):
        with NodeProcess(running='true') as running, NodeProcess() as default, \
                paused() as standing:
            node = standing.client()
            for other in (running.client(), default.client()):
                wait_until(lambda: other.get_scene().time > 0.1)
            self.assertEqual(0, node.get_scene().time)
            node.set_running(True)
            wait_until(lambda: node.get_scene().time > 0.1)

    def test_real_time_factor(self):
        begin = time.monotonic()
        with NodeProcess(real_time_factor=50) as fast, NodeProcess(real_time_factor=0.1) as slow:
            node, slow_node = fast.client(), slow.client()
            wait_until(lambda: node.get_scene().time > time.monotonic() - begin + 10)
            wait_until(lambda: slow_node.get_scene().time > 0)
            self.assertLess(slow_node.get_scene().time, 0.2 * (time.monotonic() - begin))

    def test_publish_rate(self):
        length = 2  # [s]; a busy machine may send some samples late and the next ones at once
        for rate in (5, 100):
            count = length * rate
            with paused(publish_rate=rate) as process:
                with process.client().listen('energies', Energies) as samples:
                    stamps = [s.header.stamp.to_sec() for s in samples.several(count + 1)]
            self.assertGreater(stamps[-1] - stamps[0], 0.5 * length)


class TestThreads(unittest.TestCase):
    def test_any_number_gives_the_same_bits(self):
        bits = []
        for threads in (1, 2):
            with paused(threads=threads) as process:
                node = process.client()
                add_random_scene(node, seed=1, particles=5000, springs=5000)
                report = node.step(steps=100).energies
                scene = node.get_scene()
                bits.append((positions(scene).tobytes(), angular_velocities(scene).tobytes(),
                             report.total, report.dissipated))
        self.assertTrue(bits[0] == bits[1])


class TestSpringDamping(unittest.TestCase):
    def momentum_lost(self, spring_damping):
        with paused(spring_damping=spring_damping) as process:
            node = process.client()
            ids = node.add_particles([particle((1, 0, 0), (0, 0, 1), mass=1),
                                      particle((1, 2, 0), (0, 0, 2), mass=3)]).ids
            node.add_springs(angle_springs=[angle_spring(ids, at_rest=True, damping=0.5)])

            def momentum():
                scene = node.get_scene()
                return masses(scene) @ angular_velocities(scene)

            begin = momentum()
            self.assertGreater(node.step(steps=500).energies.dissipated, 0.01)
            return np.linalg.norm(momentum() - begin)

    def test_only_relative_damping_keeps_the_angular_momentum(self):
        self.assertLess(self.momentum_lost('relative'), 1e-12)
        self.assertGreater(self.momentum_lost('own'), 0.1)

    def test_own_damping_slows_each_end_by_its_own_velocity(self):
        with paused(spring_damping='own') as process:
            node = process.client()
            ids = node.add_particles([particle((1, 0, 0), (0, 0, 1), mass=2),
                                      particle((0, 1, 0), (0, 0, 3), mass=4)]).ids
            node.add_springs(angle_springs=[
                angle_spring(ids, 1e-30, rest_angle=1, damping=0.5)])
            seconds = node.step(steps=1000).time
            np.testing.assert_allclose(
                angular_velocities(node.get_scene())[:, 2],
                [math.exp(-0.5 / 2 * seconds), 3 * math.exp(-0.5 / 4 * seconds)], rtol=1e-12)


class TestLimits(unittest.TestCase):
    def test_max_particles(self):
        with paused(max_particles=3) as process:
            node = process.client()
            ids = node.add_particles([particle((1, 2, 3))] * 2).ids
            with self.assertRaisesRegex(Refused, 'particles.*4.*allowed.*3'):
                node.add_particles([particle((1, 2, 3))] * 2)
            self.assertEqual(ids, node.get_scene().particle_ids)
            node.add_particles([particle((1, 2, 3))])

    def test_max_springs_counts_all_kinds(self):
        with paused(max_springs=7) as process:
            node = process.client()
            with self.assertRaisesRegex(Refused, 'springs.*9.*allowed.*7'):
                add_random_scene(node, seed=1, particles=5, springs=3)
            add_random_scene(node, seed=1, particles=5, springs=2)

    def test_files_are_held_to_them_too(self):
        with tempfile.TemporaryDirectory() as directory:
            with paused(scene_directory=directory) as process:
                node = process.client()
                add_random_scene(node, seed=1, particles=5, springs=2)
                node.save_scene('five_and_six.json')
            with paused(scene_directory=directory, max_particles=4) as process:
                with self.assertRaisesRegex(Refused, 'particles.*5.*allowed.*4'):
                    process.client().load_scene('five_and_six.json')
            with paused(scene_directory=directory, max_springs=5) as process:
                with self.assertRaisesRegex(Refused, 'springs.*6.*allowed.*5'):
                    process.client().load_scene('five_and_six.json')


class TestFiles(unittest.TestCase):
    def test_scene(self):
        octant = os.path.join(rospkg.RosPack().get_path(PACKAGE), 'launch', 'octant.json')
        with paused(scene=octant) as process:
            node = process.client()
            self.assertEqual(3, len(node.get_scene().particles))
            node.relax()
            corners = positions(node.get_scene())
            self.assertAlmostEqual(math.pi / 2, angle(corners[0], corners[1]), delta=1e-8)

    def test_scene_is_relative_to_scene_directory(self):
        with tempfile.TemporaryDirectory() as directory:
            with paused(scene_directory=directory + '/made/by/the/node') as process:
                node = process.client()
                add_octant(node, damping=0.1)
                node.step(steps=10)
                saved = node.get_scene()
                node.save_scene('first.json')
            self.assertEqual(['first.json'], os.listdir(directory + '/made/by/the/node'))
            with paused(scene_directory=directory + '/made/by/the/node',
                        scene='first.json') as process:
                self.assertEqual(exact(saved), exact(process.client().get_scene()))

    def test_a_scene_in_the_home_directory(self):
        with tempfile.TemporaryDirectory() as home:
            with paused(scene_directory=home) as process:
                node = process.client()
                add_octant(node, damping=0)
                node.save_scene('first.json')
            with NodeProcess(environment={'HOME': home}, running='false', scene='~/first.json',
                             scene_directory='~/made') as process:
                node = process.client()
                self.assertEqual(3, len(node.get_scene().particles))
                node.save_scene('~/made/second.json')
                self.assertEqual(['second.json'], os.listdir(home + '/made'))
                with self.assertRaisesRegex(Refused, 'allowed: files inside'):
                    node.load_scene('~/first.json')

    def test_a_home_directory_of_nobody(self):
        for parameter in ('scene', 'scene_directory'):
            with NodeProcess(**{parameter: '~nobody_of_this_name/x'}) as process:
                self.assertEqual(1, process.exit_code())
                self.assertIn("no user 'nobody_of_this_name'", process.output())

    def test_scene_directory_is_in_the_directory_of_ros(self):
        with tempfile.TemporaryDirectory() as home:
            with NodeProcess(environment={'ROS_HOME': home}, running='false') as process:
                process.client().save_scene('empty.json')
            self.assertTrue(os.path.isfile(home + '/spherical_springs/empty.json'))

    def test_scene_directory_by_default(self):
        with tempfile.TemporaryDirectory() as home:
            with NodeProcess(environment={'HOME': home, 'ROS_HOME': ''},
                             running='false') as process:
                process.client().save_scene('empty.json')
            self.assertTrue(os.path.isfile(home + '/.ros/spherical_springs/empty.json'))
