"""A wrong parameter stops the node at start, with one line that says what is wrong."""

import contextlib
import tempfile
import unittest

from node_client import NodeProcess

ENOUGH = 10  # [s] for a node to find out and end
NOT_A_NUMBER = ('fast', 'true')

WRONG = {
    'time_step': ('0', '-1', 'nan', 'inf', '1e+300', *NOT_A_NUMBER),
    'integrator': ('leapfrog', '2', 'true', 'Verlet', 'automatic'),
    'accuracy': ('-1', 'nan', 'inf', '1e+300', *NOT_A_NUMBER),
    'publish_rate': ('0', '-30', 'nan', 'inf', *NOT_A_NUMBER),
    'real_time_factor': ('0', '-1', 'nan', 'inf', *NOT_A_NUMBER),
    'running': ('maybe', '1', '0.5'),
    'frame_id': ('5', 'false', ''),
    'radius': ('0', '-2', 'nan', 'inf', *NOT_A_NUMBER),
    'scene': ('7', 'true', '/no/such/scene.json', '/'),
    'threads': ('-1', '1000000', 'nan', '1.5', *NOT_A_NUMBER),
    'spring_damping': ('absolute', '1', 'false'),
    'max_particles': ('-1', '400000001', '1e+300', 'nan', '2.5', *NOT_A_NUMBER),
    'max_springs': ('-7', '600000001', '2000000000', '1e+300', 'nan', '2.5', *NOT_A_NUMBER),
    'scene_directory': ('3', 'true', ''),
}


def fault(process, name, value):
    """What is amiss with how a node refuses a parameter; None where it is as it should be."""
    code = process.exit_code(ENOUGH)
    lines = process.output().splitlines()
    if not code or len(lines) != 1:
        return '%s:=%s: exit code %s and %s' % (name, value, code, lines)
    missing = [word for word in ('~' + name, value, 'allowed') if word not in lines[0]]
    return '%s:=%s: no %s in %s' % (name, value, missing, lines) if missing else None


def faults(name, values):
    with contextlib.ExitStack() as stack:
        processes = [stack.enter_context(NodeProcess(**{name: value})) for value in values]
        found = [fault(process, name, value) for process, value in zip(processes, values)]
    return [f for f in found if f]


class TestWrongParameters(unittest.TestCase):
    maxDiff = None

    def test_each_is_refused(self):
        self.assertEqual([], [f for name, values in WRONG.items() for f in faults(name, values)])

    def test_an_empty_text_is_seen(self):
        with NodeProcess(frame_id='') as process:
            self.assertIsNone(fault(process, 'frame_id', "~frame_id is ''; allowed: "))

    def test_of_a_long_text_there_is_the_beginning(self):
        with NodeProcess(integrator=9999 * 'x') as process:
            self.assertIsNone(fault(process, 'integrator', "xxx...' (9999 bytes); allowed: "))
            self.assertLess(len(process.output()), 500)

    def test_a_scene_that_is_none(self):
        with tempfile.NamedTemporaryFile('w', suffix='.json') as file:
            file.write('{"format": "spherical_springs scene 1",\n "particles": [{"mass": -1}]}')
            file.flush()
            self.assertEqual([], faults('scene', [file.name]))

    def test_a_scene_directory_that_is_a_file(self):
        with tempfile.NamedTemporaryFile() as file:
            self.assertEqual([], faults('scene_directory', [file.name]))
