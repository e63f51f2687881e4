"""A node whose memory is at its limit: calls are refused, samples are left out, nothing is lost."""

import math
import os
import resource
import tempfile
import threading
import unittest

import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseArray
from spherical_springs.msg import Energies, RelaxAction, RelaxGoal, Status
from visualization_msgs.msg import MarkerArray

from node_client import NodeProcess, Refused, wait_until
from scenes import add_octant, angle_spring, exact, particle
from test_actions import ActionClient
from test_large_requests import many_particles
from test_markers import ALL, names, points

MEGABYTE = 1e6
COUNT = 60000
TYPES = {'poses': PoseArray, 'energies': Energies, 'status': Status, 'markers': MarkerArray}


def around(i):
    """Places along a curve."""
    return particle((math.cos(1e-4 * i), math.sin(1e-4 * i), 0.1 * math.sin(7 * i)))


class ShortMemoryTest(unittest.TestCase):
    def start(self, **parameters):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.process = NodeProcess(running='false', threads=1, scene_directory=directory.name,
                                   **parameters)
        self.addCleanup(self.process.__exit__)
        self.node = self.process.client()

    def leave_room(self, room):
        """Let the node have so many bytes more than it has."""
        with open('/proc/%d/status' % self.process.pid) as status:
            size = next(1024 * int(line.split()[1]) for line in status
                        if line.startswith('VmSize:'))
        self.limit(int(size + room))

    def limit(self, size=resource.RLIM_INFINITY):
        resource.prlimit(self.process.pid, resource.RLIMIT_AS, (size, resource.RLIM_INFINITY))

    def await_line(self, text):
        """In what the node has said."""
        wait_until(lambda: text in self.process.output())

    def assert_lives(self):
        self.assertIsNone(self.process.exit_code(0), self.process.output())


class TestLargeScene(ShortMemoryTest):
    def setUp(self):
        self.start()
        self.ids = self.node.add_particles([around(i) for i in range(COUNT)]).ids
        self.springs = [angle_spring(pair, at_rest=True) for pair in zip(self.ids, self.ids[1:])]
        self.spring_ids = self.node.add_springs(angle_springs=self.springs).angle_spring_ids
        self.node.save_scene('scene.json')

    def test_calls_that_are_refused_change_nothing(self):
        """How much memory the node holds that it does not use is chance: some may be done."""
        before = exact(self.node.get_scene())
        many = len(self.ids) // 2
        particles = [particle((1, 2, 3))] * many
        refused = []
        for service, fields in (
                ('get_scene', {}), ('save_scene', {'path': 'again.json'}),
                ('load_scene', {'path': 'scene.json'}), ('step', {'steps': 1}), ('relax', {}),
                ('add_particles', {'particles': particles}),
                ('set_particles', {'ids': self.ids[:many], 'particles': particles}),
                ('add_springs', {'angle_springs': self.springs}),
                ('set_springs', {'angle_spring_ids': self.spring_ids,
                                 'angle_springs': self.springs}),
                ('remove_springs', {'angle_spring_ids': self.spring_ids[:many]}),
                ('remove_particles', {'ids': self.ids[:many]}), ('reset', {}), ('clear', {})):
            self.leave_room(MEGABYTE)
            try:
                getattr(self.node, service)(**fields)
            except Refused as refusal:
                self.assertRegex(str(refusal), 'not enough memory|cannot write', service)
                refused.append(service)
            self.limit()
            if service in refused:
                self.assertEqual(before, exact(self.node.get_scene()), service)
            self.node.load_scene('scene.json')
        self.assertNotEqual([], refused)

    def test_samples_are_left_out_and_come_again(self):
        self.leave_room(MEGABYTE)
        listeners = {topic: self.node.listen(topic, kind) for topic, kind in TYPES.items()}
        for listener in listeners.values():
            listener.__enter__()
            self.addCleanup(listener.__exit__)
        for line in ('a sample of ~poses and ~energies is left out: there is not enough memory',
                     'a new listener gets ~markers later: there is not enough memory'):
            self.await_line(line)
        self.assert_lives()
        self.limit()
        self.assertEqual(COUNT, len(listeners['poses'].first().poses))
        listeners['energies'].first()
        listeners['status'].first(lambda status: status.angle_springs == COUNT - 1)
        listeners['markers'].first(lambda array: names(array) == ALL)

    def test_what_changed_meanwhile_is_shown_later(self):
        with self.node.listen('markers', MarkerArray) as arrays:
            arrays.first()
            self.leave_room(MEGABYTE)
            self.node.set_particles(self.ids[:1], [particle((0, 0, 1))])
            self.await_line('~markers are sent later: there is not enough memory')
            self.assert_lives()
            self.limit()
            moved = arrays.first(lambda array: 'particles' in names(array) and np.array_equal(
                (0, 0, 1), points(array.markers[0])[0]))
            self.assertLessEqual({'sphere', 'particles', 'arcs'}, names(moved))

    def test_a_goal_ends_whether_there_is_memory_for_it_or_not(self):
        client = ActionClient(self.node, 'relax', RelaxAction)
        self.node.set_particles(self.ids[:1], [particle((0, 0, 1))])
        before = exact(self.node.get_scene())
        self.leave_room(MEGABYTE)
        state, text, result = client.outcome(RelaxGoal(max_time=1))
        self.assert_lives()
        self.limit()
        self.assertEqual(state == GoalStatus.SUCCEEDED, result.success, text)
        if not result.success:
            self.assertIn('not enough memory', text)
            self.assertEqual(before, exact(self.node.get_scene()))
        state, text, _ = client.outcome(RelaxGoal(max_time=1))
        self.assertEqual(GoalStatus.SUCCEEDED, state, text)


class TestLargeRequests(ShortMemoryTest):
    """roscpp reads a request before the node sees it, and would end where it has no memory."""

    def setUp(self):
        self.start()
        add_octant(self.node, damping=0)
        self.before = self.node.get_scene()
        self.leave_room(MEGABYTE / 2)

    def test_are_refused(self):
        for count in (20000, 200000):
            with self.assertRaisesRegex(Refused, 'not enough memory'):
                self.node.add_particles(many_particles(count))
        self.limit()
        self.assertEqual(exact(self.before), exact(self.node.get_scene()))

    def test_wait_where_they_are_too_large_to_be_refused(self):
        call = threading.Thread(target=self.node.add_particles, args=(many_particles(1000000),))
        call.start()
        self.await_line('a request waits for memory')
        self.limit()
        call.join()
        with self.node.listen('status', Status) as statuses:
            statuses.first(lambda status: status.particles == 3 + 1000000)
