import numpy as np
from geometry_msgs.msg import Point, Vector3
from spherical_springs.msg import Particle

from node_client import NodeProcess, NodeTest, Refused
from scenes import (
    add_octant, angle_spring, angular_velocities, exact, ids_of, oriented_angle_spring, particle,
    positions, solid_angle_spring)


class TestIds(NodeTest):
    def test_begin_at_0_and_are_never_given_again(self):
        with NodeProcess(running='false') as process:
            node = process.client()

            def add(count):
                return list(node.add_particles([particle((1, 2, 3))] * count).ids)

            self.assertEqual([0, 1, 2], add(3))
            node.remove_particles([2, 0])
            self.assertEqual([3], add(1))
            self.assertEqual([1, 3], list(node.get_scene().particle_ids))
            node.clear()
            self.assertEqual([4, 5], add(2))


class TestAdding(NodeTest):
    def added(self, *args, **fields):
        ids = self.node.add_particles([particle(*args, **fields)]).ids
        scene = self.node.get_scene()
        self.assertEqual(ids[-1], scene.particle_ids[-1])
        return scene.particles[-1]

    def test_a_position_of_any_length_is_a_direction(self):
        direction = np.array([3, -4, 12]) / 13
        for length in (1e-300, 1e-9, 1, 13, 1e300):
            place = self.added(direction * length).position
            np.testing.assert_allclose([place.x, place.y, place.z], direction, rtol=3e-16)
        self.assertEqual((0, 0, -1), tuple(positions_of(self.added((0, 0, -5e-324)))))

    def test_the_part_of_the_velocity_along_the_position_is_dropped(self):
        velocity = self.added((0, 0, -7), (1, 2, 3)).angular_velocity
        self.assertEqual((1, 2, 0), (velocity.x, velocity.y, velocity.z))

    def test_mass_0_means_1(self):
        self.assertEqual(1, self.added((1, 1, 1)).mass)
        self.assertEqual(1e-3, self.added((1, 1, 1), mass=1e-3).mass)

    def test_every_field_is_kept(self):
        given = particle((0, 1, 0), (0.1, 0, 0.7), mass=2.5, damping=0.3)
        self.node.add_particles([given])
        self.assertEqual(exact(given), exact(self.node.get_scene().particles[0]))
        self.assertFalse(self.added((1, 0, 0)).pinned)
        self.assertTrue(self.added((1, 0, 0), pinned=True).pinned)

    def test_what_is_there_stays_where_it_has_come_to(self):
        self.node.add_particles([particle((1, 0, 0), (0, 1, 2))])
        self.node.step(steps=100)
        before = self.node.get_scene()
        self.node.add_particles([particle((0, 1, 0))])
        after = self.node.get_scene()
        self.assertEqual(exact(before.particles[0]), exact(after.particles[0]))
        self.assertEqual(before.time, after.time)

    def test_a_pinned_particle_never_moves(self):
        pinned, free = self.node.add_particles(
            [particle((1, 0, 0), (0, 5, 5), pinned=True), particle((0, 1, 0))]).ids
        self.node.add_springs(angle_springs=[angle_spring([pinned, free])])
        before = positions(self.node.get_scene())
        self.node.step(steps=1000)
        after = positions(self.node.get_scene())
        self.assertEqual(tuple(before[0]), tuple(after[0]))
        self.assertGreater(np.linalg.norm(after[1] - before[1]), 0.1)
        self.node.relax()
        self.assertEqual(tuple(before[0]), tuple(positions(self.node.get_scene())[0]))


class TestSetting(NodeTest):
    def test_sets_those_and_no_others(self):
        ids = add_octant(self.node, damping=0)
        self.node.step(steps=100)
        before = self.node.get_scene()
        given = [particle((0, 0, 1), (3, 0, 0), mass=4, damping=5),
                 particle((0, 1, 0), (0, 0, 6), mass=7, pinned=False)]
        self.node.set_particles([ids[2], ids[0]], given)
        after = self.node.get_scene()
        self.assertEqual([exact(p) for p in (given[1], before.particles[1], given[0])],
                         [exact(p) for p in after.particles])
        self.assertEqual(exact(before.angle_springs), exact(after.angle_springs))
        self.assertEqual(before.time, after.time)

    def test_a_new_mass_counts(self):
        ids = self.node.add_particles([particle((1, 0, 0)), particle((0, 1, 0), pinned=True)]).ids
        self.node.add_springs(angle_springs=[angle_spring(ids)])
        self.node.set_particles(ids[:1], [particle((1, 0, 0), mass=4)])
        self.node.step(steps=1)
        speed = np.linalg.norm(angular_velocities(self.node.get_scene())[0])
        self.assertAlmostEqual(1e-3 * np.pi / 2 / 4, speed, delta=1e-12)


