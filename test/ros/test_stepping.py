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
            response = self.node.step(steps)
            self.assertAlmostEqual(total * TIME_STEP, response.time, delta=1e-12)
            x, y, _ = positions(self.node.get_scene())[0]
            self.assertAlmostEqual(total * TIME_STEP * speed, math.atan2(y, x), delta=1e-12)
        with self.node.listen('status', Status) as statuses:
            statuses.first(lambda status: status.steps == 1000)

    def test_many_at_once_are_as_many_one_by_one(self):
        add_random_scene(self.node, seed=1)
        for _ in range(60):
            self.node.step(1)
        one_by_one = self.node.get_scene()
        self.node.reset()
        self.node.step(60)
        self.assertEqual(exact(one_by_one), exact(self.node.get_scene()))

    def test_none_only_reports(self):
        add_random_scene(self.node, seed=2)
        last = self.node.step(7)
        before = self.node.get_scene()
        report = self.node.step(0)
        self.assertEqual(exact(before), exact(self.node.get_scene()))
        self.assertEqual(last.time, report.time)
        last.energies.header.stamp = report.energies.header.stamp
        self.assertEqual(exact(last.energies), exact(report.energies))

    def test_reports_the_energies_of_where_it_has_come_to(self):
        add_random_scene(self.node, seed=3)
        for _ in range(3):
            response = self.node.step(20)
            self.assertEqual(response.time, response.energies.time)
            self.assertEqual(response.time, self.node.get_scene().time)
            self.assertGreaterEqual(response.wall_time, 0)
        with self.node.listen('energies', Energies) as samples:
            sample = samples.first(lambda sample: sample.time == response.time)
        self.assertEqual(response.energies.header.frame_id, sample.header.frame_id)
        sample.header = response.energies.header
        self.assertEqual(exact(response.energies), exact(sample))

    def test_an_empty_scene_has_time_too(self):
        self.assertAlmostEqual(5 * TIME_STEP, self.node.step(5).time, delta=1e-12)


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
            self.node.step(1)
        report = self.node.step(0)
        self.assertGreater(report.time, 0.1)
        self.assertAlmostEqual(0.5, report.energies.kinetic, delta=1e-12)
        self.node.set_running(False)
        self.node.step(1)

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
