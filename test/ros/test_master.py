"""The node while its master is gone, and when there is one again."""

import socket
import subprocess
import unittest

import rosgraph
import rospy
from spherical_springs.srv import Step

from node_client import LONG, NodeProcess, service_address, wait_until


def free_port():
    with socket.socket() as probe:
        probe.bind(('', 0))
        return probe.getsockname()[1]


class Master:
    """A master of one's own, beside that of the test."""

    def __init__(self):
        self.port = free_port()
        self.uri = 'http://localhost:%d' % self.port
        self._process = None

    def begin(self):
        self._process = subprocess.Popen(
            ['roscore', '-p', str(self.port)],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_until(self.is_there)

    def end(self):
        if self._process:
            self._process.terminate()
            self._process.wait(LONG)
            self._process = None

    def is_there(self):
        return rosgraph.is_master_online(self.uri)

    def look_up(self, service):
        """The address of a service once it is there."""
        return wait_until(lambda: service_address(self.uri, service))


class DirectStep(rospy.ServiceProxy):
    """Calls ~step at an address, and asks no master for it."""

    def __init__(self, master, node):
        super().__init__(node + '/step', Step)
        self._address = master.look_up(self.resolved_name)

    def _get_service_uri(self, request):
        return self._address


class TestMaster(unittest.TestCase):
    def setUp(self):
        self.master = Master()
        self.addCleanup(self.master.end)

    def start(self):
        process = NodeProcess(environment={'ROS_MASTER_URI': self.master.uri})
        self.addCleanup(process.__exit__)
        return process

    def assert_time_goes_on(self, step):
        before = step(steps=0).time
        wait_until(lambda: step(steps=0).time > before + 0.1)

    def test_gone_and_back(self):
        self.master.begin()
        process = self.start()
        step = DirectStep(self.master, process.name)
        self.assert_time_goes_on(step)
        self.master.end()
        self.assert_time_goes_on(step)
        self.master.begin()
        self.assert_time_goes_on(step)
        self.assertEqual(0, process.stop(), process.output())

    def test_the_node_ends_while_it_is_gone(self):
        self.master.begin()
        process = self.start()
        self.master.look_up(process.name + '/step')
        self.master.end()
        self.assertEqual(0, process.stop(), process.output())

    def test_that_comes_late(self):
        process = self.start()
        wait_until(lambda: 'Failed to contact master' in process.output())
        self.master.begin()
        self.assert_time_goes_on(DirectStep(self.master, process.name))
        self.assertEqual(0, process.stop(), process.output())

    def test_that_never_comes(self):
        process = self.start()
        wait_until(lambda: 'Failed to contact master' in process.output())
        self.assertEqual(0, process.stop(), process.output())
