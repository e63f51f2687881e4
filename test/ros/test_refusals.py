"""Every changing service takes a request whole or not at all, and says what is wrong with it."""

import math

from node_client import NodeTest, Refused
from scenes import (
    KINDS, OCTANT_CORNERS, angle_spring, exact, ids_of, oriented_angle_spring, particle, same_ids,
    solid_angle_spring, springs_of)

NAN, INF = math.nan, math.inf
NO_ID = 4294967295
PLACE = (1, 2, 3)

# Wrong values: arguments of particle(), the field, its value as the message writes it.
BAD_PARTICLES = [
    ([(0, 0, 0)], {}, 'position', '(0, 0, 0)'),
    ([(NAN, 0, 1)], {}, 'position', '(nan, 0, 1)'),
    ([(1, NAN, 0)], {}, 'position', '(1, nan, 0)'),
    ([(0, 1, NAN)], {}, 'position', '(0, 1, nan)'),
    ([(INF, 0, 1)], {}, 'position', '(inf, 0, 1)'),
    ([(1, -INF, 0)], {}, 'position', '(1, -inf, 0)'),
    ([PLACE, (NAN, 0, 1)], {}, 'angular_velocity', '(nan, 0, 1)'),
    ([PLACE, (1, NAN, 0)], {}, 'angular_velocity', '(1, nan, 0)'),
    ([PLACE, (0, 1, NAN)], {}, 'angular_velocity', '(0, 1, nan)'),
    ([PLACE, (0, INF, 0)], {}, 'angular_velocity', '(0, inf, 0)'),
    ([PLACE, (0, 0, -INF)], {}, 'angular_velocity', '(0, 0, -inf)'),
    ([PLACE], {'mass': -1}, 'mass', '-1'),
    ([PLACE], {'mass': NAN}, 'mass', 'nan'),
    ([PLACE], {'mass': INF}, 'mass', 'inf'),
    ([PLACE], {'damping': -1e-3}, 'damping', '-0.001'),
    ([PLACE], {'damping': NAN}, 'damping', 'nan'),
    ([PLACE], {'damping': INF}, 'damping', 'inf'),
]

BAD_COMMON_VALUES = [('stiffness', v) for v in (0, -1, NAN, INF)] + [
    ('damping', v) for v in (-1, NAN, INF)]
BAD_VALUES = {
    'angle_springs': BAD_COMMON_VALUES + [
        ('rest_angle', v) for v in (-0.1, 3.2, NAN, INF)],
    'solid_angle_springs': BAD_COMMON_VALUES + [
        ('rest_solid_angle', v)
        for v in (-7, -2 * math.pi, 2 * math.pi + 1e-4, NAN, INF, -INF)],
    'oriented_angle_springs': BAD_COMMON_VALUES + [
        ('rest_angle', v) for v in (-3.2, 3.2, NAN, -INF)] + [
        ('width', v) for v in (-0.1, 1.5, NAN, INF)],
}
BUILDERS = dict(zip(KINDS, (angle_spring, solid_angle_spring, oriented_angle_spring)))
ENDS = dict(zip(KINDS, (2, 3, 3)))


def text(value):
    return '%.16g' % value


class RefusalTest(NodeTest):
    def setUp(self):
        super().setUp()
        corners = [particle(p, (1, 2, 3), damping=0.1) for p in OCTANT_CORNERS]
        self.ids = list(self.node.add_particles(corners).ids)
        self.spring_ids = ids_of(self.node.add_springs(**self.good_springs(5)))
        self.node.step(steps=10)

    def good_springs(self, count):
        return {kind: [build(self.ids[:ENDS[kind]]) for _ in range(count)]
                for kind, build in BUILDERS.items()}

    def fault(self, words, service, **fields):
        """What is amiss with the refusal of a call; None where it is as it should be."""
        before = self.node.get_scene()
        try:
            getattr(self.node, service)(**fields)
        except Refused as refusal:
            message = str(refusal)
        else:
            return '%s took %s' % (service, words)
        if exact(before) != exact(self.node.get_scene()):
            return '%s refused %s and changed the scene' % (service, words)
        missing = [word for word in words if word not in message]
        return '%s: no %s in "%s"' % (service, missing, message) if missing else None

    def assert_no_faults(self, faults):
        self.assertEqual([], [fault for fault in faults if fault])

    def assert_refused(self, words, service, **fields):
        self.assert_no_faults([self.fault(words, service, **fields)])


