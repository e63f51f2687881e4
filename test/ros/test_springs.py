import math

from node_client import NodeProcess, NodeTest, Refused
from scenes import (
    KINDS, OCTANT_CORNERS, angle_spring, exact, ids_of, oriented_angle_spring, particle, same_ids,
    solid_angle_spring, springs_of)


def one_of_each(a, b, c, **fields):
    return {'angle_springs': [angle_spring([a, b], **fields)],
            'solid_angle_springs': [solid_angle_spring([a, b, c], **fields)],
            'oriented_angle_springs': [oriented_angle_spring([a, b, c], **fields)]}


class TestIds(NodeTest):
    def test_each_kind_has_its_own_and_none_is_given_again(self):
        with NodeProcess(running='false') as process:
            node = process.client()
            a, b, c = node.add_particles([particle(p) for p in OCTANT_CORNERS]).ids
            angle = [angle_spring([a, b])]
            solid = [solid_angle_spring([a, b, c])]
            oriented = [oriented_angle_spring([a, b, c])]

            def add(*springs):
                return list(ids_of(node.add_springs(*springs)).values())

            self.assertEqual([[0, 1], [0], [0, 1, 2]], add(2 * angle, solid, 3 * oriented))
            node.remove_springs([1], [0], [0])
            self.assertEqual([[2], [1, 2], []], add(angle, 2 * solid, []))
            self.assertEqual([[0, 2], [1, 2], [1, 2]], list(ids_of(node.get_scene()).values()))
            node.clear()
            a, b, c = node.add_particles([particle(p) for p in OCTANT_CORNERS]).ids
            self.assertEqual([[3], [3], [3]], add(*one_of_each(a, b, c).values()))


class SpringTest(NodeTest):
    def setUp(self):
        super().setUp()
        self.corners = self.node.add_particles([particle(p) for p in OCTANT_CORNERS]).ids


class TestAdding(SpringTest):
    def test_every_field_is_kept(self):
        a, b, c = self.corners
        given = {
            'angle_springs': [
                angle_spring([b, a], 2, rest_angle=0.1, damping=0.2), angle_spring([a, c], 3),
                angle_spring([c, b], 1e-30, rest_angle=math.pi, damping=1e30)],
            'solid_angle_springs': [
                solid_angle_spring([c, a, b], 5, rest_solid_angle=-1.5, damping=0.6),
                solid_angle_spring([c, b, a], 1e30, rest_solid_angle=2 * math.pi)],
            'oriented_angle_springs': [
                oriented_angle_spring([c, b, a], 7, rest_angle=-math.pi, damping=0.8, width=0.9),
                oriented_angle_spring([a, b, c], 8, rest_angle=1)]}
        ids = ids_of(self.node.add_springs(**given))
        scene = self.node.get_scene()
        self.assertEqual(ids, ids_of(scene))
        self.assertEqual(exact(given), exact(springs_of(scene)))


class TestAtRest(SpringTest):
    def added(self, *corners):
        """One of each kind, at rest, as they stand in the scene."""
        springs = one_of_each(*corners, at_rest=True)
        springs['angle_springs'][0].rest_angle = 99
        springs['solid_angle_springs'][0].rest_solid_angle = float('nan')
        springs['oriented_angle_springs'][0].rest_angle = -99
        self.node.add_springs(**springs)
        scene = springs_of(self.node.get_scene())
        return [scene[kind][-1] for kind in KINDS]

    def test_the_present_value_is_taken(self):
        a, b, c = self.corners
        angle, solid, oriented = self.added(a, b, c)
        self.assertAlmostEqual(math.pi / 2, angle.rest_angle, delta=1e-15)
        self.assertAlmostEqual(math.pi / 2, solid.rest_solid_angle, delta=1e-15)
        self.assertAlmostEqual(math.pi / 2, oriented.rest_angle, delta=1e-15)
        self.assertEqual([False] * 3, [s.at_rest for s in (angle, solid, oriented)])

    def test_the_present_value_has_the_sign_of_the_orientation(self):
        a, b, c = self.corners
        angle, solid, oriented = self.added(b, a, c)
        self.assertAlmostEqual(math.pi / 2, angle.rest_angle, delta=1e-15)
        self.assertAlmostEqual(-math.pi / 2, solid.rest_solid_angle, delta=1e-15)
        self.assertAlmostEqual(-math.pi / 2, oriented.rest_angle, delta=1e-15)

    def test_the_present_value_is_that_after_stepping(self):
        self.node.set_particles(self.corners[:1], [particle((1, 0, 0), (0, -1, 0.5))])
        self.node.step(steps=700)
        self.added(*self.corners)
        self.assertLess(self.node.step(steps=0).energies.potential, 1e-30)

    def test_set_springs_takes_it_too(self):
        a, b, c = self.corners
        ids = ids_of(self.node.add_springs(**one_of_each(a, b, c)))
        self.assertGreater(self.node.step(steps=0).energies.potential, 1)
        self.node.set_springs(**same_ids(ids), **one_of_each(a, b, c, at_rest=True))
        self.assertLess(self.node.step(steps=0).energies.potential, 1e-30)


