"""Each parameter that changes while the node runs: what it does, and which values are refused."""

import math
import re

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dynamic_reconfigure.msg import Config, DoubleParameter, IntParameter
from dynamic_reconfigure.srv import Reconfigure
from rosgraph_msgs.msg import Clock
from spherical_springs.msg import Energies, Status
from visualization_msgs.msg import MarkerArray

from node_client import Listener, NodeProcess
from reconfiguring import ReconfigurationTest
from scenes import add_octant, add_random_scene, exact

NAN, INF = math.nan, math.inf
WRONG = {
    'time_step': (0, -1, NAN, INF, -INF, 1e300, 1e-13),
    'integrator': ('leapfrog', 'Verlet', '', 9999 * 'x'),
    'accuracy': (-1e-6, NAN, INF, -INF, 1e300),
    'real_time_factor': (0, -1, NAN, INF, 2e6),
    'publish_rate': (0, -30, NAN, INF, 20000),
}
ALLOWED = {
    'time_step': '1e-12 to 1e6 [s]',
    'integrator': 'euler, verlet, fourth_order, implicit_euler, automatic',
    'accuracy': '0 (off) to 1e6 [rad/s]',
    'real_time_factor': '1e-6 to 1e6',
    'publish_rate': '0.001 to 10000 [Hz]',
}


class TestStart(ReconfigurationTest):
    def test_the_parameters_of_the_start_are_shown(self):
        chosen = {'time_step': 0.125, 'integrator': 'euler', 'real_time_factor': 3.0,
                  'publish_rate': 7.0}
        self.start(running='false', **chosen)
        self.assert_holds(running=False, **chosen)

    def test_a_whole_number_is_a_real_one(self):
        self.start(time_step=1, publish_rate=2)
        self.assert_holds(time_step=1.0, publish_rate=2.0)

    def test_defaults(self):
        self.start()
        self.assert_holds()

    def test_clients_are_told_of_no_limit_that_would_cut_values(self):
        self.start()
        for described in self.reconfigure.descriptions():
            if described['type'] == 'double':
                self.assertLessEqual(described['min'], -1e300)
                self.assertGreaterEqual(described['max'], 1e300)


class TestChanges(ReconfigurationTest):
    def test_time_step(self):
        self.start(running='false')
        self.assertAlmostEqual(0.003, self.node.step(steps=3).time)
        self.reconfigure(time_step=0.125)
        self.assert_holds(time_step=0.125, running=False)
        self.assertAlmostEqual(0.378, self.node.step(steps=3).time)
        self.assertEqual(8, self.node.step(duration=1).steps)

    def test_integrator(self):
        self.start(running='false')
        for integrator in ('euler', 'fourth_order', 'implicit_euler', 'verlet'):
            self.reconfigure(integrator=integrator)
            self.assert_holds(integrator=integrator, running=False)
            self.assertEqual(5, self.node.step(steps=5).steps)

    def test_time_step_and_integrator_are_those_of_the_steps_to_come(self):
        self.start(running='false')
        add_random_scene(self.node, seed=1)
        self.reconfigure(time_step=0.01, integrator='euler')
        self.node.step(steps=10)
        expected = exact(self.node.get_scene())
        self.node.reset()
        with NodeProcess(running='false', time_step=0.01, integrator='euler') as process:
            add_random_scene(process.client(), seed=1)
            process.client().step(steps=10)
            self.assertEqual(expected, exact(process.client().get_scene()))

    def test_scene_and_time_stay(self):
        self.start(running='false')
        add_random_scene(self.node, seed=1)
        self.node.step(steps=100)
        before = exact(self.node.get_scene())
        self.reconfigure(time_step=0.01, integrator='fourth_order', real_time_factor=2,
                         publish_rate=50)
        self.assertEqual(before, exact(self.node.get_scene()))
        self.assert_holds(time_step=0.01, integrator='fourth_order', real_time_factor=2.0,
                          publish_rate=50.0, running=False)
        self.assertEqual(before, exact(self.node.get_scene()))

    def test_real_time_factor(self):
        self.start(real_time_factor=1e-6)
        self.assertLess(self.status().time, 0.01)
        self.reconfigure(real_time_factor=100)
        self.assert_holds(real_time_factor=100.0)
        self.status(lambda s: s.time > 10)
        self.assertGreater(self.status(lambda s: s.real_time_factor > 5).real_time_factor, 5)

    def test_publish_rate(self):
        self.start(publish_rate=0.001)
        add_octant(self.node, damping=0)
        with self.node.listen('energies', Energies) as samples, \
                self.node.listen('markers', MarkerArray) as markers:
            markers.first()
            self.assertEqual([], samples.all())
            self.reconfigure(publish_rate=100)
            samples.several(20)
            markers.several(3)
        self.assert_holds(publish_rate=100.0)

    def test_running(self):
        self.start()
        for running, state in ((False, 'paused'), (True, 'running')):
            self.reconfigure(running=running)
            self.assert_holds(running=running)
            self.status(lambda s: s.state == state)
        time = self.status().time
        self.status(lambda s: s.time > time)

    def test_set_running_is_shown(self):
        self.start()
        for running in (False, True):
            self.node.set_running(running)
            self.assert_holds(running=running)

    def test_the_last_call_wins_whatever_clients_have_seen(self):
        self.start()
        for _ in range(20):
            self.node.set_running(False)
            self.assertFalse(self.reconfigure(publish_rate=20)['running'])
            self.assertTrue(self.reconfigure(running=True)['running'])

    def test_a_change_is_told(self):
        self.start(running='false')
        self.reconfigure(time_step=0.5, running=False)
        self.status(lambda s: s.message == 'reconfigured: ~time_step is 0.5')


