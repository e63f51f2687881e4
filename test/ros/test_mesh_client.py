"""relax_mesh as people run it: how good, how long, progress, interruption, by a node, by launch."""

import os
import pty
import resource
import select
import signal
import subprocess

import actionlib
import numpy as np
from spherical_springs.msg import MapMeshAction, MapMeshResult

from mesh_test import MeshTest
from node_client import LONG, PACKAGE, NodeProcess, wait_until
from relax_mesh import Outcome, command, relax_mesh
from scenes import add_knot, particle, positions
from shapes import bumpy, mesh

ALONE = {**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'}  # where there is no master
FOR_EVER = {'spread': 1e-300, 'max_time': 1e6}


class RunningTest(MeshTest):
    """A command maps `surface`, and something happens to it meanwhile."""

    surface = bumpy(4)

    def begin(self, error=subprocess.PIPE, **options):
        process = subprocess.Popen(
            command(mesh=self.write('surface.obj', *self.surface),
                    output=self.path('sphere.obj'), **options),
            env=ALONE if 'node' not in options else None,
            stdout=subprocess.PIPE, stderr=error, text=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.said = process.stdout.readline()  # when it has read the mesh
        return process

    def outcome(self, process, already=''):
        output, error = process.communicate(timeout=4 * LONG)
        process.stdout, process.stderr = self.said + output, already + (error or '')
        return Outcome(process)

    def assert_best_so_far(self, outcome, error=''):
        self.assertEqual(
            (0, 'warning: interrupted; the best map so far has been written' + error),
            (outcome.code, outcome.error))
        self.assertEqual('wrote ' + self.path('sphere.obj'), outcome.output.splitlines()[-1])
        vertices, faces = self.surface
        self.assert_is_map(faces, mesh.areas(vertices, faces), outcome)


class TestHowGoodAndHowLong(RunningTest):
    def test_it_stops_when_the_map_is_good_enough(self):
        vertices, faces = bumpy(3)
        surface = self.write('surface.obj', vertices, faces)
        for wanted in (0.1, 0.01):
            outcome = self.run_to_success(mesh=surface, spread=wanted, environment=ALONE)
            spread = self.assert_is_map(faces, mesh.areas(vertices, faces), outcome).std()
            self.assertLessEqual(spread, wanted)
            self.assertGreater(spread, 1e-3)
            self.assertRegex(outcome.output, r'\Abefore: .*\nafter: .*\nwrote ' +
                             self.path('sphere.obj') + r'\n\Z')

    def test_it_stops_when_time_is_over(self):
        outcome = self.run_to_success(mesh=self.write('surface.obj', *self.surface), spread=1e-300,
                                      max_time=1, uv=self.path('uv'), environment=ALONE)
        self.assertIn('the time of 1 s is over (--max-time); the spread of 1e-300 (--spread) is '
                      'not reached\n', outcome.output)
        self.assertEqual('wrote %s, %s' % (self.path('sphere.obj'), self.path('uv')),
                         outcome.output.splitlines()[-1])


class TestInterruption(RunningTest):
    def test_the_best_map_so_far_is_written(self):
        process = self.begin(**FOR_EVER)
        already = ''
        while 'spread' not in already:  # of a line that comes every few seconds
            already = process.stderr.readline()
        process.send_signal(signal.SIGTERM)
        outcome = self.outcome(process, already)
        self.assertRegex(outcome.progress[0], r'^mapping \.\.\. 0 % of the time, spread [.\de-]+$')
        self.assert_best_so_far(outcome)

    def test_a_terminal_shows_how_far_it_has_come(self):
        terminal, its_other_end = pty.openpty()
        self.addCleanup(os.close, terminal)
        process = self.begin(error=its_other_end, **FOR_EVER)
        os.close(its_other_end)
        shown = ''

        def read_until(text):
            nonlocal shown
            while text not in shown:
                self.assertTrue(select.select([terminal], [], [], LONG)[0], shown)
                shown += os.read(terminal, 1000).decode()

        read_until('spread')
        self.assertRegex(shown, r'\r\x1b\[Kmapping \.\.\. 0 % of the time, spread')
        process.send_signal(signal.SIGINT)
        read_until('written\r\n')
        self.assertRegex(shown, r'\r\x1b\[Kwarning: interrupted')
        self.assert_best_so_far(self.outcome(process, shown.rpartition('\x1b[K')[2]))

    def test_without_a_map_nothing_is_written(self):
        self.surface = bumpy(5)
        for which in (signal.SIGINT, signal.SIGTERM):
            process = self.begin()
            process.send_signal(which)
            outcome = self.outcome(process)
            self.assertEqual((1, 'error: interrupted; no file has been written'),
                             (outcome.code, outcome.error))
            self.assertEqual(['surface.obj'], os.listdir(self.directory))


class HangingNode:
    """Stands for a node that accepts goals, and never ends one."""

    def __init__(self, name):
        self.goals, self.cancels = [], []
        self._server = actionlib.ActionServer(
            name + '/map_mesh', MapMeshAction, self.accept, self.cancels.append, auto_start=False)
        self._server.start()

    def accept(self, goal):
        goal.set_accepted()
        self.goals.append(goal)

    def is_heard(self):
        return self._server.result_pub.get_num_connections() > 0


class TestByNode(RunningTest):
    surface = bumpy(3)

    def test_the_map_is_that_of_this_process(self):
        here = self.run_to_success(mesh=self.write('surface.obj', *self.surface), environment=ALONE)
        with open(self.path('sphere.obj')) as file:
            map_here = file.read()
        self.node.add_particles([particle((1, 0, 0))])
        there = self.run_to_success(mesh=self.path('surface.obj'), node=self.node.name)
        with open(self.path('sphere.obj')) as file:
            self.assertEqual(map_here, file.read())
        self.assertRegex(
            there.output, r'\Abefore: .*\n%s: mapped; spread .*\nafter: .*\nwrote .*\n\Z'
            % self.node.name)
        self.assertEqual(here.figures('after'), there.figures('after'))
        self.assertEqual(1, len(self.node.get_scene().particles))

    def test_all_that_is_asked_for(self):
        vertices, faces = self.surface
        density = 1 + (vertices[faces].mean(axis=1)[:, 2] > 0)
        np.savetxt(self.path('density'), density)
        outcome = self.run_to_success(
            mesh=self.write('surface.obj', vertices, faces), density=self.path('density'),
            sphere=self.write('start.obj', 3 * vertices, faces), spread=0.02, node=self.node.name,
            load=True)
        ratios = self.assert_is_map(faces, density * mesh.areas(vertices, faces), outcome)
        self.assertTrue(1e-3 < ratios.std() <= 0.02, ratios.std())
        sphere, _ = mesh.read_obj(self.path('sphere.obj'))
        np.testing.assert_allclose(positions(self.node.get_scene()), sphere, atol=1e-15)

    def test_interruption(self):
        process = self.begin(node=self.node.name, **FOR_EVER)
        already = ''
        while 'spread' not in already:
            already = process.stderr.readline()
        process.send_signal(signal.SIGINT)
        outcome = self.outcome(process, already)
        self.assertIn(self.node.name + ': cancelled; best map so far', outcome.output)
        self.assert_best_so_far(outcome)

    def test_refusals_are_told(self):
        with NodeProcess(running=False, max_particles=10) as node:
            node.client()
            outcome = relax_mesh(mesh=self.write('surface.obj', *self.surface), node=node.name,
                                 output=self.path('sphere.obj'), load=True)
            self.assertEqual(
                (1, 'error: %s: load: the map needs 642 particles; allowed here, by '
                 '~max_particles: at most 10' % node.name), (outcome.code, outcome.error))
            self.assertEqual(['surface.obj'], os.listdir(self.directory))

    def test_a_map_that_is_not_loaded_is_written(self):
        add_knot(self.node)
        call = self.node.begin('relax', method='dynamics', tolerance=1e-30)
        outcome = relax_mesh(mesh=self.write('surface.obj', *self.surface), node=self.node.name,
                             output=self.path('sphere.obj'), load=True)
        self.node.cancel()
        call.result(LONG)
        self.assertEqual(2500, len(self.node.get_scene().particles))
        self.assertEqual((0, 'warning: %s: mapped, but not loaded: a ~relax is under way; wait for '
                          'it or end it by ~cancel' % self.node.name),
                         (outcome.code, outcome.error))
        vertices, faces = self.surface
        self.assert_is_map(faces, mesh.areas(vertices, faces), outcome)

    def test_a_node_that_ends(self):
        with NodeProcess(running=False) as node:
            node.client()
            process = self.begin(node=node.name, **FOR_EVER)
            while 'spread' not in process.stderr.readline():
                pass
            node.kill()
            outcome = self.outcome(process)
            self.assertEqual((1, 'error: %s has ended' % node.name), (outcome.code, outcome.error))
            self.assertEqual(['surface.obj'], os.listdir(self.directory))

    def test_a_second_signal_ends_it_at_once(self):
        node = HangingNode('/hanging')
        process = self.begin(node='/hanging')
        wait_until(lambda: node.goals)
        process.send_signal(signal.SIGINT)
        wait_until(lambda: node.cancels)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(-signal.SIGTERM, process.wait(LONG))

    def test_an_answer_that_is_no_map(self):
        node = HangingNode('/lying')
        process = self.begin(node='/lying')
        goal = wait_until(lambda: node.goals)[0]
        wait_until(node.is_heard)
        sphere = goal.get_goal().mesh.vertices
        goal.set_succeeded(MapMeshResult(success=True, sphere=sphere[:-1]))
        outcome = self.outcome(process)
        self.assertEqual((1, 'error: /lying has answered no map'), (outcome.code, outcome.error))


class TestShortMemory(MeshTest):
    SAID = ('warning: there is not enough memory to improve the map further; the best so far has '
            'been written')

    def limited_after(self, seconds):
        """The outcome, and its lines of errors, of a command that may take no more memory when it
        has worked so long, until there is a map."""
        # Without a heap of its own all but the smallest pieces of memory count at once.
        environment = {**os.environ, 'MALLOC_MMAP_THRESHOLD_': '4096'}
        process = subprocess.Popen(
            command(mesh=self.path('surface.obj'), density=self.path('densities.txt'),
                    output=self.path('sphere.obj')),
            env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

        def limit(size):
            resource.prlimit(process.pid, resource.RLIMIT_AS, (size, resource.RLIM_INFINITY))

        def has_worked():
            with open('/proc/%d/stat' % process.pid) as stat:
                fields = stat.read().rpartition(')')[2].split()
            return sum(map(int, fields[11:13])) > seconds * os.sysconf('SC_CLK_TCK')

        wait_until(has_worked)
        with open('/proc/%d/statm' % process.pid) as statm:
            limit(int(statm.read().split()[0]) * resource.getpagesize())
        wait_until(lambda: os.path.exists(self.path('sphere.obj')) or process.poll() is not None)
        if process.poll() is None:
            limit(resource.RLIM_INFINITY)
        process.stdout, process.stderr = process.communicate(timeout=4 * LONG)
        return Outcome(process)

    def test_the_best_map_so_far_is_written(self):
        vertices, faces = bumpy(4)
        self.write('surface.obj', vertices, faces)
        densities = np.exp(np.random.default_rng(1).uniform(-3, 3, len(faces)))
        np.savetxt(self.path('densities.txt'), densities)
        for seconds in (1, 2, 4, 8):
            outcome = self.limited_after(seconds)
            if outcome.code == 0:
                break
            self.assertEqual('error: there is not enough memory', outcome.error)  # nor a map yet
        self.assertEqual(0, outcome.code, outcome.error)
        self.assertIn(self.SAID, outcome.error.splitlines())
        self.assert_is_map(faces, mesh.areas(vertices, faces) * densities, outcome)


class TestLaunchFile(MeshTest):
    def test_it_ends_when_the_files_are_written(self):
        self.directory = self.path("Anna's scans")
        os.mkdir(self.directory)
        vertices, faces = bumpy(2)
        self.write('left hand.obj', vertices, faces)
        environment = {name: value for name, value in os.environ.items() if name != 'PWD'}
        ended = subprocess.run(
            ['roslaunch', PACKAGE, 'mesh.launch', 'mesh:=./left hand.obj', 'uv:=uv of it.obj',
             'name:=springs_of_mesh'],
            cwd=self.directory, env=environment, timeout=4 * LONG,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(0, ended.returncode, ended.stdout)
        self.assertNotIn('REQUIRED', ended.stdout)
        self.assertIn('wrote ./left hand_sphere.obj, uv of it.obj', ended.stdout)
        self.assertEqual({'left hand.obj', 'left hand_sphere.obj', 'uv of it.obj'},
                         set(os.listdir(self.directory)), ended.stdout)
        sphere, same_faces = mesh.read_obj(self.path('left hand_sphere.obj'))
        np.testing.assert_array_equal(faces, same_faces)
        self.assertGreater(mesh.solid_angles(sphere, faces).min(), 0)