class TestSetting(SpringTest):
    def test_sets_those_and_no_others(self):
        a, b, c = self.corners
        springs = {kind: 3 * list for kind, list in one_of_each(a, b, c).items()}
        ids = ids_of(self.node.add_springs(**springs))
        others = one_of_each(c, a, b, stiffness=9, damping=8)
        chosen = {kind: [ids[kind][which]] for which, kind in enumerate(KINDS)}
        self.node.set_springs(**same_ids(chosen), **others)
        for which, kind in enumerate(KINDS):
            springs[kind][which] = others[kind][0]
        scene = self.node.get_scene()
        self.assertEqual(ids, ids_of(scene))
        self.assertEqual(exact(springs), exact(springs_of(scene)))

    def test_some_fields_keep_the_others(self):
        a, b, c = self.corners
        ids = same_ids(ids_of(self.node.add_springs(**one_of_each(a, b, c, damping=0.5))))
        for fields, values in ((['stiffness'], {'stiffness': 7}), (['damping'], {'damping': 3}),
                               (['particles'], {}), (['at_rest'], {'at_rest': True})):
            before = springs_of(self.node.get_scene())
            self.node.set_springs(fields=fields, **ids, **one_of_each(b, c, a, **values))
            after = springs_of(self.node.get_scene())
            for kind in KINDS:
                expected = before[kind][0]
                if fields == ['particles']:
                    expected.particles = one_of_each(b, c, a)[kind][0].particles
                elif fields == ['at_rest']:
                    rest = 'rest_solid_angle' if kind == KINDS[1] else 'rest_angle'
                    setattr(expected, rest, getattr(after[kind][0], rest))
                    if kind == KINDS[2]:  # a width of 0 is one that the rest angle gives
                        expected.width = after[kind][0].width
                else:
                    setattr(expected, *next(iter(values.items())))
                self.assertEqual(exact(expected), exact(after[kind][0]))
        self.assertLess(self.node.step(steps=0).energies.potential, 1e-30)

    def test_fields_that_are_none_of_a_kind(self):
        a, b, c = self.corners
        ids = same_ids(ids_of(self.node.add_springs(**one_of_each(a, b, c))))
        for fields in (['rest_angle'], ['stifness'], ['particles', 'mass']):
            with self.assertRaisesRegex(Refused, r'fields\[.\] is .*; allowed for .*: particles'):
                self.node.set_springs(fields=fields, **ids, **one_of_each(a, b, c))
        with self.assertRaisesRegex(Refused, "fields.*'stifness'; allowed for springs"):
            self.node.set_springs(fields=['stifness'])


class TestRemoving(SpringTest):
    def test_removes_those_and_no_others(self):
        a, b, c = self.corners
        ids = ids_of(self.node.add_springs(
            **{kind: 3 * list for kind, list in one_of_each(a, b, c).items()}))
        self.node.remove_springs([ids['angle_springs'][2], ids['angle_springs'][0]], [],
                                 [ids['oriented_angle_springs'][1]])
        del ids['angle_springs'][2], ids['angle_springs'][0], ids['oriented_angle_springs'][1]
        self.assertEqual(ids, ids_of(self.node.get_scene()))

    def test_what_is_removed_pulls_no_more(self):
        ids = self.node.add_springs(angle_springs=[angle_spring(self.corners[:2])])
        self.node.remove_springs(angle_spring_ids=ids.angle_spring_ids)
        before = self.node.get_scene()
        after_energies = self.node.step(steps=10).energies
        self.assertEqual(0, after_energies.total)
        self.assertEqual(exact(before.particles), exact(self.node.get_scene().particles))
