"""Every command of the README and its Python, in their order, as pasted; and its figures."""

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
NOT_RUN = {
    'scripts/test': 'it runs this test',
    'src/spherical_springs/scripts/setup --packages': 'it installs packages',
    'rosdep install --from-paths src --ignore-src --rosdistro noetic': 'it installs packages',
    'catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3': 'scripts/check_install builds a workspace',
    'source devel/setup.bash': 'scripts/check_install builds a workspace',
}


def text_of(path):
    with open(os.path.join(ROOT, path)) as file:
        return file.read()


def blocks():
    """Language and text of each block of code, in their order."""
    return re.findall(r'^```(\w*)\n(.*?)^```$', text_of('README.md'), re.MULTILINE | re.DOTALL)


def commands(text):
    lines = [line.split(' #')[0].strip() for line in text.splitlines()]
    return [line for line in lines if line]


def rows_of(path, heading):
    """The rows of the first table that begins so."""
    table = re.search('^' + re.escape(heading) + r'.*?\n\n', text_of(path), re.M | re.DOTALL)[0]
    return table.splitlines()


class TestTables(unittest.TestCase):
    def test_each_is_as_the_benchmark_has_it(self):
        for heading in ('| particles | springs |', '| scene | 0.001 rad/s asked |'):
            self.assertLessEqual(set(rows_of('README.md', heading)),
                                 set(rows_of('benchmark/README.md', heading)))


class TestPictures(unittest.TestCase):
    def test_each_is_there(self):
        pictures = re.findall(r'!\[.*?\]\((.*?)\)', text_of('README.md'))
        self.assertIn('doc/directions.png', pictures)
        for picture in pictures:
            self.assertTrue(os.path.exists(os.path.join(ROOT, picture)), picture)


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

    def run_python(self, text):
        """What it prints."""
        outcome = subprocess.run(
            ['python3', '-c', text], cwd=ROOT, env=self.environment, timeout=LONG, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(0, outcome.returncode, outcome.stdout)
        return outcome.stdout

    def test_commands(self):
        not_run = set(NOT_RUN)
        printed = None
        for language, text in blocks():
            if language == 'python':
                printed = self.run_python(text)
                continue
            if language == 'text':
                self.assertEqual(text, printed)
                continue
            self.assertEqual('', language)
            for command in commands(text):
                if command in NOT_RUN:
                    not_run.discard(command)
                elif command.startswith('roslaunch') and 'mesh.launch' not in command:
                    self.launch(command)
                else:
                    self.run_command(command)
        self.assertEqual(set(), not_run)
        self.assertIsNotNone(printed)
        self.assertTrue(os.path.exists(self.environment['HOME'] + '/energies.png'))

    def test_commands_that_are_not_run_are_there(self):
        for command in NOT_RUN:
            program = command.split()[0].replace('src/spherical_springs/', '')
            if program.startswith('scripts/'):
                self.assertTrue(os.access(os.path.join(ROOT, program), os.X_OK), program)
