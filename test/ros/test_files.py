import json
import os
import shutil
import tempfile

from node_client import NodeTest, Refused
from scenes import (
    KINDS, OCTANT_CORNERS, add_random_scene, angle_spring, exact, ids_of, particle)


class FileTest(NodeTest):
    def setUp(self):
        super().setUp()
        self.directory = self.make_scene_directory()

    def path(self, name):
        return os.path.join(self.directory, name)

    def saved(self, name):
        """Save the scene; return what the file says."""
        self.node.save_scene(name)
        with open(self.path(name)) as file:
            return json.load(file)

    def assert_refused(self, word, service, path):
        before = self.node.get_scene()
        with self.assertRaises(Refused, msg=path) as refusal:
            getattr(self.node, service)(path)
        self.assertIn(word, str(refusal.exception))
        self.assertEqual(exact(before), exact(self.node.get_scene()), path)


class TestRoundTrip(FileTest):
    def test_to_the_last_bit(self):
        add_random_scene(self.node, seed=2, particles=30, springs=50)
        scene = self.node.get_scene()
        self.node.remove_particles([scene.particle_ids[i] for i in (0, 7, 29)])
        springs = ids_of(self.node.get_scene())
        self.node.remove_springs(*[[ids[0], ids[3]] for ids in springs.values()])
        self.node.add_particles([particle((1, 0, 0), (0, 5e-324, -0.0), mass=1e-30, damping=1e30)])
        self.node.step(steps=137)
        saved = self.node.get_scene()
        self.node.save_scene('random.json')

        self.node.clear()
        self.node.load_scene('random.json')
        self.assertEqual(exact(saved), exact(self.node.get_scene()))

    def test_going_on_from_a_file(self):
        # Sums are in an order that comes from where the particles were added, or loaded.
        add_random_scene(self.node, seed=2, particles=30, springs=50)
        self.node.step(steps=137)
        self.node.save_scene('half_way.json')
        self.node.step(steps=50)
        expected = self.node.get_scene()

        self.node.clear()
        self.node.load_scene('half_way.json')
        self.node.step(steps=50)
        scene = self.node.get_scene()
        self.assertEqual(expected.time, scene.time)
        for before, after in zip(expected.particles, scene.particles):
            for axis in 'xyz':
                self.assertAlmostEqual(getattr(before.position, axis),
                                       getattr(after.position, axis), delta=1e-13)

    def test_before_the_first_step(self):
        add_random_scene(self.node, seed=1, particles=1000, springs=0)
        added = self.node.get_scene()
        self.node.save_scene('unmoved.json')
        self.node.load_scene('unmoved.json')
        loaded = self.node.get_scene()
        self.assertEqual([], [i for i, (before, after) in
                              enumerate(zip(added.particles, loaded.particles))
                              if exact(before) != exact(after)])

    def test_after_a_time_step_that_is_far_too_long(self):
        ids = self.node.add_particles([particle(p, mass=1e-30) for p in OCTANT_CORNERS[:2]]).ids
        self.node.add_springs(angle_springs=[angle_spring(ids, 1e30)])
        self.node.step(steps=10)
        saved = self.node.get_scene()
        self.node.save_scene('wild.json')
        self.node.load_scene('wild.json')
        self.assertEqual(exact(saved), exact(self.node.get_scene()))

    def test_a_file_takes_the_place_of_the_scene(self):
        add_random_scene(self.node, seed=1)
        self.node.step(steps=10)
        saved = self.node.get_scene()
        self.node.save_scene('first.json')
        add_random_scene(self.node, seed=2)
        self.node.step(steps=10)
        self.node.load_scene('first.json')
        self.assertEqual(exact(saved), exact(self.node.get_scene()))

    def test_saving_again_replaces_the_file(self):
        self.node.add_particles([particle((1, 0, 0))] * 1000)
        self.node.save_scene('again.json')
        self.node.clear()
        self.assertEqual([], self.saved('again.json')['particles'])
        self.assertEqual(['again.json'], os.listdir(self.directory))

    def test_saving_makes_the_directory(self):
        os.rmdir(self.directory)
        self.node.save_scene('made.json')
        self.assertEqual(['made.json'], os.listdir(self.directory))

    def test_ids_go_on_after_loading(self):
        add_random_scene(self.node, seed=3)
        self.node.save_scene('ids.json')
        last = self.node.add_particles([particle((1, 0, 0))]).ids[0]
        self.node.load_scene('ids.json')
        self.assertEqual([last + 1], list(self.node.add_particles([particle((1, 0, 0))]).ids))

    def test_ids_that_would_use_up_all_others(self):
        add_random_scene(self.node, seed=3)
        saved = self.saved('ids.json')
        for kind in ('particles',) + KINDS:
            scene = json.loads(json.dumps(saved))
            scene[kind][-1]['id'] = 4294967294
            if kind == 'particles':  # which no spring may join then
                for springs in KINDS:
                    scene[springs] = []
            with open(self.path('large.json'), 'w') as file:
                json.dump(scene, file)
            self.assert_refused('is 4294967294; allowed: at most 4000000000', 'load_scene',
                                'large.json')
            add_random_scene(self.node, seed=4)

    def test_reset_leads_to_what_was_loaded(self):
        add_random_scene(self.node, seed=4)
        self.node.step(steps=20)
        self.node.save_scene('start.json')
        loaded = self.node.get_scene()
        self.node.load_scene('start.json')
        self.node.step(steps=20)
        self.node.reset()
        scene = self.node.get_scene()
        self.assertEqual(exact(loaded.particles), exact(scene.particles))
        self.assertEqual(0, scene.time)