class TestRefusals(ReconfigurationTest):
    def test_wrong_values_leave_everything(self):
        self.start(running='false')
        add_random_scene(self.node, seed=1)
        self.node.step(steps=100)
        before = exact(self.node.get_scene())
        for name, wrong in WRONG.items():
            for value in wrong:
                shown = '%.16g' % value if isinstance(value, (int, float)) else value[:50]
                allowed = re.escape(ALLOWED[name])
                self.assert_refuses(
                    'parameter ~%s is .*%s.*; allowed: %s' % (
                        name, shown.replace('+', '\\+'), allowed), **{name: value})
        self.assertEqual(before, exact(self.node.get_scene()))
        self.assert_holds(running=False)

    def test_an_update_is_taken_whole_or_not_at_all(self):
        self.start(running='false')
        for name, wrong in WRONG.items():
            good = {'time_step': 0.5, 'integrator': 'euler', 'real_time_factor': 2.0,
                    'publish_rate': 5.0, 'running': True}
            self.assert_refuses('~' + name, **{**good, name: wrong[0]})
        self.assert_holds(running=False)
        self.assertEqual('paused', self.status().state)
        self.assertEqual(0, self.node.get_scene().time)

    def test_a_warning_hides_no_reason(self):
        self.start(running='false', time_step=100)
        add_octant(self.node, damping=0)
        self.status(lambda s: s.message.startswith('the time step'))
        self.reconfigure(publish_rate=-1)
        self.status(lambda s: 'publish_rate is -1; allowed: ' in s.message and
                    '; the time step' in s.message)

    def test_what_is_no_parameter(self):
        self.start()
        call = rospy.ServiceProxy(self.process.name + '/set_parameters', Reconfigure)
        rate = DoubleParameter('publish_rate', 5)
        for update in (
                Config(doubles=[rate, DoubleParameter('radius', 2)]),
                Config(doubles=[rate, rate]),
                Config(doubles=[rate], ints=[IntParameter('time_step', 1)])):
            self.assertIn(DoubleParameter('publish_rate', 30), call(update).config.doubles)
            self.status(lambda s: 'unknown or of another type; allowed: time_step' in s.message)
        self.assert_holds()

    def test_a_number_that_is_not_finite_is_an_error_in_diagnostics(self):
        self.start(running='false')
        with Listener('/diagnostics', DiagnosticArray) as arrays:
            self.reconfigure(time_step=NAN)
            arrays.first(lambda a: a.status[0].name.startswith(self.process.name[1:]) and
                         a.status[0].level == DiagnosticStatus.ERROR and
                         'refused: parameter ~time_step is nan' in a.status[0].message)


class TestClock(ReconfigurationTest):
    """The clock stands but where the test moves it."""

    def setUp(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=100, latch=True)
        self.addCleanup(self.publisher.unregister)

    def simulated_when_clock_is(self, seconds):
        """The time of the scene once the node has seen the clock and stands still again."""
        self.publisher.publish(Clock(rospy.Time.from_sec(seconds)))
        with self.node.listen('status', Status) as statuses:
            return statuses.several(
                3, lambda s: abs(s.header.stamp.to_sec() - seconds) < 1e-6)[-1].time

    def test_time_does_not_jump(self):
        self.start()
        self.simulated_when_clock_is(100)
        before = self.simulated_when_clock_is(100.5)
        self.assertLessEqual(before, 0.501)
        for clock, factor, time_step, most in (
                (100.6, 1e-6, 1000.0, 0), (100.9, 1.0, 0.5, 0), (101, 1.0, 0.001, 0.101),
                (101.5, 4.0, 0.25, 2)):
            self.reconfigure(real_time_factor=factor, time_step=time_step)
            after = self.simulated_when_clock_is(clock)
            self.assertLessEqual(after - before, most + 1e-9)
            before = after
        self.assertGreater(before, 1)
