"""Maps of closed surfaces by relax_mesh: what it writes and says, and what it refuses."""

import csv
import os
import pty
import re
import select
import signal
import subprocess
import tempfile
import threading

import numpy as np
import rospkg
import rospy
from spherical_springs.msg import Status
from spherical_springs.srv import (
    AddParticles, AddParticlesResponse, AddSprings, GetScene, Relax, RelaxResponse)
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse

from node_client import LONG, PACKAGE, NodeTest
from relax_mesh import command, relax_mesh
from scenes import particle, solid_angles
from shapes import BROKEN, bumpy, mesh, star


def data(name):
    return os.path.join(rospkg.RosPack().get_path(PACKAGE), '..', 'shared', 'data', name)


class MeshTest(NodeTest):
    def setUp(self):
        super().setUp()
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def write(self, name, vertices, faces):
        mesh.write_obj(self.path(name), vertices, faces)
        return self.path(name)

    def run_to_success(self, **options):
        outcome = relax_mesh(output=self.path('sphere.obj'), **options)
        self.assertEqual((0, ''), (outcome.code, outcome.error))
        return outcome

    def assert_is_map(self, faces, weights, outcome, path=None):
        """Check the sphere that was written, and what was said of it. Return log area ratios."""
        sphere, same_faces = mesh.read_obj(path or self.path('sphere.obj'))
        np.testing.assert_array_equal(faces, same_faces)
        np.testing.assert_allclose(np.linalg.norm(sphere, axis=1), 1, atol=1e-14)
        areas = solid_angles(*np.moveaxis(sphere[faces], 1, 0))
        self.assertGreater(areas.min(), 0)
        self.assertAlmostEqual(4 * np.pi, areas.sum(), delta=1e-9)
        ratios = np.log(areas / weights * weights.sum() / (4 * np.pi))
        figures = outcome.figures('after')
        for name, value in {'spread': ratios.std(), 'mean': np.abs(ratios).mean(),
                            'worst face': np.abs(ratios).max(), 'folded': 0,
                            'sum': 4 * np.pi}.items():
            np.testing.assert_allclose(figures[name], value, rtol=0.01, atol=1e-8, err_msg=name)
        return ratios


