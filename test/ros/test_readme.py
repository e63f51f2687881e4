"""Every command of the README, in its order, as pasted; and its figures."""

import os
import re
import signal
import subprocess
import tempfile
import unittest

import rospkg

from node_client import LONG, PACKAGE, NodeClient
from rviz_window import MISSING, Display

ROOT = rospkg.RosPack().get_path(PACKAGE)
NOT_RUN = {'scripts/test': 'it runs this test'}


def text_of(path):
    with open(os.path.join(ROOT, path)) as file:
        return file.read()


def commands():
    blocks = re.findall(r'^```\n(.*?)^```$', text_of('README.md'), re.MULTILINE | re.DOTALL)
    lines = [line.split(' #')[0].strip() for block in blocks for line in block.splitlines()]
    return [line for line in lines if line]


def table_of_stepping(path):
    """The first, with a row for each size."""
    return re.search(r'^\| particles \| springs \|.*?\n\n', text_of(path), re.M | re.DOTALL)[0]


class TestTables(unittest.TestCase):
    def test_stepping_is_as_the_benchmark_has_it(self):
        self.assertEqual(table_of_stepping('benchmark/README.md'), table_of_stepping('README.md'))


class TestReadme(unittest.TestCase):
    def setUp(self):
        home = tempfile.TemporaryDirectory()
        self.addCleanup(home.cleanup)
        self.environment = {**os.environ, 'HOME': home.name, 'PWD': ROOT}
        if not MISSING:
            display = Display()
            self.environment.update(display.__enter__())
            self.addCleanup(display.__exit__)
        self.launched = None
        self.addCleanup(self.stop)

    def launch(self, command):
        """In the place of what ran before."""
        self.stop()
        self.launched = subprocess.Popen(command.split(), cwd=ROOT, env=self.environment,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        NodeClient()

    def stop(self):
        if self.launched:
            self.launched.send_signal(signal.SIGINT)
            self.launched.wait(LONG)

    def run_command(self, command):
        outcome = subprocess.run(
            ['bash', '-c', command], cwd=ROOT, env=self.environment, timeout=4 * LONG, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(0, outcome.returncode, command + '\n' + outcome.stdout)
        if command.startswith('rosservice call'):
            self.assertIn('success: True', outcome.stdout, command)

    def test_commands(self):
        self.assertLessEqual(NOT_RUN.keys(), set(commands()))
        for command in commands():
            if command in NOT_RUN:
                self.assertTrue(os.access(os.path.join(ROOT, command), os.X_OK))
            elif command.startswith('roslaunch'):
                self.launch(command)
            else:
                self.run_command(command)
        self.assertTrue(os.path.exists(self.environment['HOME'] + '/energies.png'))
