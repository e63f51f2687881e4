"""A node that is changed while it runs, by clients of dynamic_reconfigure."""

import re
import unittest

import rospy
from dynamic_reconfigure.client import Client
from spherical_springs.msg import Status

from node_client import LONG, NodeProcess, wait_until

DEFAULTS = {'time_step': 0.001, 'integrator': 'verlet', 'accuracy': 0.0, 'real_time_factor': 1.0,
            'publish_rate': 30.0, 'running': True}


def values(configuration):
    return {name: configuration[name] for name in DEFAULTS}


class Reconfiguring:
    """A client of dynamic_reconfigure, one of maybe several of a node."""

    def __init__(self, name):
        self._client = Client(name, timeout=LONG)

    def __call__(self, **changes):
        """The configuration that the node answers."""
        return values(self._client.update_configuration(changes))

    def shown(self):
        """The configuration that was shown last."""
        return values(self._client.get_configuration(LONG))

    def descriptions(self):
        return self._client.get_parameter_descriptions(LONG)

    def close(self):
        self._client.close()


class ReconfigurationTest(unittest.TestCase):
    """A test that starts a node of its own."""

    maxDiff = None

    def start(self, **parameters):
        self.process = NodeProcess(**parameters)
        self.addCleanup(self.process.__exit__)
        self.node = self.process.client()
        self.reconfigure = self.another_client()
        self.statuses = self.node.listen('status', Status)
        self.statuses.__enter__()
        self.addCleanup(self.statuses.__exit__)

    def another_client(self):
        client = Reconfiguring(self.process.name)
        self.addCleanup(client.close)
        return client

    def status(self, condition=lambda status: True):
        """The first one from now that fulfils the condition."""
        since = rospy.Time.now()
        return self.statuses.first(lambda s: s.header.stamp > since and condition(s))

    def assert_holds(self, **expected):
        """With the defaults for what is not named: seen by clients, parameter server and status."""
        expected = {**DEFAULTS, **expected}
        wait_until(lambda: self.reconfigure.shown() == expected)
        self.assertEqual(expected, values(rospy.get_param(self.process.name)))
        status = self.status()
        self.assertEqual(expected['time_step'], status.time_step)
        self.assertEqual(expected['integrator'], status.integrator)

    def assert_refuses(self, reason, **changes):
        before = self.reconfigure.shown()
        self.assertEqual(before, self.reconfigure(**changes), changes)
        words = re.compile('not reconfigured: .*' + reason)
        self.status(lambda s: words.match(s.message))
        wait_until(lambda: words.search(self.process.output()))
        self.assertEqual(before, self.reconfigure.shown())
        self.assertEqual(before, values(rospy.get_param(self.process.name)))
