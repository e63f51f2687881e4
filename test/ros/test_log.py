"""What the node writes for the person who has started it."""

import os
import tempfile
import unittest

import rospkg
import rospy
from spherical_springs.msg import Particle

from node_client import PACKAGE, NodeProcess, Refused, wait_until

OCTANT = os.path.join(rospkg.RosPack().get_path(PACKAGE), 'launch', 'octant.json')


def lines_of(process, level):
    return [line for line in process.output().splitlines() if level in line]


class TestStart(unittest.TestCase):
    def test_one_line_says_what_runs(self):
        with tempfile.TemporaryDirectory() as directory:
            with NodeProcess(running='false', scene=OCTANT, threads=2, time_step=0.01,
                             integrator='fourth_order', scene_directory=directory) as process:
                process.client()
                line, = wait_until(lambda: lines_of(process, 'INFO'))
        for words in ('paused: 3 particles, 3 springs; fourth_order, time step 0.01 s (stable up ',
                      '; 2 threads; ', 'octant.json', 'files in ' + os.path.realpath(directory)):
            self.assertIn(words, line)

    def test_without_a_scene(self):
        with NodeProcess(threads=1) as process:
            line, = wait_until(lambda: lines_of(process, 'INFO'))
        self.assertIn('running: 0 particles, 0 springs', line)
        self.assertIn('1 thread; scene none', line)

    def test_names_are_written_as_they_are(self):
        for locale in ('C', 'C.UTF-8'):
            with NodeProcess(scene='/nowhere/Kugelfläche.json',
                             environment={'LC_ALL': locale}) as process:
                self.assertEqual(1, process.exit_code())
                self.assertIn('/nowhere/Kugelfläche.json', process.output())


class TestRefusals(unittest.TestCase):
    def test_are_warnings_in_the_log(self):
        with NodeProcess(running='false') as process:
            node = process.client()
            with self.assertRaises(Refused) as refusal:
                node.add_particles([Particle(mass=-1)])
            with self.assertRaises(Refused):
                node.load_scene('none.json')
            wait_until(lambda: len(lines_of(process, 'WARN')) >= 2)
            added, loaded = lines_of(process, 'WARN')
            self.assertIn('~add_particles refused: ' + str(refusal.exception), added)
            self.assertIn('~load_scene refused: ', loaded)

    def test_do_not_fill_the_log(self):
        with NodeProcess(running='false') as process:
            node = process.client()
            for _ in range(50):
                with self.assertRaises(Refused):
                    node.add_particles([Particle(mass=-1)])
            wait_until(lambda: lines_of(process, 'WARN'))
            self.assertLess(len(lines_of(process, 'WARN')), 25)


class TestUnknownParameters(unittest.TestCase):
    def test_are_named_with_the_nearest(self):
        with NodeProcess(timestep=0.01, intergrator='implicit_euler', radius=2,
                         diagnostic_period=1) as process:
            process.client()
            warnings = ' '.join(wait_until(lambda: lines_of(process, 'WARN')))
            self.assertEqual(2, len(lines_of(process, 'WARN')), warnings)
            self.assertRegex(warnings, r'~timestep .* the nearest is ~time_step\b')
            self.assertRegex(warnings, r'~intergrator .* the nearest is ~integrator\b')


class TestNumbersAsPeopleWriteThem(unittest.TestCase):
    def started_with(self, **parameters):
        """A node whose parameters keep their types."""
        name = '/springs_as_written'
        rospy.set_param(name, parameters)
        self.addCleanup(rospy.delete_param, name)
        process = NodeProcess(name=name)
        self.addCleanup(process.__exit__)
        return process

    def test_are_taken(self):
        process = self.started_with(time_step='1e-3', threads='2.0', max_particles=1.0e1,
                                    radius='2', running='false', real_time_factor=2)
        process.client()
        line, = wait_until(lambda: lines_of(process, 'INFO'))
        self.assertIn('paused: 0 particles, 0 springs; verlet, time step 0.001 s', line)
        self.assertIn('2 threads', line)
        with self.assertRaisesRegex(Refused, 'at most 10'):
            process.client().add_particles([Particle()] * 11)

    def assert_refused(self, words, **parameters):
        process = self.started_with(**parameters)
        self.assertEqual(1, process.exit_code())
        self.assertIn(words, process.output())

    def test_a_text_that_is_no_number(self):
        self.assert_refused("parameter ~time_step is '1 ms', a text where a number is wanted; "
                            'allowed: 1e-12 to 1e6 [s]', time_step='1 ms')

    def test_a_number_for_a_text(self):
        self.assert_refused('parameter ~scene_directory is 2024, a number where a text is wanted',
                            scene_directory=2024)

    def test_a_number_that_is_not_whole(self):
        self.assert_refused('parameter ~threads is 2.5; allowed: whole numbers', threads=2.5)

    def test_a_number_for_a_truth(self):
        self.assert_refused('parameter ~running is 0, a number where a truth value is wanted; '
                            'allowed: true, false', running=0)

    def test_a_list(self):
        self.assert_refused('a list where a number is wanted', radius=[1, 2])