class TestPaths(FileTest):
    def test_outside_of_the_directory(self):
        add_random_scene(self.node, seed=1)
        outside = tempfile.mkdtemp(dir=os.path.dirname(self.directory))
        self.addCleanup(shutil.rmtree, outside)
        self.node.save_scene('inside.json')
        there = os.path.join(outside, 'there.json')
        shutil.copy(self.path('inside.json'), there)
        os.symlink(outside, self.path('directory_link'))
        os.symlink(there, self.path('file_link.json'))
        self.node.step(steps=5)
        content = open(there).read()
        for path in ('../' + os.path.basename(outside) + '/there.json',
                     'missing/../../' + os.path.basename(outside) + '/there.json',
                     there, 'directory_link/there.json', 'file_link.json'):
            self.assert_refused('allowed', 'load_scene', path)
            self.assert_refused('allowed', 'save_scene', path)
        self.assert_refused('allowed', 'save_scene', os.path.join(outside, 'new.json'))
        self.assertEqual(['there.json'], os.listdir(outside))
        self.assertEqual(content, open(there).read())

    def test_links_to_what_is_not_there_yet(self):
        outside = tempfile.mkdtemp(dir=os.path.dirname(self.directory))
        self.addCleanup(shutil.rmtree, outside)
        os.symlink(os.path.join(outside, 'new.json'), self.path('file_link.json'))
        os.symlink(os.path.join(outside, 'new'), self.path('directory_link'))
        for path in ('file_link.json', 'directory_link/new.json'):
            self.assert_refused('', 'load_scene', path)
            self.assert_refused('', 'save_scene', path)
        self.assertTrue(os.path.islink(self.path('file_link.json')))
        self.assertEqual([], os.listdir(outside))

    def test_links_inside_are_followed(self):
        os.mkdir(self.path('folder'))
        os.symlink('folder/scene.json', self.path('latest.json'))
        for particles in (1, 2):  # a file is made, then replaced
            self.node.add_particles([particle((1, 0, 0))])
            self.assertEqual(particles, len(self.saved('latest.json')['particles']))
            self.assertTrue(os.path.islink(self.path('latest.json')))
            self.assertEqual(['scene.json'], os.listdir(self.path('folder')))
        self.node.load_scene('latest.json')

    def test_the_mode_of_a_file_stays(self):
        self.node.save_scene('shared.json')
        os.chmod(self.path('shared.json'), 0o664)
        self.node.save_scene('shared.json')
        self.assertEqual(0o664, os.stat(self.path('shared.json')).st_mode & 0o777)

    def test_no_file(self):
        os.mkdir(self.path('folder'))
        for path in ('', '.', '..', '/', 'folder', 'folder/..'):
            self.assert_refused('allowed', 'load_scene', path)
            self.assert_refused('allowed', 'save_scene', path)
        self.assert_refused('missing.json', 'load_scene', 'missing.json')
        self.assert_refused('x.json', 'save_scene', 'no_such_folder/x.json')

    def test_names_that_are_too_long(self):
        self.node.save_scene(255 * 'x')
        self.node.load_scene(255 * 'x')
        for length in (256, 300, 100000):
            for service in ('load_scene', 'save_scene'):
                before = self.node.get_scene()
                with self.assertRaises(Refused) as refusal:
                    getattr(self.node, service)(length * 'x')
                message = str(refusal.exception)
                self.assertIn('File name too long', message)
                self.assertNotIn('.part', message)
                self.assertNotIn('filesystem', message)
                self.assertLess(len(message), 500)
                self.assertEqual(exact(before), exact(self.node.get_scene()))

    def test_names_of_several_lines(self):
        directory = os.path.realpath(self.directory)
        shown = directory + '/a?b.json'
        self.assertEqual('saved ' + shown, self.node.save_scene('a\nb.json').message)
        self.assertEqual('loaded ' + shown, self.node.load_scene('a\nb.json').message)
        self.assertEqual(['a\nb.json'], os.listdir(self.directory))
        self.assert_refused('cannot read ' + directory + '/no?file: ', 'load_scene', 'no\nfile')

    def test_a_zero_byte(self):
        self.assert_refused('allowed', 'load_scene', 'good.json\0.json')
        self.assert_refused('allowed', 'save_scene', 'good.json\0.json')


