import math
import re

import numpy as np

from node_client import NodeTest, Refused
from scenes import (
    add_knot, add_mixed_octant, add_octant, angle, angle_spring, angular_velocities, exact,
    particle, positions, solid_angle_spring)

METHODS = ('newton', 'dynamics', 'fire')


class TestOutcome(NodeTest):
    def test_a_method_that_is_none(self):
        for method, named in (('Newton', "'Newton'"), (100000 * 'x', "xxx...' (100000 bytes)")):
            with self.assertRaises(Refused) as refusal:
                self.node.relax(method=method)
            self.assertIn(named + '; allowed: newton', str(refusal.exception))
            self.assertLess(len(str(refusal.exception)), 300)

    def test_the_octant(self):
        for method in METHODS:
            self.node.clear()
            add_octant(self.node, damping=0.5)
            self.node.step(steps=100)
            time = self.node.get_scene().time
            outcome = self.node.relax(method=method, tolerance=1e-12)
            self.assertTrue(outcome.converged, outcome.message)
            self.assertLessEqual(outcome.max_torque, 1e-12)
            self.assertGreater(outcome.iterations, 0)
            self.assertGreater(outcome.energy_before, 0.5)
            self.assertLess(outcome.energy_after, 1e-20)
            scene = self.node.get_scene()
            self.assertEqual(time, scene.time)
            corners = positions(scene)
            for a, b in ((0, 1), (1, 2), (2, 0)):
                self.assertAlmostEqual(math.pi / 2, angle(corners[a], corners[b]), delta=1e-10)

    def test_particles_are_at_rest_afterwards(self):
        add_octant(self.node, damping=0.5)
        self.node.step(steps=100)
        self.node.relax()
        scene = self.node.get_scene()
        self.assertEqual(0, np.abs(angular_velocities(scene)).max())
        report = self.node.step(steps=0).energies
        self.assertEqual((0, 0), (report.kinetic, report.dissipated))
        self.node.step(steps=100)
        np.testing.assert_allclose(positions(self.node.get_scene()), positions(scene), atol=1e-8)

    def test_energies_before_and_after_are_those_of_the_scene(self):
        add_mixed_octant(self.node)
        before = self.node.step(steps=0).energies.potential
        outcome = self.node.relax()
        self.assertAlmostEqual(before, outcome.energy_before, delta=1e-12 * before)
        after = self.node.step(steps=0).energies.potential
        self.assertAlmostEqual(after, outcome.energy_after, delta=1e-12 * before)
        self.assertLess(after, 0.9 * before)

    def test_the_same_every_time(self):
        for method in METHODS:
            self.node.clear()
            add_knot(self.node, particles=30)
            places = []
            for _ in range(2):
                self.node.reset()
                self.node.relax(method=method)
                places.append(exact(self.node.get_scene().particles))
            self.assertEqual(*places)

    def test_newton_is_the_default(self):
        add_octant(self.node, damping=0)
        iterations = [self.relaxed_anew(method).iterations for method in ('', *METHODS)]
        self.assertEqual(iterations[0], iterations[1])
        self.assertLess(iterations[1], iterations[2])

    def relaxed_anew(self, method):
        self.node.reset()
        return self.node.relax(method=method)

    def test_the_default_tolerance_is_a_billionth_of_the_stiffness_that_a_particle_feels(self):
        a, b, c = self.node.add_particles([
            particle((1, 0, 0), pinned=True), particle((1, 1, 0)),
            particle((0, 1, 0), pinned=True)]).ids
        felt = 1 / 2  # by b; the stiff spring joins others
        self.node.add_springs(angle_springs=[angle_spring([a, c], 1e6, at_rest=True)])
        for torque in (2e-9 * felt, 0.5e-9 * felt):
            spring = self.node.add_springs(angle_springs=[
                angle_spring([a, b], 1, rest_angle=math.pi / 4 - torque)]).angle_spring_ids
            outcome = self.node.relax()
            self.assertTrue(outcome.converged)
            self.assertEqual(torque > 1e-9 * felt, outcome.iterations > 0)
            self.node.reset()
            self.node.remove_springs(spring, [], [])

    def test_nothing_to_do(self):
        self.assertTrue(self.node.relax().converged)
        self.node.add_particles([particle(p) for p in ((1, 0, 0), (0, 3, 4))])
        before = self.node.get_scene()
        self.assertTrue(self.node.relax().converged)
        self.assertEqual(exact(before), exact(self.node.get_scene()))


class TestEnd(NodeTest):
    def test_a_tolerance_that_rounding_cannot_reach(self):
        for method in METHODS:
            self.node.clear()
            add_knot(self.node, particles=30)
            outcome = self.node.relax(method=method, tolerance=1e-30)
            self.assertFalse(outcome.converged)
            self.assertGreater(outcome.max_torque, 1e-30)
            self.assertLess(outcome.max_torque, 1e-9)
            self.assertIn('rounding', outcome.message)
            named = [float(number) for number in re.findall(r'[\d.]+e-\d+', outcome.message)]
            self.assertTrue(any(abs(n / outcome.max_torque - 1) < 0.1 for n in named),
                            outcome.message)

    def test_max_time(self):
        add_knot(self.node)
        before = self.node.step(steps=0).energies.potential
        outcome = self.node.relax(method='dynamics', tolerance=1e-30, max_time=0.3)
        self.assertFalse(outcome.converged)
        self.assertIn('max_time', outcome.message)
        self.assertGreaterEqual(outcome.wall_time, 0.3)
        self.assertLess(outcome.energy_after, before)
        self.assertAlmostEqual(outcome.energy_after, self.node.step(steps=0).energies.potential,
                               delta=1e-9 * before)
        self.assertEqual(0, np.abs(angular_velocities(self.node.get_scene())).max())


    def test_no_triangle_folds_where_orientation_is_kept(self):
        corners = [particle(p, pinned=True) for p in ((1, -0.3, 0), (1, 0.3, 0), (1, 0, -0.3))]
        a, b, goal, c = self.node.add_particles([*corners, particle((1, 0.02, 0.3))]).ids
        self.node.add_springs(
            angle_springs=[angle_spring([c, goal], 1, rest_angle=0)],
            solid_angle_springs=[solid_angle_spring([a, b, c], 1e-3, rest_solid_angle=0.08)])
        outcome = self.node.relax(keep_orientation=True)
        self.assertFalse(outcome.converged)
        self.assertIn('would fold', outcome.message)
        self.assertGreater(positions(self.node.get_scene())[3][2], 0)
        self.assertTrue(self.node.relax().converged)
        self.assertLess(positions(self.node.get_scene())[3][2], 0)


class TestRefusals(NodeTest):
    def test_bad_requests(self):
        add_octant(self.node, damping=0.5)
        self.node.step(steps=50)
        before = self.node.get_scene()
        for fields, words in (({'method': 'magic'}, ('method', 'magic', 'allowed')),
                              ({'tolerance': -1}, ('tolerance', '-1', 'allowed')),
                              ({'tolerance': math.nan}, ('tolerance', 'nan', 'allowed')),
                              ({'max_time': -2}, ('max_time', '-2', 'allowed')),
                              ({'max_time': math.nan}, ('max_time', 'nan', 'allowed'))):
            with self.assertRaises(Refused, msg=fields) as refusal:
                self.node.relax(**fields)
            for word in words:
                self.assertIn(word, str(refusal.exception))
            self.assertEqual(exact(before), exact(self.node.get_scene()))
        self.node.step(steps=1)
