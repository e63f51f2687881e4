"""Motion with known outcomes, through the node."""

import math

import numpy as np

from node_client import NodeTest
from scenes import (
    add_mixed_octant, add_octant, add_random_scene, angle, angle_spring, angular_velocities,
    energies, masses, particle, positions)

TIME_STEP = 1e-3


class TestClosedForms(NodeTest):
    def test_a_pair_on_one_arc_swings_harmonically(self):
        stiffness, mass, rest, amplitude, steps = 3, 2.5, 1.1, 0.4, 2000
        start = rest + amplitude
        places = (1, 0, 0), (math.cos(start), math.sin(start), 0)
        ids = self.node.add_particles([particle(p, mass=mass) for p in places]).ids
        self.node.add_springs(angle_springs=[angle_spring(ids, stiffness, rest_angle=rest)])
        frequency = math.sqrt(2 * stiffness / mass)
        # Strang's splitting swings at a slightly different frequency, and exactly so.
        discrete = 2 / TIME_STEP * math.asin(frequency * TIME_STEP / 2)
        for _ in range(5):
            time = self.node.step(steps=steps).time
            deviation = angle(*positions(self.node.get_scene())) - rest
            self.assertAlmostEqual(amplitude * math.cos(frequency * time), deviation, delta=1e-5)
            self.assertAlmostEqual(amplitude * math.cos(discrete * time), deviation, delta=1e-11)

    def test_a_damped_particle_slows_down_exponentially(self):
        damping, mass, speed = 0.7, 2, 3
        self.node.add_particles([particle((1, 0, 0), (0, 0, speed), mass=mass, damping=damping)])
        report = self.node.step(steps=1500)
        left = speed * math.exp(-damping / mass * 1.5)
        self.assertAlmostEqual(left, angular_velocities(self.node.get_scene())[0][2], delta=1e-12)
        self.assertAlmostEqual(mass * (speed ** 2 - left ** 2) / 2, report.energies.dissipated,
                               delta=1e-11)

    def test_a_damped_spring_slows_only_what_changes_its_length(self):
        # Both turn about one axis; what they have in common leaves the arc as it is.
        damping, mass = 0.7, 2
        ids = self.node.add_particles([
            particle((1, 0, 0), (0, 0, 1), mass=mass),
            particle((math.cos(1), math.sin(1), 0), (0, 0, 2), mass=mass)]).ids
        self.node.add_springs(angle_springs=[
            angle_spring(ids, 1e-30, rest_angle=1, damping=damping)])
        time = self.node.step(steps=500).time
        parting = math.exp(-2 * damping / mass * time)
        np.testing.assert_allclose(angular_velocities(self.node.get_scene())[:, 2],
                                   [1.5 - parting / 2, 1.5 + parting / 2], atol=1e-12)

    def test_the_octant(self):
        add_octant(self.node, damping=1)
        self.node.step(steps=100000)
        scene = self.node.get_scene()
        corners = positions(scene)
        for a, b in ((0, 1), (1, 2), (2, 0)):
            self.assertAlmostEqual(math.pi / 2, angle(corners[a], corners[b]), delta=1e-10)
        self.assertLess(np.abs(angular_velocities(scene)).max(), 1e-10)


class TestEnergies(NodeTest):
    def test_are_those_of_the_definitions(self):
        add_random_scene(self.node, seed=1, particles=30, springs=40)
        for _ in range(3):
            report = self.node.step(steps=100).energies
            expected = energies(self.node.get_scene())
            for kind, value in expected.items():
                self.assertGreater(value, 0.1)
                self.assertAlmostEqual(1, getattr(report, kind) / value, delta=1e-12, msg=kind)

    def test_nothing_is_lost_or_won(self):
        add_mixed_octant(self.node)
        begin = self.node.step(steps=0).energies
        for _ in range(10):
            now = self.node.step(steps=200).energies
            self.assertAlmostEqual(1, (now.total + now.dissipated) / begin.total, delta=3e-6)
        self.assertGreater(now.dissipated, 0.1 * begin.total)

    def test_springs_alone_turn_nothing(self):
        ids = add_octant(self.node, damping=0)
        self.node.set_particles(ids, [
            particle(p, v, mass=m) for p, v, m in (((1, 0, 0), (0, 1, 2), 1),
                                                   ((1, 1, 0), (1, -1, 3), 2),
                                                   ((1, 0, 1), (0, 2, 0), 3))])

        def momentum():
            scene = self.node.get_scene()
            return masses(scene) @ angular_velocities(scene)

        begin = momentum()
        self.node.step(steps=3000)
        np.testing.assert_allclose(momentum(), begin, atol=1e-11)