class TestBadFiles(FileTest):
    def setUp(self):
        super().setUp()
        add_random_scene(self.node, seed=7, particles=5, springs=3)
        self.good = self.saved('good.json')
        self.node.step(steps=3)

    def assert_text_refused(self, text, word):
        with open(self.path('bad.json'), 'w') as file:
            file.write(text)
        self.assert_refused(word, 'load_scene', 'bad.json')

    def assert_altered_refused(self, alter, *words):
        scene = json.loads(json.dumps(self.good))
        alter(scene)
        for word in words:
            self.assert_text_refused(json.dumps(scene), word)

    def test_truncated(self):
        text = open(self.path('good.json')).read().rstrip()
        for length in list(range(0, len(text), 97)) + [len(text) - 1]:
            self.assert_text_refused(text[:length], 'bad.json')

    def test_no_scene(self):
        for text in ('[]', '3', 'null', '{}', 'a text', '{"particles": []}'):
            self.assert_text_refused(text, 'bad.json')
        self.assert_text_refused('a text', "at byte 1: this is not JSON: 'a'")

    def test_unknown_format(self):
        self.assert_altered_refused(lambda s: s.update(format='a scene of tomorrow'),
                                    'format', 'a scene of tomorrow', 'allowed')

    def test_unknown_field(self):
        self.assert_altered_refused(lambda s: s.update(colour=1), 'colour')
        for kind in ('particles',) + KINDS:
            self.assert_altered_refused(lambda s: s[kind][2].update(colour=1),
                                        kind + '[2]', 'colour')

    def test_wrong_type(self):
        for field, value in (('time', 'noon'), ('particles', {}), ('angle_springs', 5)):
            self.assert_altered_refused(lambda s: s.update({field: value}), field)
        for field, value in (('position', 'north'), ('position', [1, 2]),
                             ('position', [1, 2, '3']), ('mass', 'heavy'), ('mass', None),
                             ('pinned', 1), ('id', 1.5), ('id', -1), ('id', 4294967296)):
            self.assert_altered_refused(lambda s: s['particles'][2].update({field: value}),
                                        'particles[2].' + field, 'allowed')
        for kind in KINDS:
            for field, value in (('particles', [0]), ('particles', [0.5, 1, 2]),
                                 ('stiffness', True), ('at_rest', 'yes')):
                self.assert_altered_refused(lambda s: s[kind][1].update({field: value}),
                                            kind + '[1].' + field, 'allowed')

    def test_wrong_value(self):
        first = self.good['particles'][0]['id']
        for list_name, field, value in (
                ('particles', 'position', [0, 0, 0]), ('particles', 'mass', -2),
                ('particles', 'damping', -3), ('particles', 'id', first),
                ('angle_springs', 'particles', [first, first]),
                ('angle_springs', 'rest_angle', 4), ('solid_angle_springs', 'stiffness', 0),
                ('solid_angle_springs', 'rest_solid_angle', 7),
                ('oriented_angle_springs', 'width', 1.5),
                ('oriented_angle_springs', 'particles', [4000000000, first, first])):
            self.assert_altered_refused(lambda s: s[list_name][1].update({field: value}),
                                        '%s[1].%s' % (list_name, field), 'allowed')
        self.assert_altered_refused(lambda s: s.update(time=-1), 'time', '-1', 'allowed')

    def test_numbers_that_json_does_not_know(self):
        for number in ('NaN', 'Infinity', '1e999'):
            self.assert_text_refused(json.dumps(self.good).replace(
                '"mass": %r' % self.good['particles'][0]['mass'], '"mass": ' + number), 'bad.json')
