"""Directions found by their mutual angles: what a relaxation leaves open, and how sure it is."""

import math

import numpy as np

from node_client import NodeTest, Refused
from scenes import (
    add_mixed_octant, angle, angle_spring, ids_of, oriented_angle_spring, particle, positions)

SIGMA = math.radians(0.2)


def directions(generator, count):
    points = generator.normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


def misfit(found, truth):
    """The largest distance after the turn that brings both closest."""
    u, _, v = np.linalg.svd(found.T @ truth)
    turn = u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v
    return np.linalg.norm(found @ turn - truth, axis=1).max()


class TestCalibration(NodeTest):
    def add_rig(self, generator, oriented, count=8):
        """Angles of all pairs, with errors; from random places. Return the truth and the ids."""
        truth = directions(generator, count)
        starts = directions(generator, count)
        ids = self.node.add_particles(
            [particle(truth[0], pinned=True)] + [particle(p) for p in starts[1:]]).ids
        self.node.add_springs(angle_springs=[
            angle_spring([ids[a], ids[b]], 1 / SIGMA**2,
                         rest_angle=angle(truth[a], truth[b]) + SIGMA * generator.normal())
            for a in range(count) for b in range(a)])
        if oriented:
            sign = np.sign(np.linalg.det(truth[:3]))
            self.node.add_springs(oriented_angle_springs=[oriented_angle_spring(
                ids[:3], 1 / SIGMA**2, rest_angle=sign * angle(*truth[:2]), width=1e-3)])
        return truth, ids

    def test_the_right_arrangement_from_anywhere(self):
        for seed in range(5):
            for oriented in (False, True):
                self.node.clear()
                truth, _ = self.add_rig(np.random.default_rng(seed), oriented)
                outcome = self.node.relax(method='global', starts=4, seed=1)
                self.assertTrue(outcome.converged, outcome.message)
                self.assertIn(' of 4 starts ended there', outcome.message)
                self.assertEqual(1, outcome.free_rotations)
                self.assertEqual(not oriented, outcome.mirror_ambiguous)
                self.assertLess(outcome.rms_strain, 2 * SIGMA)
                found = positions(self.node.get_scene())
                misfits = [misfit(found, truth)]
                if not oriented:
                    misfits.append(misfit(found * (1, 1, -1), truth))
                self.assertLess(min(misfits), 0.05)

    def test_requests_that_do_not_fit_the_method(self):
        self.add_rig(np.random.default_rng(1), False)
        for fields, reason in (
                ({'starts': 3}, 'starts is 3; allowed: 0, '),
                ({'method': 'global', 'keep_orientation': True}, 'keep_orientation is true')):
            with self.assertRaises(Refused) as refusal:
                self.node.relax(**fields)
            self.assertIn(reason, str(refusal.exception))

    def test_strains(self):
        add_mixed_octant(self.node)
        self.node.remove_particles(self.node.add_particles([particle((1, 2, 3))]).ids)
        scene, strains = self.node.get_scene(), self.node.get_strains()
        self.assertEqual(ids_of(scene), ids_of(strains))
        points = dict(zip(scene.particle_ids, positions(scene)))
        spring = scene.angle_springs[0]
        condition = angle(*(points[i] for i in spring.particles)) - spring.rest_angle
        self.assertAlmostEqual(condition, strains.angle_conditions[0], delta=1e-14)
        energies = self.node.step(steps=0).energies
        for kind in ('angle', 'solid_angle', 'oriented_angle'):
            springs = getattr(scene, kind + '_springs')
            conditions = np.array(getattr(strains, kind + '_conditions'))
            of_each = np.array(getattr(strains, kind + '_energies'))
            np.testing.assert_allclose(
                of_each, [s.stiffness for s in springs] * conditions**2 / 2, rtol=1e-14)
            self.assertAlmostEqual(getattr(energies, kind), of_each.sum(), delta=1e-12)

    def test_strains_of_nothing(self):
        self.assertEqual((), tuple(self.node.get_strains().angle_energies))

    def test_covariance_in_the_axes_of_the_pose(self):
        # At +z, with right angles to +x and +y, the axes of the pose are those of the scene.
        ids = self.node.add_particles([
            particle((1, 0, 0), pinned=True), particle((0, 1, 0), pinned=True),
            particle((0, 0, 1))]).ids
        self.node.add_springs(angle_springs=[
            angle_spring([ids[0], ids[2]], 4, rest_angle=math.pi / 2),
            angle_spring([ids[1], ids[2]], 25, rest_angle=math.pi / 2)])
        found = self.node.get_covariance(ids=[ids[2], ids[0]]).covariances
        np.testing.assert_allclose(found, (1 / 4, 0, 0, 1 / 25, 0, 0, 0, 0), atol=1e-12)
        found = self.node.get_covariance().covariances
        np.testing.assert_allclose(found[8:], (1 / 4, 0, 0, 1 / 25), atol=1e-12)

    def test_covariance_that_cannot_be_told(self):
        _, ids = self.add_rig(np.random.default_rng(1), False)
        for asked, reason in ((ids, 'not at a minimum'), ([4000], 'ids[0] is 4000; allowed: ')):
            with self.assertRaises(Refused) as refusal:
                self.node.get_covariance(ids=asked)
            self.assertIn(reason, str(refusal.exception))
        self.node.relax(method='global')
        self.assertEqual(4 * len(ids), len(self.node.get_covariance(ids=ids).covariances))