class TestData(MeshTest):
    """Of a head and a cow, where they are."""

    def assert_spread(self, most, name, start=None):
        for needed in filter(None, (name, start)):
            if not os.path.exists(data(needed)):
                self.skipTest('there is no %s here' % data(needed))
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
        self.run_to_success(mesh=self.write('surface.obj', vertices, faces),
                            uv=self.path('uv.obj'))
        sphere, _ = mesh.read_obj(self.path('sphere.obj'))
        same_vertices, same_faces = mesh.read_obj(self.path('uv.obj'))
        np.testing.assert_array_equal(vertices, same_vertices)
        np.testing.assert_array_equal(faces, same_faces)
        with open(self.path('uv.obj')) as file:
            lines = [line.split() for line in file]
        places = np.array([line[1:] for line in lines if line[0] == 'vt'], float)
        corners = np.array([[int(corner.split('/')[1]) - 1 for corner in line[1:]]
                            for line in lines if line[0] == 'f'])
        longitude, latitude = np.moveaxis((places[corners] - 0.5) * (2 * np.pi, np.pi), 2, 0)
        found = np.stack([np.cos(latitude) * np.cos(longitude),
                          np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=2)
        np.testing.assert_allclose(found, sphere[faces], atol=1e-12)
        across = np.ptp(places[corners][:, :, 0], axis=1) > 0.5 + 1e-12
        self.assertLessEqual(np.count_nonzero(across), 2)  # with a pole inside


class TestRefusals(MeshTest):
    def refusal(self, **options):
        """The reason; nothing has been written, and the node's scene is as it was."""
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
        self.node.add_particles([particle((1, 0, 0))])
        for name, (content, pattern) in BROKEN.items():
            path = self.path('broken.obj')
            with open(path, 'wb') as file:
                file.write(content if isinstance(content, bytes) else content.encode())
            with self.subTest(name):
                reason = self.refusal(mesh=path)
                self.assertRegex(reason, re.escape(path) + '.*(' + pattern + ')')
        self.assertEqual(1, len(self.node.get_scene().particles))

    def test_options(self):
        vertices, faces = bumpy(1)
        surface = self.write('surface.obj', vertices, faces)
        for name, last in (('density', '-2'), ('steep', '1e9'), ('endless', '1e308')):
            with open(self.path(name), 'w') as file:
                file.write('1\n' * (len(faces) - 1) + last + '\n')
        huge = self.write('huge.obj', 9 * vertices, faces)
        for options, pattern in (
                ({'mesh': self.path('no.obj')}, 'no.obj: No such file'),
                ({'mesh': self.directory}, 'not a file'),
                ({'density': self.path('density')}, '/density: density 79 is -2; allowed: a positive'),
                ({'density': self.path('steep')},
                 r'/steep: face 79 is to have 99\.\d* % of the sphere; allowed: up to 45 %'),
                ({'density': self.path('endless'), 'mesh': huge},
                 '/endless: the area of face 79, with its density, is inf; allowed: 0 or more'),
                ({'density': self.path('none')}, '/none: No such file'),
                ({'mesh': self.path(300 * 'x')}, 'cannot read .*x: File name too long'),
                ({'uv': self.path(300 * 'x')}, 'cannot write .*x: File name too long'),
                ({'sphere': self.write('finer.obj', *bumpy(2))}, 'faces are not those'),
                ({'sphere': self.write('reverse.obj', vertices, faces[::-1])}, 'faces are not those'),
                ({'sphere': self.write('zero.obj', 0 * vertices, faces)}, 'vertex 0 is at'),
                ({'angle_weight': 'nan'}, 'angle-weight is nan; allowed: 0 to'),
                ({'output': '/nowhere/x.obj'}, "--output is '/nowhere/x.obj'; allowed: "),
                ({'colour': 'red'}, "'--colour'"),
                ({'node': 'nobody'}, 'no node /nobody answers')):
            with self.subTest(options=options):
                self.assertRegex(self.refusal(**{'mesh': surface, **options}), pattern)

    def test_no_master(self):
        surface = self.write('surface.obj', *bumpy(1))
        environment = {**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'}
        self.assertRegex(self.refusal(mesh=surface, environment=environment),
                         'no ROS master answers at http://localhost:1')


class EndlessNode:
    """Stands for a node whose relaxation ends only when it is cancelled, and whose scene is then
    empty."""

    def __init__(self, name):
        self.relaxing, self.cancelled = threading.Event(), threading.Event()
        self.services = [rospy.Service(name + '/' + service, kind, answer)
                         for service, kind, answer in (
            ('set_running', SetBool, lambda _: SetBoolResponse(success=True)),
            ('clear', Trigger, lambda _: TriggerResponse(success=True)),
            ('add_particles', AddParticles, lambda request: AddParticlesResponse(
                success=True, ids=range(len(request.particles)))),
            ('add_springs', AddSprings, lambda _: {'success': True}),
            ('get_scene', GetScene, lambda _: {'success': True}),
            ('relax', Relax, self.relax),
            ('cancel', Trigger, self.cancel))]

    def relax(self, _):
        self.relaxing.set()
        return RelaxResponse(success=self.cancelled.wait(2 * LONG))

    def cancel(self, _):
        self.cancelled.set()
        return TriggerResponse(success=True)

    def shutdown(self):
        for service in self.services:
            service.shutdown()


class TestInterruption(MeshTest):
    def test_relaxation_is_cancelled_and_nothing_written(self):
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        surface = self.write('surface.obj', *bumpy(1))
        for which in (signal.SIGINT, signal.SIGTERM):
            node.relaxing.clear()
            node.cancelled.clear()
            process = subprocess.Popen(
                command(mesh=surface, output=self.path('sphere.obj'), uv=self.path('uv.obj'),
                        node='/endless'), stderr=subprocess.PIPE, text=True)
            self.assertTrue(node.relaxing.wait(LONG))
            self.assertFalse(node.cancelled.is_set())
            process.send_signal(which)
            error = process.communicate(timeout=LONG)[1]
            self.assertTrue(node.cancelled.is_set())
            self.assertEqual((1, 'error: interrupted; no file has been written\n'),
                             (process.returncode, error))
            self.assertEqual(['surface.obj'], os.listdir(self.directory))


class TestOtherClients(MeshTest):
    def test_who_changes_the_scene_meanwhile_is_noticed(self):
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        node.cancelled.set()
        outcome = relax_mesh(mesh=self.write('surface.obj', *bumpy(1)), node='/endless',
                             output=self.path('sphere.obj'))
        self.assertEqual((1, 'error: another client has changed the scene of /endless meanwhile; '
                          'relax_mesh needs a node to itself'), (outcome.code, outcome.error))
        self.assertEqual(['surface.obj'], os.listdir(self.directory))


class TestProgress(MeshTest):
    def test_a_terminal_shows_how_far_it_has_come(self):
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        status = rospy.Publisher('/endless/status', Status, queue_size=1, latch=True)
        self.addCleanup(status.unregister)
        status.publish(state='relaxing', relax_progress=0.43)
        terminal, its_other_end = pty.openpty()
        self.addCleanup(os.close, terminal)
        process = subprocess.Popen(
            command(mesh=self.write('surface.obj', *bumpy(1)), output=self.path('sphere.obj'),
                    node='/endless'), stdout=subprocess.DEVNULL, stderr=its_other_end)
        os.close(its_other_end)
        shown = ''
        while 'relaxing ... 43 %' not in shown:
            self.assertTrue(select.select([terminal], [], [], LONG)[0], shown)
            shown += os.read(terminal, 1000).decode()
        self.assertRegex(shown, r'mapping \.\.\. \d+ %\r\x1b\[K')
        process.send_signal(signal.SIGINT)
        process.wait(LONG)


class TestNode(MeshTest):
    def test_scene_is_replaced_and_says_so(self):
        self.node.add_particles([particle((1, 0, 0)), particle((0, 1, 0))])
        self.node.set_running(True)
        vertices, faces = bumpy(1)
        outcome = self.run_to_success(mesh=self.write('surface.obj', vertices, faces))
        self.assertIn('removed 2 particles and 0 springs', outcome.output)
        scene = self.node.get_scene()
        self.assertEqual(len(vertices), len(scene.particles))
        self.assertEqual(len(faces), len(scene.solid_angle_springs))
        self.node.step(steps=0)
        self.node.step(steps=1)  # only while paused

    def test_launch_file(self):
        self.directory = self.path("Anna's scans")
        os.mkdir(self.directory)
        vertices, faces = bumpy(2)
        self.write('left hand.obj', vertices, faces)
        ended = subprocess.run(
            ['roslaunch', PACKAGE, 'mesh.launch', 'mesh:=left hand.obj', 'uv:=uv of it.obj',
             'name:=springs_of_mesh'],
            cwd=self.directory, env={**os.environ, 'PWD': self.directory}, timeout=4 * LONG,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual({'left hand.obj', 'left hand_sphere.obj', 'uv of it.obj'},
                         set(os.listdir(self.directory)), ended.stdout)
        sphere, same_faces = mesh.read_obj(self.path('left hand_sphere.obj'))
        np.testing.assert_array_equal(faces, same_faces)
        self.assertGreater(mesh.solid_angles(sphere, faces).min(), 0)
