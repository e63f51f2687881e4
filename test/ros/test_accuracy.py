"""~accuracy and the integrator `automatic`: at start, while the node runs, and in ~step."""

import math

from node_client import wait_until
from reconfiguring import ReconfigurationTest
from scenes import add_octant, angle_spring, exact

ACCURACY = 1e-6


class TestAccuracy(ReconfigurationTest):
    def chosen(self, condition=lambda status: True):
        """The first status of a step that an accuracy has chosen."""
        return self.status(lambda s: s.time_step != 0.001 and condition(s))

    def test_at_start(self):
        self.start(running='false', accuracy=ACCURACY, integrator='automatic')
        add_octant(self.node, damping=0)
        status = self.chosen()
        self.assertEqual('fourth_order', status.integrator)
        self.assertLess(0, status.error_rate)
        self.assertLess(status.error_rate, 1.5 * ACCURACY)
        self.assertLess(status.time_step, status.stable_time_step)
        self.assertIn('chose steps of fourth_order, ', status.message)
        self.assertAlmostEqual(10 * status.time_step, self.node.step(steps=10).time, delta=1e-12)
        wait_until(lambda: self.reconfigure.shown()['time_step'] == status.time_step)
        self.assertEqual('automatic', self.reconfigure.shown()['integrator'])

    def test_by_reconfiguration_while_it_runs(self):
        self.start()
        add_octant(self.node, damping=0)
        other = self.another_client()
        held = self.reconfigure(accuracy=ACCURACY, integrator='automatic')
        self.assertEqual('automatic', held['integrator'])
        before = self.chosen(lambda s: s.integrator == 'fourth_order')
        self.assertEqual(held['time_step'], before.time_step)
        self.assertEqual('running', before.state)
        self.assertIn('~accuracy is 1e-06', before.message)
        finer = other(accuracy=1e-9)
        after = self.status(lambda s: s.time_step == finer['time_step'])
        self.assertLess(after.time_step, before.time_step / 2)
        self.assertGreater(after.time, before.time)
        self.assertEqual(3, after.particles)
        self.assertGreater(self.status(lambda s: s.real_time_factor > 0.8).time, after.time)
        off = self.reconfigure(accuracy=0.0, integrator='verlet')
        self.assertEqual(finer['time_step'], off['time_step'])

    def test_another_scene_gets_another_step(self):
        self.start(running='false', accuracy=ACCURACY)
        ids = add_octant(self.node, damping=0)
        first = self.chosen().time_step
        self.node.add_springs(angle_springs=[angle_spring(ids[:2], 1e4, rest_angle=1)])
        status = self.status(lambda s: s.time_step < first / 10)
        self.assertEqual('verlet', status.integrator)
        self.assertIn('chose steps of verlet', status.message)

    def test_a_duration_is_kept_though_the_step_changes(self):
        self.start(running='false', accuracy=1e-7, integrator='automatic')
        add_octant(self.node, damping=0.5)
        first = self.chosen().time_step
        duration = 1e4 * first
        response = self.node.step(duration=duration)
        last = self.status(lambda s: s.steps == response.steps).time_step
        self.assertGreater(last, 1.5 * first)
        self.assertLess(response.steps, 9999)
        self.assertLess(abs(response.time - duration), 0.51 * last)
        self.assertEqual(12345, self.node.step(steps=12345).steps)

    def test_the_same_bits_however_steps_are_cut(self):
        self.start(running='false', accuracy=1e-5, integrator='automatic')
        add_octant(self.node, damping=0.1)
        self.node.step(steps=5000)
        expected = exact(self.node.get_scene())
        self.node.reset()
        for steps in (1, 999, 3000, 1000):
            self.node.step(steps=steps)
            self.status()
        self.assertEqual(expected, exact(self.node.get_scene()))

    def test_a_time_step_is_not_set_beside_it(self):
        self.start(running='false', accuracy=ACCURACY, time_step=0.25)
        add_octant(self.node, damping=0)
        chosen = self.status(lambda s: s.time_step != 0.25).time_step
        self.assertEqual(chosen, self.reconfigure(time_step=0.5)['time_step'])
        self.status(lambda s: '~accuracy chooses ~time_step' in s.message)
        self.assertEqual(chosen, self.status().time_step)
        self.assertEqual(0.5, self.reconfigure(time_step=0.5, accuracy=0.0)['time_step'])

    def test_automatic_needs_an_accuracy(self):
        self.start(running='false')
        self.assert_refuses("parameter ~integrator is 'automatic' while ~accuracy is 0",
                            integrator='automatic')
        self.reconfigure(integrator='automatic', accuracy=ACCURACY)
        wait_until(lambda: self.reconfigure.shown()['accuracy'] == ACCURACY)
        self.assert_refuses("parameter ~integrator is 'automatic' while ~accuracy is 0",
                            accuracy=0.0)

    def test_what_cannot_be_reached_is_said(self):
        self.start(running='false', accuracy=1e-17, integrator='automatic')
        add_octant(self.node, damping=0)
        status = self.chosen(lambda s: 'an accuracy of 1e-17 rad/s is out of reach' in s.message)
        self.assertTrue(math.isfinite(status.time_step))
        self.assertGreater(status.time_step, 1e-6)
        self.assertEqual(10, self.node.step(steps=10).steps)
