"""The node under /clock, which may stand still and jump."""

import unittest

import rospy
from rosgraph_msgs.msg import Clock
from spherical_springs.msg import Energies, Status

from node_client import NodeProcess


class TestClock(unittest.TestCase):
    """Only nodes that start after setUp follow /clock; the test itself follows the wall."""

    def setUp(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=100, latch=True)
        self.addCleanup(self.publisher.unregister)
        self.process = NodeProcess(running='false')
        self.addCleanup(self.process.__exit__)
        self.node = self.process.client()
        self.set_clock(100)
        self.node.set_running(True)

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

    def time_of_standing_clock(self):
        with self.node.listen('status', Status) as statuses:
            before, after = statuses.several(3)[-2:]
        self.assertEqual(before.time, after.time)
        return after.time

    def test_time_goes_with_the_clock_and_stands_with_it(self):
        self.let_pass(0.5)
        self.assertGreaterEqual(self.time_of_standing_clock(), 0.5)

    def test_a_jump_back(self):
        self.let_pass(0.2)
        before = self.time_of_standing_clock()
        self.set_clock(5)
        self.assertGreaterEqual(self.node.get_scene().time, before)
        self.let_pass(0.2)

    def test_a_jump_ahead_does_not_pile_up_work(self):
        before = self.time_of_standing_clock()
        self.set_clock(1e6)
        self.assertLess(self.time_of_standing_clock(), before + 2)
        self.let_pass(0.2)

    def test_samples_are_stamped_by_the_clock(self):
        with self.node.listen('energies', Energies) as samples:
            self.let_pass(0.3)
            stamps = [s.header.stamp.to_sec() for s in samples.several(2)]
        self.assertTrue(all(100 <= stamp <= self.clock for stamp in stamps), stamps)
