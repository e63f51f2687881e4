"""A wrong parameter stops the node at start, with one line that says what is wrong."""

import os
import tempfile
import unittest

from node_client import NodeProcess

NOT_A_NUMBER = ('fast', 'true')

WRONG = {
    'time_step': ('0', '-1', 'nan', 'inf', '1e300', *NOT_A_NUMBER),
    'integrator': ('leapfrog', '2', 'true', 'Verlet'),
    'publish_rate': ('0', '-30', 'nan', 'inf', *NOT_A_NUMBER),
    'real_time_factor': ('0', '-1', 'nan', 'inf', *NOT_A_NUMBER),
    'running': ('maybe', '1', '0.5'),
    'frame_id': ('5', 'false', ''),
    'radius': ('0', '-2', 'nan', 'inf', *NOT_A_NUMBER),
    'scene': ('7', 'true', '/no/such/scene.json', '/'),
    'threads': ('-1', '1000000', 'nan', '1.5', *NOT_A_NUMBER),
    'spring_damping': ('absolute', '1', 'false'),
    'max_particles': ('-1', '1e300', 'nan', '2.5', *NOT_A_NUMBER),
    'max_springs': ('-7', '1e300', 'nan', '2.5', *NOT_A_NUMBER),
    'scene_directory': ('3', 'true', ''),
}


def fault(name, value):
    """What is amiss with how a node refuses a parameter; None where it is as it should be."""
    with NodeProcess(**{name: value}) as process:
        code = process.exit_code()
        lines = process.output().splitlines()
    if code == 0 or len(lines) != 1:
        return '%s:=%s: exit code %d and %s' % (name, value, code, lines)
    missing = [word for word in ('~' + name, value, 'allowed') if word not in lines[0]]
    return '%s:=%s: no %s in %s' % (name, value, missing, lines) if missing else None


class TestWrongParameters(unittest.TestCase):
    def assert_no_faults(self, name):
        faults = [fault(name, value) for value in WRONG[name]]
        self.assertEqual([], [f for f in faults if f])


def add_test(name):
    setattr(TestWrongParameters, 'test_' + name, lambda self: self.assert_no_faults(name))


for parameter in WRONG:
    add_test(parameter)


class TestWrongScene(unittest.TestCase):
    def test_a_file_that_is_no_scene(self):
        with tempfile.NamedTemporaryFile('w', suffix='.json') as file:
            file.write('{"format": "spherical_springs scene 1",\n "particles": [{"mass": -1}]}')
            file.flush()
            self.assertIsNone(fault('scene', file.name))
