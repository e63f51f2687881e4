"""plot_energies, on a bag recorded from a run."""

import os
import subprocess
import tempfile

import numpy as np
import roslib.packages
from matplotlib import colors, image

from node_client import NodeTest, wait_until
from scenes import add_octant


class TestPlot(NodeTest):
    def setUp(self):
        super().setUp()
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.bag, self.picture = (os.path.join(directory.name, n) for n in ('a.bag', 'a.png'))

    def record(self, topic):
        with subprocess.Popen(['rosbag', 'record', '-l', '40', '-O', self.bag, topic],
                              stdout=subprocess.DEVNULL) as recorder:
            wait_until(lambda: recorder.poll() is not None)

    def plot(self, *arguments):
        program = roslib.packages.find_node('spherical_springs', 'plot_energies')[0]
        return subprocess.run([program, self.bag, self.picture, *arguments],
                              stderr=subprocess.PIPE, text=True)

    def test_draws_what_was_recorded(self):
        add_octant(self.node, damping=0.5)
        self.node.set_running(True)
        self.record('/spherical_springs/energies')
        self.assertEqual(0, self.plot().returncode)
        pixels = image.imread(self.picture)[..., :3]
        for colour, there in (('#E69F00', True), ('#0072B2', True), ('#999999', True),
                              ('#009E73', False), ('#CC79A7', False)):
            found = np.all(abs(pixels - colors.to_rgb(colour)) < 0.02, axis=2).sum()
            self.assertEqual(there, found > 50, colour)

    def assert_refused(self, *words, arguments=()):
        outcome = self.plot(*arguments)
        self.assertEqual(1, outcome.returncode)
        self.assertEqual(1, outcome.stderr.count('\n'), outcome.stderr)
        for word in words:
            self.assertIn(word, outcome.stderr)
        self.assertFalse(os.path.exists(self.picture))

    def test_says_what_is_wrong(self):
        self.assert_refused('a.bag')
        with open(self.bag, 'w') as file:
            file.write('not a bag\n' * 1000)
        self.assert_refused('plot_energies')
        os.remove(self.bag)
        self.record('/spherical_springs/poses')
        self.assert_refused('a.bag', 'Energies')
        self.assert_refused('/elsewhere', arguments=('--topic', '/elsewhere'))
