"""A wall clock that somebody sets back while the node runs."""

import os
import tempfile
import unittest

import roslib.packages
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray
from spherical_springs.msg import Energies, Status
from visualization_msgs.msg import MarkerArray

from node_client import PACKAGE, Listener, NodeProcess
from scenes import add_octant


def preloaded():
    """The library that shifts the clock."""
    program = os.path.realpath(roslib.packages.find_node(PACKAGE, PACKAGE + '_node')[0])
    return os.path.join(os.path.dirname(os.path.dirname(program)),
                        'lib%s_shifted_clock.so' % PACKAGE)


class TestWallClock(unittest.TestCase):
    HOUR = 3600  # [s]

    def setUp(self):
        file = tempfile.NamedTemporaryFile('w')
        self.addCleanup(file.close)
        self.shift = file.name
        self.set_clock(0)
        self.process = NodeProcess(
            environment={'LD_PRELOAD': preloaded(), 'CLOCK_SHIFT': self.shift})
        self.addCleanup(self.process.__exit__)
        self.node = self.process.client()

    def set_clock(self, seconds):
        with open(self.shift, 'w') as file:
            file.write(str(seconds))

    def test_all_topics_go_on(self):
        add_octant(self.node, damping=0)
        with self.node.listen('poses', PoseArray) as poses, \
                self.node.listen('energies', Energies) as energies, \
                self.node.listen('status', Status) as statuses, \
                self.node.listen('markers', MarkerArray) as markers, \
                Listener('/diagnostics', DiagnosticArray) as diagnostics:
            listeners = (poses, energies, statuses, markers, diagnostics)
            for listener in listeners:
                listener.several(2)
            now = statuses.all()[-1].header.stamp.to_sec()
            self.set_clock(-self.HOUR)
            statuses.first(lambda status: status.header.stamp.to_sec() < now - self.HOUR / 2)
            for listener in listeners:
                listener.several(len(listener.all()) + 4)
            self.node.cancel()

    def test_time_goes_on(self):
        add_octant(self.node, damping=0)
        with self.node.listen('energies', Energies) as samples:
            samples.first()
            self.set_clock(-self.HOUR)
            stopped = samples.all()[-1].time
            samples.first(lambda sample: sample.time > stopped + 1)
