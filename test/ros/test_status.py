import json
import math
import os
import tempfile
import unittest

import numpy as np
import rospy
from spherical_springs.msg import Status

from node_client import Listener, NodeProcess, NodeTest, wait_until
from scenes import add_knot, add_octant, add_random_scene, angle_spring, particle


class StatusTest(NodeTest):
    def status(self, condition=lambda status: True):
        with self.node.listen('status', Status) as statuses:
            return statuses.first(condition)


class TestTopic(StatusTest):
    def test_a_late_listener_gets_the_last_one(self):
        latched = self.status(lambda status: status._connection_header['latching'] == '1')
        self.assertLessEqual(latched.header.stamp, rospy.Time.now())
        self.assertEqual('map', latched.header.frame_id)

    def test_calls_that_only_read_do_not_ask_for_it(self):
        # It takes far longer to work out than they do. Nobody asking, it comes once a second.
        with self.node.listen('status', Status) as statuses:
            statuses.several(3)  # what setUp and the listener have asked for among them

            def have_come():
                self.node.get_scene()
                self.node.step(steps=0)
                return len(statuses.all()) >= 5

            wait_until(have_come)
            stamps = [status.header.stamp.to_sec() for status in statuses.all()[2:5]]
        self.assertGreater(min(np.diff(stamps)), 0.9)

    def test_comes_again_and_again(self):
        with self.node.listen('status', Status) as statuses:
            stamp = statuses.first().header.stamp
            for _ in range(3):
                stamp = statuses.first(lambda status: status.header.stamp > stamp).header.stamp

    def test_state(self):
        add_knot(self.node)
        with self.node.listen('status', Status) as statuses:
            def await_state(state):
                since = rospy.Time.now()
                return statuses.first(lambda s: s.state == state and s.header.stamp > since)

            await_state('paused')
            self.node.set_running(True)
            await_state('running')
            self.node.set_running(False)
            await_state('paused')
            call = self.node.begin('relax', method='dynamics', tolerance=1e-30)
            statuses.first(lambda status: status.state == 'relaxing')
            self.node.cancel()
            call.result()
            await_state('paused')

    def test_message_is_the_last_thing_worth_telling(self):
        add_octant(self.node, damping=0)
        told = self.node.relax().message
        self.assertNotEqual('', told)
        self.status(lambda status: told in status.message)


class TestFields(StatusTest):
    def test_counts(self):
        ids = self.node.add_particles([particle((1, 2, i)) for i in range(4)]).ids
        self.node.add_springs(angle_springs=[angle_spring(ids[:2])] * 3)
        status = self.status(lambda status: status.angle_springs == 3)
        self.assertEqual((4, 3, 0, 0), self.counts(status))
        self.node.clear()
        add_random_scene(self.node, seed=1, particles=6, springs=5)
        self.node.remove_springs([], [], self.node.get_scene().oriented_angle_spring_ids[:1])
        status = self.status(lambda status: status.oriented_angle_springs == 4)
        self.assertEqual((6, 5, 5, 4), self.counts(status))

    def counts(self, status):
        return (status.particles, status.angle_springs, status.solid_angle_springs,
                status.oriented_angle_springs)

    def test_settings(self):
        status = self.status()
        self.assertEqual(('verlet', 1e-3), (status.integrator, status.time_step))

    def test_time_and_steps(self):
        self.node.step(steps=300)
        status = self.status(lambda status: status.steps == 300)
        self.assertEqual(self.node.get_scene().time, status.time)
        self.node.reset()
        self.assertEqual(0, self.status(lambda status: status.steps == 0).time)

    def test_of_a_pair_at_the_end_of_its_swing(self):
        stiffness, mass, deviation = 3, 2, 0.25
        ids = self.node.add_particles([particle((1, 0, 0), mass=mass),
                                       particle((0, 1, 0), mass=mass)]).ids
        self.node.add_springs(angle_springs=[
            angle_spring(ids, stiffness, rest_angle=math.pi / 2 - deviation)])
        status = self.status(lambda status: status.angle_springs == 1)
        self.assertAlmostEqual(stiffness * deviation, status.max_torque, delta=1e-14)
        frequency = math.sqrt(2 * stiffness / mass)
        longest = 2 / frequency
        self.assertLess(0.9 * longest, status.stable_time_step)
        self.assertLess(status.stable_time_step, longest + 1e-9)
        # A step and two half ones differ by the third order of the step.
        acceleration = stiffness * deviation / mass
        self.assertLess(status.local_error, acceleration * frequency * 1e-3 ** 3)
        self.assertEqual(0, status.energy_error)
        self.assertEqual(0, status.angular_momentum_error)
        self.assertEqual(0, status.relax_progress)

    def test_errors_of_an_undamped_scene(self):
        add_octant(self.node, damping=0)
        self.node.step(steps=2000)
        status = self.status(lambda status: status.steps == 2000)
        self.assertGreater(status.energy_error, 0)
        self.assertLess(status.energy_error, 1e-5)
        self.assertLess(status.angular_momentum_error, 1e-12)
        self.assertLess(status.norm_error, 1e-14)
        self.assertGreater(status.local_error, 0)
        self.assertLess(status.local_error, 1e-6)
        self.assertGreater(status.step_wall_time, 0)
        self.assertLess(status.step_wall_time, 1)

    def test_errors_begin_anew_with_the_account(self):
        add_octant(self.node, damping=0)
        self.node.step(steps=2000)
        self.status(lambda status: status.energy_error > 0)
        self.node.reset()
        self.status(lambda status: status.energy_error == 0)


class TestRealTimeFactor(unittest.TestCase):
    """Steps count, and no other jump of a scene's time."""

    LATE = 1e5  # [s], the time of a scene in a file

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name
        with open(os.path.join(self.directory, 'late.json'), 'w') as file:
            json.dump({'format': 'spherical_springs scene 1', 'time': self.LATE,
                       'particles': [{'position': [1, 0, 0]}]}, file)

    def start(self, running, **parameters):
        process = NodeProcess(running=running, scene_directory=self.directory, **parameters)
        self.addCleanup(process.__exit__)
        statuses = Listener(process.name + '/status', Status)
        statuses.__enter__()
        self.addCleanup(statuses.__exit__)
        return process.client(), statuses

    def assert_none_jumps(self, statuses):
        """The scene's time does, by some 1e5 s in a second."""
        factors = [status.real_time_factor for status in statuses]
        self.assertTrue(all(0 <= factor < 1000 for factor in factors), factors)

    def test_while_running(self):
        _, statuses = self.start('true', scene='late.json')
        statuses.several(3)
        statuses.first(lambda status: 0.1 < status.real_time_factor)
        self.assert_none_jumps(statuses.all())

    def test_while_paused(self):
        node, statuses = self.start('false')
        node.load_scene('late.json')
        statuses.first(lambda status: status.time == self.LATE)
        node.step(steps=3)
        statuses.first(lambda status: status.steps == 3 and status.state == 'paused')
        node.clear()
        statuses.first(lambda status: status.particles == 0 and status.steps == 0)
        paused = [s.real_time_factor for s in statuses.all() if s.state == 'paused']
        self.assertEqual({0}, set(paused))

    def test_where_time_jumps_while_running(self):
        node, statuses = self.start('true')
        for jump in (lambda: node.load_scene('late.json'), node.reset, node.clear):
            jump()
            seen = len(statuses.all())
            statuses.several(seen + 3)
        self.assert_none_jumps(statuses.all())