class TestSettingSomeFields(NodeTest):
    def setUp(self):
        super().setUp()
        self.ids = self.node.add_particles([
            particle((1, 0, 0), (0, 0, 3), mass=4, damping=5),
            particle((0, 1, 0), mass=6, pinned=True)]).ids
        self.node.step(steps=100)
        self.before = self.node.get_scene().particles

    def set_fields(self, fields, **values):
        self.node.set_particles(self.ids, [Particle(**values)] * 2, fields)
        return self.node.get_scene().particles

    def test_a_place_keeps_all_else(self):
        for before, after in zip(self.before,
                                 self.set_fields(['position'], position=Point(0, 0, 2))):
            self.assertEqual((0, 0, 1), positions_of(after))
            self.assertEqual((before.mass, before.damping, before.pinned),
                             (after.mass, after.damping, after.pinned))

    def test_each_field_alone_keeps_the_others_to_the_last_bit(self):
        for field, value in (('mass', 9), ('damping', 0.5), ('pinned', True)):
            expected = self.node.get_scene().particles
            for one in expected:
                setattr(one, field, value)
            expected[-1].angular_velocity = Vector3()
            if field == 'pinned':
                expected[0].angular_velocity = Vector3()
            self.assertEqual(exact(expected), exact(self.set_fields([field], **{field: value})))

    def test_several_fields(self):
        after = self.set_fields(['mass', 'angular_velocity'], mass=2,
                                angular_velocity=Vector3(0, 0, 1))
        self.assertEqual([2, 2], [one.mass for one in after])
        self.assertAlmostEqual(1, after[0].angular_velocity.z, delta=1e-15)
        self.assertEqual(5, after[0].damping)

    def test_an_unknown_name_is_refused(self):
        before = exact(self.node.get_scene())
        for names, words in ((['postion'], r"fields\[0\] is 'postion'; allowed for particles: "
                                           'position, angular_velocity, mass, damping, pinned'),
                             (['mass', ''], r"fields\[1\] is ''; allowed"),
                             (['stiffness'], 'allowed')):
            with self.assertRaisesRegex(Refused, words):
                self.set_fields(names)
            self.assertEqual(before, exact(self.node.get_scene()))

    def test_values_that_are_not_chosen_are_not_looked_at(self):
        self.set_fields(['mass'], mass=1, damping=-1, position=Point(0, 0, 0))
        with self.assertRaisesRegex(Refused, 'mass'):
            self.set_fields(['mass'], mass=-1)


class TestRemoving(NodeTest):
    def test_springs_go_too(self):
        a, b, c, d = self.node.add_particles(
            [particle(p) for p in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 1, 1))]).ids
        ids = ids_of(self.node.add_springs(
            angle_springs=[angle_spring([a, b]), angle_spring([b, c]), angle_spring([c, d])],
            solid_angle_springs=[solid_angle_spring([a, b, c]), solid_angle_spring([b, c, d])],
            oriented_angle_springs=[oriented_angle_spring([c, d, a]),
                                    oriented_angle_spring([b, c, d])]))
        before = self.node.get_scene()
        self.assertEqual(3, self.node.remove_particles([a]).springs_removed)
        after = self.node.get_scene()
        self.assertEqual([b, c, d], list(after.particle_ids))
        self.assertEqual(exact(before.particles[1:]), exact(after.particles))
        self.assertEqual({'angle_springs': ids['angle_springs'][1:],
                          'solid_angle_springs': ids['solid_angle_springs'][1:],
                          'oriented_angle_springs': ids['oriented_angle_springs'][1:]},
                         ids_of(after))
        self.assertEqual(4, self.node.remove_particles([d, b]).springs_removed)
        self.assertEqual([c], list(self.node.get_scene().particle_ids))

    def test_others_go_on_where_they_are(self):
        ids = self.node.add_particles(
            [particle((1, 0, 0)), particle((0, 1, 0), (2, 0, 1)), particle((0, 0, 1))]).ids
        self.node.step(steps=100)
        before = self.node.get_scene().particles[1]
        self.node.remove_particles(ids[:1])
        self.assertEqual(exact(before), exact(self.node.get_scene().particles[0]))


def positions_of(message):
    return message.position.x, message.position.y, message.position.z