class TestParticles(RefusalTest):
    def test_bad_values(self):
        faults = []
        for arguments, fields, field, value in BAD_PARTICLES:
            particles = [particle((0, 1, 0)) for _ in self.ids]
            particles[1] = particle(*arguments, **fields)
            words = ['particles[1].' + field, value, 'allowed']
            faults += [
                self.fault(words, 'add_particles', particles=particles),
                self.fault(words, 'set_particles', ids=self.ids, particles=particles)]
        self.assert_no_faults(faults)

    def test_the_first_at_fault_is_named_however_many_follow(self):
        particles = [particle(PLACE) for _ in range(1000)]
        particles[500].mass = -5
        particles[700].mass = -7
        self.assert_refused(['particles[500].mass', '-5', 'allowed'], 'add_particles',
                            particles=particles)

    def test_ids_that_are_refused_are_given_later(self):
        with self.assertRaises(Refused):
            self.node.add_particles([particle(PLACE), particle((0, 0, 0))])
        self.assertEqual([self.ids[-1] + 1], list(self.node.add_particles([particle(PLACE)]).ids))

    def test_bad_ids(self):
        a, b, c = self.ids
        given = [particle(PLACE) for _ in self.ids]
        self.assert_no_faults([
            self.fault(['ids[1]', str(NO_ID), 'allowed'],
                       'set_particles', ids=[a, NO_ID, c], particles=given),
            self.fault(['ids[2]', str(a), 'allowed'],
                       'set_particles', ids=[a, b, a], particles=given),
            self.fault(['ids', '2', 'particles', '3', 'allowed'],
                       'set_particles', ids=[a, b], particles=given),
            self.fault(['ids[1]', str(NO_ID), 'allowed'], 'remove_particles', ids=[a, NO_ID]),
            self.fault(['ids[2]', str(b), 'allowed'], 'remove_particles', ids=[b, c, b])])

    def test_an_id_that_is_no_more(self):
        self.node.remove_particles(self.ids[:1])
        self.assert_refused(['ids[0]', str(self.ids[0]), 'allowed'],
                            'remove_particles', ids=self.ids[:1])


class TestSprings(RefusalTest):
    def faults_of_spring(self, words, kind, spring):
        """Of adding and setting five good springs of each kind, but for one."""
        springs = self.good_springs(5)
        springs[kind][3] = spring
        return [self.fault(words, 'add_springs', **springs),
                self.fault(words, 'set_springs', **same_ids(self.spring_ids), **springs)]

    def test_bad_values(self):
        faults = []
        for kind in KINDS:
            for field, value in BAD_VALUES[kind]:
                spring = self.good_springs(1)[kind][0]
                setattr(spring, field, value)
                words = ['%s[3].%s' % (kind, field), text(value), 'allowed']
                faults += self.faults_of_spring(words, kind, spring)
        self.assert_no_faults(faults)

    def test_bad_particles(self):
        faults = []
        for kind, build in BUILDERS.items():
            last = ENDS[kind] - 1
            for wrong in (NO_ID, self.ids[0]):
                ends = self.ids[:last] + [wrong]
                words = ['%s[3].particles[%d]' % (kind, last), str(wrong), 'allowed']
                faults += self.faults_of_spring(words, kind, build(ends))
        self.assert_no_faults(faults)

    def test_stiffness_left_out(self):
        self.assert_refused(['angle_springs[0].stiffness', '0', 'allowed'], 'add_springs',
                            angle_springs=[angle_spring(self.ids[:2], stiffness=0)])

    def test_bad_ids(self):
        faults = []
        for kind in KINDS:
            field = kind[:-1] + '_ids'
            ids = self.spring_ids[kind]
            for wrong in (NO_ID, ids[0]):
                bad = {field: [ids[0], ids[1], wrong]}
                words = [field + '[2]', str(wrong), 'allowed']
                faults += [
                    self.fault(words, 'set_springs', **bad, **{kind: self.good_springs(3)[kind]}),
                    self.fault(words, 'remove_springs', **bad)]
            lengths = {field: ids[:2], kind: self.good_springs(3)[kind]}
            faults.append(self.fault([field, '2', kind, '3', 'allowed'], 'set_springs', **lengths))
        self.assert_no_faults(faults)

    def test_ids_that_are_refused_are_given_later(self):
        springs = self.good_springs(1)
        springs['oriented_angle_springs'][0].stiffness = -1
        with self.assertRaises(Refused):
            self.node.add_springs(**springs)
        ids = ids_of(self.node.add_springs(**self.good_springs(1)))
        self.assertEqual({kind: [self.spring_ids[kind][-1] + 1] for kind in KINDS}, ids)

    def test_a_good_kind_beside_a_bad_one_is_not_removed(self):
        ids = dict(self.spring_ids, oriented_angle_springs=[NO_ID])
        self.assert_refused(['oriented_angle_spring_ids[0]', str(NO_ID), 'allowed'],
                            'remove_springs', **same_ids(ids))
        self.assertEqual(5, len(springs_of(self.node.get_scene())['angle_springs']))
