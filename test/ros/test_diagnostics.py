"""/diagnostics: OK, WARN, ERROR, and the figures of Status."""

import math
import unittest

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from node_client import Listener, NodeProcess, Refused
from scenes import add_octant, particle

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


def paused(**parameters):
    return NodeProcess(running='false', **parameters)


class TestDiagnostics(unittest.TestCase):
    def setUp(self):
        self.arrays = Listener('/diagnostics', DiagnosticArray)
        self.arrays.__enter__()
        self.addCleanup(self.arrays.__exit__)

    def status_of(self, process, condition):
        """Of that node, the first from now that fulfils the condition."""
        seen = len(self.arrays.all())

        def found(array):
            return (array in self.arrays.all()[seen:] and
                    array.status[0].name == process.name[1:] + ': Simulation' and
                    condition(array.status[0]))
        return self.arrays.first(found).status[0]

    def assert_comes(self, process, level, text=''):
        self.status_of(process, lambda s: s.level == level and text in s.message)

    def test_figures(self):
        with paused() as process:
            node = process.client()
            add_octant(node, damping=0.1)
            node.step(steps=50)
            # While it takes steps on request it is running, at the last of them too.
            status = self.status_of(
                process, lambda s: s.message == 'paused' and
                {v.key: v.value for v in s.values}.get('steps') == '50')
            figures = {v.key: v.value for v in status.values}
            self.assertEqual(OK, status.level)
            self.assertAlmostEqual(0.05, float(figures['time [s]']))
            self.assertEqual('3', figures['angle springs'])
            self.assertEqual('verlet', figures['integrator'])
            self.assertEqual(0.001, float(figures['time step [s]']))
            for key, value in figures.items():
                if key not in ('state', 'integrator', 'message'):
                    self.assertTrue(math.isfinite(float(value)), key)
            node.set_running(True)
            self.assert_comes(process, OK, 'running')

    def test_comes_again_and_again(self):
        with paused() as process:
            for _ in range(3):
                self.status_of(process, lambda status: True)

    def test_warns_when_behind_real_time(self):
        with NodeProcess(real_time_factor=1e6) as process:
            add_octant(process.client(), damping=0.1)
            self.assert_comes(process, WARN, 'behind')

    def test_warns_of_a_step_above_the_stable_one(self):
        with paused(time_step=2) as process:
            add_octant(process.client(), damping=0)
            self.assert_comes(process, WARN, 'above the stable one')

    def test_warns_of_a_relaxation_that_does_not_converge(self):
        with paused() as process:
            node = process.client()
            add_octant(node, damping=0)
            self.assertFalse(node.relax(method='dynamics', max_time=1e-9).converged)
            self.assert_comes(process, WARN, 'not converged')
            self.assertTrue(node.relax().converged)
            self.assert_comes(process, OK)

    def test_numbers_that_are_not_finite_are_an_error_for_a_while(self):
        with paused() as process:
            node = process.client()
            with self.assertRaises(Refused):
                node.add_particles([particle((1, 0, 0)), particle((math.nan, 0, 0))])
            self.assert_comes(process, ERROR, 'particles[1].position')
            self.assert_comes(process, OK)
            with self.assertRaises(Refused):
                node.add_particles([particle((1, 0, 0), mass=math.inf)])
            self.assert_comes(process, ERROR, 'particles[0].mass')

    def test_other_refusals_are_not(self):
        with paused() as process:
            node = process.client()
            with self.assertRaises(Refused):
                node.add_particles([particle((1, 0, 0), mass=-1)])
            self.assert_comes(process, OK)

    def test_what_has_blown_up_is_an_error(self):
        with paused(time_step=5) as process:
            node = process.client()
            add_octant(node, damping=0)
            node.step(steps=1000)
            self.assert_comes(process, ERROR, 'blown up')

    def test_what_lies_at_rest_has_not_blown_up(self):
        with NodeProcess(real_time_factor=10) as process:
            node = process.client()
            add_octant(node, damping=0)
            node.relax()
            begin = node.get_scene().time
            status = self.status_of(process, lambda s: float(
                {v.key: v.value for v in s.values}['time [s]']) > begin + 20)
            self.assertEqual((OK, 'running'), (status.level, status.message))
