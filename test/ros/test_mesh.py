"""Maps of closed surfaces by relax_mesh: what it writes and says, and what it refuses."""

import csv
import os
import re
import subprocess
import unittest

import numpy as np
import rospkg

from mesh_test import MeshTest
from node_client import LONG, PACKAGE
from relax_mesh import command, relax_mesh
from scenes import solid_angles
from shapes import BROKEN, bumpy, mesh, star


def data(name):
    return os.path.join(rospkg.RosPack().get_path(PACKAGE), '..', 'shared', 'data', name)


@unittest.skipUnless(os.path.isdir(data('')), 'there is no ' + data(''))
class TestData(MeshTest):
    """Of a head and a cow, where they are."""

    def assert_spread(self, most, name, start=None):
        options = {'sphere': data(start)} if start else {}
        outcome = self.run_to_success(mesh=data(name), **options)
        vertices, faces = mesh.read_obj(data(name))
        ratios = self.assert_is_map(faces, mesh.areas(vertices, faces), outcome)
        self.assertLess(ratios.std(), most)

    def test_head_from_its_start(self):
        self.assert_spread(2e-3, 'maxplanck.obj', 'maxplanck_sphere.obj')

    def test_coarse_cow(self):
        self.assert_spread(1e-2, 'spot_low_resolution.obj')


