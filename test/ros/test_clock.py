"""The node under /clock, which may stand still and jump."""

import os
import subprocess
import tempfile
import unittest

import numpy as np
import rosbag
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseArray
from rosgraph_msgs.msg import Clock
from spherical_springs.msg import Energies, Status
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from node_client import LONG, Listener, NodeProcess
from scenes import add_octant, add_random_scene, exact, positions, vector


class ClockTest(unittest.TestCase):
    """Only nodes that start after setUp follow /clock; the test itself follows the wall."""

    def setUp(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        self.process = NodeProcess()
        self.addCleanup(self.process.__exit__)
        self.node = self.process.client()

    def time_of_standing_clock(self):
        with self.node.listen('status', Status) as statuses:
            before, after = statuses.several(3)[-2:]
        self.assertEqual(before.time, after.time)
        return after.time


class TestClock(ClockTest):
    def setUp(self):
        super().setUp()
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=100, latch=True)
        self.addCleanup(self.publisher.unregister)

    def set_clock(self, seconds):
        """Return when the node has seen it."""
        self.clock = seconds
        self.publisher.publish(Clock(rospy.Time.from_sec(seconds)))
        with self.node.listen('status', Status) as statuses:
            statuses.first(lambda s: abs(s.header.stamp.to_sec() - seconds) < 1e-6)

    def let_pass(self, simulated):
        """Move the clock on until so much more has been simulated."""
        begin, begin_of_clock = self.node.get_scene().time, self.clock
        now = begin
        while now < begin + simulated:
            self.assertLess(self.clock, begin_of_clock + 60)
            self.set_clock(self.clock + 0.1)
            now = self.node.get_scene().time
            self.assertLess(now - begin, self.clock - begin_of_clock + 0.01)

    def test_who_waits_for_the_clock_says_so(self):
        words = 'waiting for /clock'
        with self.node.listen('status', Status) as statuses, \
                Listener('/diagnostics', DiagnosticArray) as diagnostics:
            statuses.first(lambda status: words in status.message)
            diagnostics.first(lambda array: any(
                words in status.message and status.level == DiagnosticStatus.WARN
                and self.process.name[1:] in status.name for status in array.status))
            self.set_clock(100)
            statuses.first(lambda status: status.header.stamp.secs == 100
                           and words not in status.message)

    def test_a_clock_that_starts_late(self):
        self.assertEqual(0, self.time_of_standing_clock())
        self.set_clock(1e9)
        self.assertEqual(0, self.time_of_standing_clock())
        self.let_pass(0.2)

    def test_time_goes_with_the_clock_and_stands_with_it(self):
        self.set_clock(100)
        self.let_pass(0.5)
        self.assertGreaterEqual(self.time_of_standing_clock(), 0.5)

    def test_a_jump_back(self):
        self.set_clock(100)
        self.let_pass(0.2)
        before = self.time_of_standing_clock()
        self.set_clock(5)
        self.assertGreaterEqual(self.node.get_scene().time, before)
        self.let_pass(0.2)

    def test_a_jump_ahead_does_not_pile_up_work(self):
        self.set_clock(100)
        before = self.time_of_standing_clock()
        self.set_clock(1e6)
        self.assertLess(self.time_of_standing_clock(), before + 2)
        self.let_pass(0.2)

    def test_jumps_of_a_century(self):
        century = 3.2e9
        self.set_clock(100)
        self.let_pass(0.2)
        for clock in (100 + century, 100):
            self.set_clock(clock)
            self.let_pass(0.2)

    def test_steps_are_counted_and_as_long_as_ever(self):
        self.node.set_running(False)
        add_random_scene(self.node, seed=1)
        self.node.set_running(True)
        for seconds in (100, 100.0371, 100.9, 1e6, 1e6 + 0.11, 1e6 + 0.1, 50, 50.05, 50.6):
            self.set_clock(seconds)
        self.let_pass(0.1)
        self.node.set_running(False)
        self.time_of_standing_clock()
        with self.node.listen('status', Status) as statuses:
            steps = statuses.first(lambda s: s.state == 'paused').steps
        scene = self.node.get_scene()
        self.assertGreater(steps, 100)
        self.node.reset()
        self.node.step(steps=steps)
        self.assertEqual(exact(scene), exact(self.node.get_scene()))

    def test_samples_are_stamped_by_the_clock(self):
        self.set_clock(100)
        with self.node.listen('energies', Energies) as samples:
            self.let_pass(0.3)
            stamps = [s.header.stamp.to_sec() for s in samples.several(2)]
        self.assertTrue(all(100 <= stamp <= self.clock for stamp in stamps), stamps)


class TestStandingClock(ClockTest):
    """Whoever listens sees what a change has come to, though no time goes by."""

    def assert_samples_follow_changes(self):
        node = self.node
        node.set_running(False)
        add_octant(node, damping=0)
        with node.listen('poses', PoseArray) as poses, \
                node.listen('energies', Energies) as energies, \
                node.listen('markers', MarkerArray) as markers:
            for change in (lambda: node.step(steps=100), node.reset, node.relax):
                change()
                places = positions(node.get_scene())
                total = node.step(steps=0).energies.total
                poses.first(lambda sample: np.array_equal(
                    places, [vector(pose.position) for pose in sample.poses]))
                energies.first(lambda sample: sample.total == total)
                markers.first(lambda array: any(np.array_equal(
                    places, [vector(p) for p in marker.points]) for marker in array.markers))

    def test_a_clock_that_has_not_begun(self):
        self.assert_samples_follow_changes()

    def test_a_clock_that_has_stopped(self):
        clock = rospy.Publisher('/clock', Clock, queue_size=10, latch=True)
        self.addCleanup(clock.unregister)
        clock.publish(Clock(rospy.Time(7)))
        with self.node.listen('status', Status) as statuses:
            statuses.first(lambda status: status.header.stamp == rospy.Time(7))
        self.assert_samples_follow_changes()


class TestReplay(ClockTest):
    """A bag that is replayed brings its own clock, which jumps back when it is replayed again."""

    BEGIN, LENGTH = 1000, 3  # [s]

    def setUp(self):
        super().setUp()
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)
        self.bag = os.path.join(self.directory.name, 'recorded.bag')
        with rosbag.Bag(self.bag, 'w') as bag:
            for tenth in range(10 * self.LENGTH + 1):
                bag.write('/recorded', String(), rospy.Time.from_sec(self.BEGIN + tenth / 10))

    def replay(self):
        """Return how much has been simulated meanwhile."""
        before = self.time_of_standing_clock()
        subprocess.run(['rosbag', 'play', '--quiet', '--clock', self.bag],
                       check=True, timeout=LONG, stdout=subprocess.DEVNULL)
        return self.time_of_standing_clock() - before

    def test_simulated_time_goes_with_it(self):
        for _ in range(2):
            # The node may miss the begin of the clock while it connects to it.
            simulated = self.replay()
            self.assertGreater(simulated, 0.5)
            self.assertLess(simulated, self.LENGTH + 0.1)
