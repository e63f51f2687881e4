"""Long calls: what may be done meanwhile, and how they end early."""

import os
import tempfile
import time
import unittest
from concurrent import futures

import numpy as np
from spherical_springs.msg import Energies, Status

from node_client import LONG, NodeProcess, NodeTest, Refused, wait_until
from scenes import add_knot, angular_velocities, exact, positions

SOON = 10  # [s], on a busy machine; the calls that are cancelled last far longer
RELAXING_FOR_EVER = {'service': 'relax', 'method': 'dynamics', 'tolerance': 1e-30}
STEPPING_FOR_EVER = {'service': 'step', 'steps': 4294967295}
STATES = {'relax': 'relaxing', 'step': 'running'}


def begin(node, service, **fields):
    """Begin a long call; return it when it is under way."""
    with node.listen('status', Status) as statuses:
        call = node.begin(service, **fields)
        statuses.first(lambda status: status.state == STATES[service])
    return call


class TestLongCalls(NodeTest):
    def setUp(self):
        super().setUp()
        self.make_scene_directory()
        add_knot(self.node)
        self.node.save_scene('knot.json')
        self.before = self.node.get_scene()

    def begin(self, call):
        future = begin(self.node, **call)
        self.addCleanup(future.result, LONG)
        self.addCleanup(self.node.cancel)
        return future

    def cancelled(self, call):
        """The response of a long call that is cancelled now, and leaves the scene at rest."""
        start = time.monotonic()
        self.node.cancel()
        response = call.result(LONG)
        self.assertLess(time.monotonic() - start, SOON)
        self.assertIn('cancelled', response.message)
        self.assertEqual(0, np.abs(angular_velocities(self.node.get_scene())).max())
        self.assertEqual(0, self.node.step(steps=0).energies.kinetic)
        return response

    def test_a_cancelled_relaxation(self):
        response = self.cancelled(self.begin(RELAXING_FOR_EVER))
        self.assertFalse(response.converged)
        self.assertLess(response.energy_after, response.energy_before)
        self.assertAlmostEqual(response.energy_after, self.node.step(steps=0).energies.potential,
                               delta=1e-9 * response.energy_before)
        self.assertEqual(self.before.time, self.node.get_scene().time)

    def test_cancelled_steps(self):
        response = self.cancelled(self.begin(STEPPING_FOR_EVER))
        steps = round(response.time * 1000)
        self.assertIn(str(steps), response.message)
        self.assertEqual(response.time, self.node.get_scene().time)
        with self.node.listen('status', Status) as statuses:
            statuses.first(lambda status: status.steps == steps and status.state == 'paused')

    def test_what_may_be_done_meanwhile(self):
        for long_call in (RELAXING_FOR_EVER, STEPPING_FOR_EVER):
            call = self.begin(long_call)
            self.assert_reads_are_answered()
            self.assert_changes_are_refused('~' + long_call['service'])
            self.cancelled(call)
            self.assert_same_scene_but_for_places()
            self.node.step(steps=1)

    def assert_same_scene_but_for_places(self):
        scene = self.node.get_scene()
        self.assertEqual(self.before.particle_ids, scene.particle_ids)
        self.assertEqual(self.before.angle_spring_ids, scene.angle_spring_ids)
        self.assertEqual(self.before.angle_springs, scene.angle_springs)

    def assert_reads_are_answered(self):
        self.assert_same_scene_but_for_places()
        self.assertGreater(self.node.step(steps=0).energies.potential, 0)
        self.node.save_scene('meanwhile.json')

    def assert_changes_are_refused(self, reason):
        ids, particles = self.before.particle_ids[:2], self.before.particles[:2]
        spring_ids, springs = self.before.angle_spring_ids[:1], self.before.angle_springs[:1]
        for service, fields in (
                ('add_particles', {'particles': particles}),
                ('set_particles', {'ids': ids, 'particles': particles}),
                ('remove_particles', {'ids': ids}),
                ('add_springs', {'angle_springs': springs}),
                ('set_springs', {'angle_spring_ids': spring_ids, 'angle_springs': springs}),
                ('remove_springs', {'angle_spring_ids': spring_ids}),
                ('load_scene', {'path': 'knot.json'}), ('clear', {}), ('reset', {}),
                ('set_running', {'data': True}), ('set_running', {'data': False}),
                ('step', {'steps': 1}), ('relax', {})):
            with self.assertRaisesRegex(Refused, reason + ' is under way', msg=service):
                getattr(self.node, service)(**fields)

    def test_progress_is_seen(self):
        self.begin(RELAXING_FOR_EVER)
        with self.node.listen('status', Status) as statuses:
            statuses.first(lambda status: 0 < status.relax_progress <= 1)
        self.assertGreater(
            np.abs(positions(self.node.get_scene()) - positions(self.before)).max(), 1e-3)

    def test_the_node_ends_when_told_to(self):
        for long_call in (RELAXING_FOR_EVER, STEPPING_FOR_EVER):
            with NodeProcess(running='false') as process:
                node = process.client()
                add_knot(node)
                call = begin(node, **long_call)
                self.assertEqual(0, process.stop(), process.output())
                self.assertTrue(futures.wait([call], LONG).done)


class TestNothingUnderWay(NodeTest):
    def test_cancelling_changes_nothing(self):
        add_knot(self.node, particles=10)
        self.node.step(steps=10)
        before = self.node.get_scene()
        self.assertIn('nothing', self.node.cancel().message)
        self.assertEqual(exact(before), exact(self.node.get_scene()))
        self.assertAlmostEqual(before.time + 5e-3, self.node.step(steps=5).time, delta=1e-12)
        self.assertTrue(self.node.relax().converged)


class TestBesideManyLongCalls(unittest.TestCase):
    """As many as the node answers at once."""

    CALLS = 8

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.path = os.path.join(directory.name, 'slow.json')
        with open(self.path, 'w') as file:
            file.write('{"format": "spherical_springs scene 1", "particles": [%s]}' % ','.join(
                ['{"position": [1.%s, 2, 3]}' % ('0' * 1000)] * 40000))
        self.process = NodeProcess(scene_directory=directory.name, publish_rate=100)
        self.addCleanup(self.process.__exit__)
        self.node = self.process.client()
        self.loads = []

    def all_are_under_way(self):
        """Begin loads for those that are over, as the first may end before the last begins."""
        self.loads = [load for load in self.loads if not load.done()]
        while len(self.loads) < self.CALLS:
            self.loads.append(self.node.begin('load_scene', path='slow.json'))
        return self.files_being_read() == self.CALLS

    def files_being_read(self):
        directory = '/proc/%d/fd' % self.process.pid
        links = (os.path.join(directory, name) for name in os.listdir(directory))
        return sum(os.path.islink(link) and os.readlink(link) == self.path for link in links)

    def test_cancels_are_answered_and_time_goes_on(self):
        with self.node.listen('energies', Energies) as samples:
            samples.first()
            wait_until(self.all_are_under_way)
            self.node.cancel()
            self.node.set_running(False)
            self.node.set_running(True)
            stopped = samples.all()[-1].time
            samples.first(lambda sample: sample.time > stopped)
            self.assertFalse(all(load.done() for load in self.loads))
            for load in self.loads:
                load.result()