class TestShapes(MeshTest):
    def test_map_and_start_again_from_it(self):
        for vertices, faces in (bumpy(), star()):
            surface = self.write('surface.obj', vertices, faces)
            outcome = self.run_to_success(mesh=surface)
            ratios = self.assert_is_map(faces, mesh.areas(vertices, faces), outcome)
            self.assertLess(ratios.std(), 0.05)

            os.rename(self.path('sphere.obj'), self.path('start.obj'))
            again = self.run_to_success(mesh=surface, sphere=self.path('start.obj'))
            self.assertAlmostEqual(outcome.figures('after')['spread'],
                                   again.figures('before')['spread'], delta=1e-4)
            better = self.assert_is_map(faces, mesh.areas(vertices, faces), again)
            self.assertLessEqual(better.std(), 1.001 * ratios.std())

    def test_from_a_folded_start(self):
        vertices, faces = bumpy()
        start = vertices * (1, 1, -1)
        outcome = self.run_to_success(mesh=self.write('surface.obj', vertices, faces),
                                      sphere=self.write('start.obj', start, faces))
        self.assertEqual(len(faces), outcome.figures('before')['folded'])
        self.assertIn('without folds: passed over', outcome.output)
        self.assert_is_map(faces, mesh.areas(vertices, faces), outcome)

    def test_density(self):
        vertices, faces = bumpy()
        density = 1 + (vertices[faces].mean(axis=1)[:, 2] > 0)
        np.savetxt(self.path('density'), density)
        outcome = self.run_to_success(mesh=self.write('surface.obj', vertices, faces),
                                      density=self.path('density'))
        ratios = self.assert_is_map(faces, density * mesh.areas(vertices, faces), outcome)
        self.assertLess(ratios.std(), 0.05)

    def test_density_over_nine_decades(self):
        vertices, faces = bumpy(0)
        density = np.where(np.arange(len(faces)) % 2, 1, 1e-9)
        np.savetxt(self.path('density'), density)
        outcome = self.run_to_success(mesh=self.write('surface.obj', vertices, faces),
                                      density=self.path('density'))
        weights = density * mesh.areas(vertices, faces)
        self.assert_is_map(faces, np.maximum(weights, 1e-6 * weights.mean()), outcome)

    def test_inside_out(self):
        vertices, faces = bumpy()
        faces = faces[:, ::-1]
        surface = self.write('surface.obj', vertices, faces)
        outcome = relax_mesh(mesh=surface, output=self.path('sphere.obj'))
        self.assertEqual(0, outcome.code, outcome.error)
        self.assertRegex(outcome.error,
                         r'\Awarning: the faces of ' + re.escape(surface) + ' look inwards.*\Z')
        self.assert_is_map(faces, mesh.areas(vertices, faces), outcome)

    def test_angle_weight(self):
        vertices, faces = bumpy()
        surface = self.write('surface.obj', vertices, faces)

        def distortion(weight):
            self.run_to_success(mesh=surface, metrics=self.path('m.csv'), angle_weight=weight)
            rows = np.loadtxt(self.path('m.csv'), delimiter=',', skiprows=1)
            return rows[:, 3].std(), np.abs(rows[:, 4:]).mean()

        equal_areas, some_angles = distortion(0), distortion(1)
        self.assertLess(equal_areas[0], 0.9 * some_angles[0])
        self.assertGreater(equal_areas[1], 1.1 * some_angles[1])

    def test_metrics(self):
        vertices, faces = bumpy(2)
        self.run_to_success(mesh=self.write('surface.obj', vertices, faces),
                            metrics=self.path('metrics.csv'))
        sphere, _ = mesh.read_obj(self.path('sphere.obj'))
        with open(self.path('metrics.csv')) as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([str(i) for i in range(len(faces))], [row['face'] for row in rows])

        def angles(points):
            sides = np.stack([points[faces[:, (i + 1) % 3]] - points[faces[:, i]]
                              for i in range(3)], axis=1)
            sides /= np.linalg.norm(sides, axis=2, keepdims=True)
            return np.stack([np.arccos(np.sum(sides[:, i] * -sides[:, i - 1], axis=1))
                             for i in range(3)])

        shares = mesh.areas(vertices, faces)
        shares *= 4 * np.pi / shares.sum()
        areas = solid_angles(*np.moveaxis(sphere[faces], 1, 0))
        change = angles(sphere) - angles(vertices)
        for name, expected in {'share_sr': shares, 'area_sr': areas,
                               'log_area_ratio': np.log(areas / shares),
                               'angle_change_1_rad': change[0], 'angle_change_2_rad': change[1],
                               'angle_change_3_rad': change[2]}.items():
            np.testing.assert_allclose([float(row[name]) for row in rows], expected, atol=1e-9,
                                       err_msg=name)

    def test_texture_coordinates(self):
        vertices, faces = bumpy(2)
        outcome = self.run_to_success(mesh=self.write('surface.obj', vertices, faces),
                                      uv=self.path('uv.obj'), pole='0,0,1', front='1,0,0')
        sphere, _ = mesh.read_obj(self.path('sphere.obj'))
        np.testing.assert_array_equal((0, 0, 1), sphere[vertices[:, 2].argmax()])
        np.testing.assert_allclose(0, sphere[vertices[:, 0].argmax(), 1], atol=1e-15)
        cut_vertices, cut_faces = mesh.read_obj(self.path('uv.obj'))
        np.testing.assert_array_equal(vertices, cut_vertices[:len(vertices)])
        self.assertAlmostEqual(mesh.areas(vertices, faces).sum(),
                               mesh.areas(cut_vertices, cut_faces).sum(), delta=1e-9)
        with open(self.path('uv.obj')) as file:
            lines = [line.split() for line in file]
        places = np.array([line[1:] for line in lines if line[0] == 'vt'], float)
        corners = np.array([[int(corner.split('/')[1]) - 1 for corner in line[1:]]
                            for line in lines if line[0] == 'f'])
        self.assertTrue((0 <= places).all() and (places <= 1).all())
        longitude, latitude = np.moveaxis((places[corners] - 0.5) * (2 * np.pi, np.pi), 2, 0)
        found = np.stack([np.cos(latitude) * np.cos(longitude),
                          np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=2)
        old = cut_faces < len(vertices)
        np.testing.assert_allclose(found[old], sphere[cut_faces[old]], atol=1e-9)
        self.assertLess(np.ptp(places[corners][:, :, 0], axis=1).max(), 0.5)
        spread, other = re.search(r'texel density ([.\d]+); ([.\d]+) in', outcome.output).groups()
        self.assertEqual(spread, other)

    def test_equal_area_texture(self):
        vertices, faces = bumpy()
        surface = self.write('surface.obj', vertices, faces)
        outcome = self.run_to_success(mesh=surface, uv=self.path('uv.obj'),
                                      uv_projection='equal-area-octahedron')
        spread, other = re.search(r'texel density ([.\d]+); ([.\d]+) in', outcome.output).groups()
        self.assertLess(float(spread), 0.1)
        self.assertGreater(float(other), 0.3)


class TestFormats(MeshTest):
    """Surfaces as other programs write them."""

    def write_text(self, name, text):
        with open(self.path(name), 'w') as file:
            file.write(text)
        return self.path(name)

    def test_stl_with_a_hole_and_a_second_piece(self):
        vertices, faces = bumpy(2)
        corners = np.concatenate([vertices[faces[1:]], 9 + 0.1 * vertices[faces]])
        surface = self.write_text('surface.stl', 'solid\n' + ''.join(
            'facet normal 0 0 0\nouter loop\n' + ''.join('vertex %.9g %.9g %.9g\n' % tuple(v)
                                                        for v in triangle) +
            'endloop\nendfacet\n' for triangle in corners) + 'endsolid\n')
        command_line = [*command(mesh='file://' + surface, output=self.path('sphere.obj'),
                                 fill_holes=3), '--largest-piece']
        run = subprocess.run(command_line, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             text=True, timeout=4 * LONG)
        self.assertEqual((0, ''), (run.returncode, run.stderr))
        for line in ('repair: welded ', 'repair: kept the piece of the largest area, of %d faces, '
                     'and left out 1 other' % (len(faces) - 1),
                     'repair: filled 1 hole with 1 face and 0 new vertices'):
            self.assertIn(line, run.stdout)
        sphere, mapped = mesh.read_obj(self.path('sphere.obj'))
        self.assertEqual((len(vertices), len(faces)), (len(sphere), len(mapped)))

    def test_polygons_with_a_density_each(self):
        box = [(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)]
        sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        text = 'OFF\n8 6 0\n' + ''.join('%g %g %g\n' % v for v in box) + ''.join(
            '4 %d %d %d %d\n' % side for side in sides)
        self.write_text('density', '1 1 1 1 1 3')
        outcome = self.run_to_success(mesh=self.write_text('box.off', text),
                                      density=self.path('density'), metrics=self.path('m.csv'))
        shares = np.loadtxt(self.path('m.csv'), delimiter=',', skiprows=1)[:, 1]
        weights = np.repeat([6, 6, 3, 3, 2, 3 * 2], 2) / 2
        np.testing.assert_allclose(shares, 4 * np.pi * weights / weights.sum(), rtol=1e-9)
        self.assertEqual(0, outcome.figures('after')['folded'])

    def test_a_start_for_the_vertices_of_the_file(self):
        vertices, faces = bumpy(2)
        loose = self.write('surface.obj', np.concatenate([[(9, 9, 9)], vertices]), faces + 1)
        start = self.write('start.obj', np.concatenate([[(0, 0, 1)], vertices]), faces + 1)
        outcome = self.run_to_success(mesh=loose, sphere=start)
        self.assertIn('repair: left out 1 vertex that belongs to no face', outcome.output)
        self.assertEqual(0, outcome.figures('before')['folded'])
        self.assert_is_map(faces, mesh.areas(vertices, faces), outcome)


class TestFiles(MeshTest):
    """Of which one is longer than the system allows."""

    def test_those_that_can_be_written_are(self):
        vertices, faces = bumpy(2)
        files = {name: self.path(name) for name in ('output', 'uv', 'metrics')}
        surface = self.write('surface.obj', vertices, faces)
        relax_mesh(mesh=surface, **files)
        sizes = {name: os.path.getsize(path) for name, path in files.items()}
        self.assertGreater(sizes['metrics'], max(sizes['output'], sizes['uv']))
        for path in files.values():
            os.remove(path)
        outcome = relax_mesh(mesh=surface, longest_file=sizes['metrics'] - 1, **files)
        self.assertEqual(
            (1, 'error: cannot write %s: File too large; written: %s, %s'
             % (files['metrics'], files['output'], files['uv'])), (outcome.code, outcome.error))
        self.assertEqual({'surface.obj', 'output', 'uv'}, set(os.listdir(self.directory)))
        _, same_faces = mesh.read_obj(files['output'])
        np.testing.assert_array_equal(faces, same_faces)


class TestRefusals(MeshTest):
    def refusal(self, **options):
        """The reason; nothing has been written."""
        outputs = {name: self.path(name) for name in ('output', 'uv', 'metrics')}
        for path in outputs.values():
            with open(path, 'w') as file:
                file.write('old')
        before = sorted(os.listdir(self.directory))
        outcome = relax_mesh(**{**outputs, **options})
        self.assertEqual(1, outcome.code, outcome.error)
        self.assertRegex(outcome.error, r'\Aerror: .*\Z')
        self.assertEqual(before, sorted(os.listdir(self.directory)))
        for path in outputs.values():
            with open(path) as file:
                self.assertEqual('old', file.read())
        return outcome.error

    def test_surfaces(self):
        for name, (content, pattern) in BROKEN.items():
            path = self.path('broken.obj')
            with open(path, 'wb') as file:
                file.write(content if isinstance(content, bytes) else content.encode())
            with self.subTest(name):
                reason = self.refusal(mesh=path)
                self.assertRegex(reason, re.escape(path) + '.*(' + pattern + ')')

    def test_options(self):
        vertices, faces = bumpy(1)
        surface = self.write('surface.obj', vertices, faces)
        for name, last in (('density', '-2'), ('steep', '1e9'), ('endless', '1e308')):
            with open(self.path(name), 'w') as file:
                file.write('1\n' * (len(faces) - 1) + last + '\n')
        huge = self.write('huge.obj', 9 * vertices, faces)
        os.mkfifo(self.path('pipe'))
        for options, pattern in (
                ({'mesh': self.path('no.obj')}, 'no.obj: No such file'),
                ({'mesh': self.directory}, 'not a file'),
                ({'mesh': self.path('pipe')}, '/pipe: not a file'),
                ({'density': self.path('pipe')}, '/pipe: not a file'),
                ({'density': self.path('density')}, '/density: density 79 is -2; allowed: a positive'),
                ({'density': self.path('steep')},
                 r'/steep: face 79 is to have 99\.\d* % of the sphere; allowed: up to 45 %'),
                ({'density': self.path('endless'), 'mesh': huge},
                 '/endless: the area of face 79, with its density, is inf; allowed: 0 or more'),
                ({'density': self.path('none')}, '/none: No such file'),
                ({'mesh': self.path(300 * 'x')}, 'cannot read .*x: File name too long'),
                ({'uv': self.path(300 * 'x')}, 'cannot write .*x: File name too long'),
                ({'mesh': self.write('two\nlines.obj', vertices, faces[1:])}, r'two\?lines.obj: '),
                ({'sphere': self.write('finer.obj', *bumpy(2))}, 'faces are not those'),
                ({'sphere': self.write('reverse.obj', vertices, faces[::-1])}, 'faces are not those'),
                ({'sphere': self.write('zero.obj', 0 * vertices, faces)}, 'vertex 1 at .* no direction'),
                ({'angle_weight': 'nan'}, 'angle-weight is nan; allowed: 0 to'),
                ({'output': '/nowhere/x.obj'}, "--output is '/nowhere/x.obj'; allowed: "),
                ({'colour': 'red'}, "'--colour'"),
                ({'colour\n' + 200 * 'x': 'red'}, r"option '--colour\?x{91}\.\.\.'; see"),
                ({'angle_weight': 'a\nlot'}, r"--angle-weight is 'a\?lot'; allowed: 0 to"),
                ({'spread': 0}, '--spread is 0; allowed: above 0'),
                ({'max_time': 'soon'}, "--max-time is 'soon'; allowed: above 0"),
                ({'node': 'no\nname'}, r'\[no\?name\]'),
                ({'node': 'nobody'}, 'no node /nobody answers; .* running:=false name:=nobody$'),
                ({'node': '/a/b/c'}, '; start one: ROS_NAMESPACE=/a/b roslaunch .* name:=c$')):
            with self.subTest(options=options):
                self.assertRegex(self.refusal(**{'mesh': surface, **options}), pattern)

    def test_no_master(self):
        surface = self.write('surface.obj', *bumpy(1))
        environment = {**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'}
        self.assertRegex(self.refusal(mesh=surface, environment=environment, node='springs'),
                         'no ROS master answers at http://localhost:1')
