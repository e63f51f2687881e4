"""Long calls: what else may be done meanwhile, and how they end early."""

import time

import numpy as np
from spherical_springs.msg import Status

from node_client import LONG, NodeProcess, NodeTest, Refused
from scenes import add_knot, angle_spring, angular_velocities, exact, particle, positions

SOON = 1  # [s]
FOREVER = 4294967295  # steps


class LongCallTest(NodeTest):
    """A knot, and a long ~relax or ~step under way on it."""

    def setUp(self):
        super().setUp()
        add_knot(self.node)
        self.saved = 'knot.json'
        self.node.save_scene(self.saved)

    def begin(self, service, state, **fields):
        before = self.node.get_scene()
        with self.node.listen('status', Status) as statuses:
            call = self.node.begin(service, **fields)
            self.addCleanup(call.result, LONG)
            self.addCleanup(self.node.cancel)
            statuses.first(lambda status: status.state == state)
        return before, call

    def begin_relaxing(self):
        return self.begin('relax', 'relaxing', method='dynamics', tolerance=1e-30)

    def begin_stepping(self):
        return self.begin('step', 'running', steps=FOREVER)

    def cancelled(self, call):
        """The response of a long call that is cancelled now."""
        begin = time.monotonic()
        self.node.cancel()
        response = call.result(LONG)
        self.assertLess(time.monotonic() - begin, SOON)
        self.assertIn('cancelled', response.message)
        self.assertEqual(0, np.abs(angular_velocities(self.node.get_scene())).max())
        self.assertEqual(0, self.node.step(0).energies.kinetic)
        return response


class TestRelaxing(LongCallTest):
    def test_cancelled(self):
        before, call = self.begin_relaxing()
        response = self.cancelled(call)
        self.assertFalse(response.converged)
        self.assertLess(response.energy_after, response.energy_before)
        self.assertAlmostEqual(response.energy_after, self.node.step(0).energies.potential,
                               delta=1e-9 * response.energy_before)
        self.assertEqual(before.time, self.node.get_scene().time)

    def test_reads_are_answered_and_changes_refused(self):
        before, call = self.begin_relaxing()
        self.assert_reads_and_refusals(before)
        self.cancelled(call)
        self.node.step(1)

    def assert_reads_and_refusals(self, before):
        scene = self.node.get_scene()
        self.assertEqual(before.particle_ids, scene.particle_ids)
        self.assertEqual(exact(before.angle_springs), exact(scene.angle_springs))
        self.assertGreater(self.node.step(0).energies.potential, 0)
        self.node.save_scene('meanwhile.json')
        particles, springs = scene.particles[:2], scene.angle_springs[:1]
        ids, spring_ids = scene.particle_ids[:2], scene.angle_spring_ids[:1]
        for service, fields in (
                ('add_particles', {'particles': particles}),
                ('set_particles', {'ids': ids, 'particles': particles}),
                ('remove_particles', {'ids': ids}),
                ('add_springs', {'angle_springs': springs}),
                ('set_springs', {'angle_spring_ids': spring_ids, 'angle_springs': springs}),
                ('remove_springs', {'angle_spring_ids': spring_ids}),
                ('load_scene', {'path': self.saved}), ('clear', {}), ('reset', {}),
                ('set_running', {'data': True}), ('set_running', {'data': False}),
                ('step', {'steps': 1}), ('relax', {})):
            with self.assertRaisesRegex(Refused, 'under way', msg=service):
                getattr(self.node, service)(**fields)
        scene = self.node.get_scene()
        self.assertEqual(before.particle_ids, scene.particle_ids)
        self.assertEqual(exact(before.angle_springs), exact(scene.angle_springs))
