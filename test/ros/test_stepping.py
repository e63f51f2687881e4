import math

import numpy as np
from spherical_springs.msg import Energies, Status

from node_client import NodeTest, Refused, wait_until
from scenes import add_random_scene, exact, particle, positions

TIME_STEP = 1e-3


class TestStep(NodeTest):
    def test_exactly_that_many(self):
        speed = 1.25
        self.node.add_particles([particle((1, 0, 0), (0, 0, speed))])
        for steps, total in ((1, 1), (9, 10), (990, 1000)):
            response = self.node.step(steps=steps)
            self.assertAlmostEqual(total * TIME_STEP, response.time, delta=1e-12)
            x, y, _ = positions(self.node.get_scene())[0]
            self.assertAlmostEqual(total * TIME_STEP * speed, math.atan2(y, x), delta=1e-12)
        with self.node.listen('status', Status) as statuses:
            statuses.first(lambda status: status.steps == 1000)

    def test_many_at_once_are_as_many_one_by_one(self):
        add_random_scene(self.node, seed=1)
        for _ in range(60):
            self.node.step(steps=1)
        one_by_one = self.node.get_scene()
        self.node.reset()
        self.node.step(steps=60)
        self.assertEqual(exact(one_by_one), exact(self.node.get_scene()))

    def test_none_only_reports(self):
        add_random_scene(self.node, seed=2)
        last = self.node.step(steps=7)
        before = self.node.get_scene()
        report = self.node.step(steps=0)
        self.assertEqual(exact(before), exact(self.node.get_scene()))
        self.assertEqual(last.time, report.time)
        last.energies.header.stamp = report.energies.header.stamp
        self.assertEqual(exact(last.energies), exact(report.energies))

    def test_reports_the_energies_of_where_it_has_come_to(self):
        add_random_scene(self.node, seed=3)
        for _ in range(3):
            response = self.node.step(steps=20)
            self.assertEqual(response.time, response.energies.time)
            self.assertEqual(response.time, self.node.get_scene().time)
            self.assertGreaterEqual(response.wall_time, 0)
        with self.node.listen('energies', Energies) as samples:
            sample = samples.first(lambda sample: sample.time == response.time)
        self.assertEqual(response.energies.header.frame_id, sample.header.frame_id)
        sample.header = response.energies.header
        self.assertEqual(exact(response.energies), exact(sample))

    def test_an_empty_scene_has_time_too(self):
        self.assertAlmostEqual(5 * TIME_STEP, self.node.step(steps=5).time, delta=1e-12)


class TestDuration(NodeTest):
    def test_takes_the_nearest_whole_number_of_steps(self):
        for duration, steps in ((0.01, 10), (0.0104, 10), (0.0106, 11), (1, 1000)):
            before = self.node.step().time
            response = self.node.step(duration=duration)
            self.assertEqual(steps, response.steps)
            self.assertAlmostEqual(before + steps * TIME_STEP, response.time, delta=1e-12)

    def test_of_less_than_half_a_step_takes_none_and_says_so(self):
        response = self.node.step(duration=0.0004)
        self.assertEqual((0, 0), (response.steps, response.time))
        self.assertIn('0.0004', response.message)
        self.assertIn('0.001', response.message)

    def test_that_is_wrong_is_refused(self):
        for fields, words in (
                ({'duration': -1}, ('duration is -1', '0 to')),
                ({'duration': math.nan}, ('duration is nan', '0 to')),
                ({'duration': math.inf}, ('duration is inf', '0 to')),
                ({'duration': 1e300}, ('duration is 1e+300', '4294967295 steps')),
                ({'duration': 1, 'steps': 2}, ('steps is 2', 'duration is 1', 'one of the two'))):
            with self.assertRaises(Refused) as refused:
                self.node.step(**fields)
            for word in words:
                self.assertIn(word, str(refused.exception))
        self.assertEqual(0, self.node.step().time)


class TestRunning(NodeTest):
    def run_a_while(self):
        self.node.set_running(True)
        begin = self.node.get_scene().time
        wait_until(lambda: self.node.get_scene().time > begin + 0.1)

    def test_time_goes_on_until_paused(self):
        self.node.add_particles([particle((1, 0, 0), (0, 1, 1))])
        self.run_a_while()
        self.node.set_running(False)
        paused = self.node.get_scene()
        steps = paused.time / TIME_STEP
        self.assertAlmostEqual(round(steps), steps, delta=1e-6)
        travelled = math.acos(positions(paused)[0][0])
        self.assertAlmostEqual(
            abs(math.remainder(math.sqrt(2) * paused.time, 2 * math.pi)), travelled, delta=1e-9)
        with self.node.listen('status', Status) as statuses:
            statuses.several(2)
        self.assertEqual(exact(paused), exact(self.node.get_scene()))

    def test_no_step_while_running(self):
        self.node.add_particles([particle((1, 0, 0), (0, 1, 0))])
        self.run_a_while()
        with self.assertRaisesRegex(Refused, 'running'):
            self.node.step(steps=1)
        report = self.node.step(steps=0)
        self.assertGreater(report.time, 0.1)
        self.assertAlmostEqual(0.5, report.energies.kinetic, delta=1e-12)
        self.node.set_running(False)
        self.node.step(steps=1)

    def test_changes_are_taken_while_running(self):
        self.run_a_while()
        ids = self.node.add_particles([particle((1, 0, 0), (0, 0, 1))]).ids
        wait_until(lambda: positions(self.node.get_scene())[0][1] > 0.1)
        self.node.set_particles(ids, [particle((0, 0, 1))])
        np.testing.assert_array_equal([[0, 0, 1]], positions(self.node.get_scene()))
        self.node.remove_particles(ids)
        self.assertEqual([], self.node.get_scene().particles)
        self.node.reset()
        self.assertLess(self.node.get_scene().time, 60)
