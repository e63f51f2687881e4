"""relax_mesh as a client of the node: the scene, other clients, progress, interruption, launch."""

import os
import pty
import resource
import select
import signal
import subprocess
import threading

import numpy as np
import rospy
from spherical_springs.msg import Status
from spherical_springs.srv import (
    AddParticles, AddParticlesResponse, AddSprings, GetScene, Relax, RelaxResponse)
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse

from mesh_test import MeshTest
from node_client import LONG, PACKAGE, wait_until
from relax_mesh import Outcome, command, relax_mesh
from scenes import particle
from shapes import bumpy, mesh


class EndlessNode:
    """Stands for a node whose relaxation ends only when it is cancelled, and whose scene is then
    empty. With `failing`, its relaxation ends without an answer."""

    def __init__(self, name):
        self.failing = False
        self.persistent = []  # of each call, whether its connection is to stay after the answer
        self.relaxing, self.cancelled = threading.Event(), threading.Event()

        def noting(answer):
            def note(request):
                self.persistent.append(request._connection_header.get('persistent') == '1')
                return answer(request)
            return note

        self.services = [rospy.Service(name + '/' + service, kind, noting(answer))
                         for service, kind, answer in (
            ('set_running', SetBool, lambda _: SetBoolResponse(success=True)),
            ('clear', Trigger, lambda _: TriggerResponse(success=True)),
            ('add_particles', AddParticles, lambda request: AddParticlesResponse(
                success=True, ids=range(len(request.particles)))),
            ('add_springs', AddSprings, lambda _: {'success': True}),
            ('get_scene', GetScene, lambda _: {'success': True}),
            ('relax', Relax, self.relax),
            ('cancel', Trigger, self.cancel))]
        self.status = rospy.Publisher(name + '/status', Status, queue_size=1, latch=True)
        self.status.publish(state='paused', relax_progress=0.99)  # of an earlier relaxation

    def relax(self, _):
        self.relaxing.set()
        cancelled = self.cancelled.wait(2 * LONG)
        return None if self.failing else RelaxResponse(success=cancelled)

    def cancel(self, _):
        self.cancelled.set()
        return TriggerResponse(success=True)

    def shutdown(self):
        self.status.unregister()
        for service in self.services:
            service.shutdown()


UNRELAXED = '; the map has been written, but springs have not relaxed it'


class TestInterruption(MeshTest):
    def test_relaxation_is_cancelled_and_the_map_written(self):
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        surface = self.write('surface.obj', *bumpy(1))
        for which, node.failing in ((signal.SIGINT, False), (signal.SIGTERM, False),
                                    (signal.SIGINT, True)):  # which Ctrl-C may end as well
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
            if node.failing:  # of which roscpp writes a line, too
                error = error.splitlines(True)[-1]
            self.assertEqual((1, 'error: interrupted' + UNRELAXED + '\n'),
                             (process.returncode, error))
            self.assertEqual({'surface.obj', 'sphere.obj', 'uv.obj'},
                             set(os.listdir(self.directory)))
            os.remove(self.path('sphere.obj'))


class TestOtherClients(MeshTest):
    def test_who_changes_the_scene_meanwhile_is_noticed(self):
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        node.cancelled.set()
        outcome = relax_mesh(mesh=self.write('surface.obj', *bumpy(1)), node='/endless',
                             output=self.path('sphere.obj'))
        self.assertEqual((0, 'warning: another client has changed the scene of /endless meanwhile; '
                          'relax_mesh needs a node to itself' + UNRELAXED),
                         (outcome.code, outcome.error))
        self.assertEqual({'surface.obj', 'sphere.obj'}, set(os.listdir(self.directory)))

    def test_a_relaxation_that_does_not_answer_loses_no_map(self):
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        node.failing = True
        node.cancelled.set()
        outcome = relax_mesh(mesh=self.write('surface.obj', *bumpy(1)), node='/endless',
                             output=self.path('sphere.obj'))
        self.assertEqual((0, 'warning: /endless/relax does not answer' + UNRELAXED),
                         (outcome.code, outcome.error.splitlines()[-1]))
        self.assertEqual({'surface.obj', 'sphere.obj'}, set(os.listdir(self.directory)))

    def test_connections_stay_until_the_answer_is_there(self):
        # roscpp may lose an answer after which the other side hangs up (ros_comm, issue 1976).
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        node.cancelled.set()
        relax_mesh(mesh=self.write('surface.obj', *bumpy(1)), node='/endless',
                   output=self.path('sphere.obj'))
        self.assertGreater(len(node.persistent), 5)
        self.assertNotIn(False, node.persistent)


class TestProgress(MeshTest):
    def test_a_terminal_shows_how_far_it_has_come(self):
        node = EndlessNode('/endless')
        self.addCleanup(node.shutdown)
        terminal, its_other_end = pty.openpty()
        self.addCleanup(os.close, terminal)
        process = subprocess.Popen(
            command(mesh=self.write('surface.obj', *bumpy(1)), output=self.path('sphere.obj'),
                    node='/endless'), stdout=subprocess.DEVNULL, stderr=its_other_end)
        os.close(its_other_end)
        self.assertTrue(node.relaxing.wait(LONG))
        node.status.publish(state='relaxing', relax_progress=0.43)
        shown = ''

        def read_until(text):
            nonlocal shown
            while text not in shown:
                self.assertTrue(select.select([terminal], [], [], LONG)[0], shown)
                shown += os.read(terminal, 1000).decode()

        read_until('relaxing ... 43 %')
        self.assertNotIn('relaxing ... 99 %', shown)
        self.assertRegex(shown, r'mapping \.\.\. \d+ %\r\x1b\[K')
        process.send_signal(signal.SIGINT)
        read_until('not relaxed it')
        self.assertIn('43 %\r\x1b[Kerror: interrupted', shown)
        process.wait(LONG)


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


class TestNode(MeshTest):
    def test_scene_is_replaced_and_says_so(self):
        self.node.add_particles([particle((1, 0, 0)), particle((0, 1, 0))])
        self.node.set_running(True)
        vertices, faces = bumpy(1)
        outcome = self.run_to_success(mesh=self.write('surface.obj', vertices, faces))
        # The two lines of figures stand together, before the words of the node.
        self.assertRegex(outcome.output, r'^before: .*\nafter: .*\n'
                         r'(/\S+): removed 2 particles and 0 springs\n\1: .+\n$')
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
        environment = {name: value for name, value in os.environ.items() if name != 'PWD'}
        ended = subprocess.run(
            ['roslaunch', PACKAGE, 'mesh.launch', 'mesh:=./left hand.obj', 'uv:=uv of it.obj',
             'name:=springs_of_mesh'],
            cwd=self.directory, env=environment, timeout=4 * LONG,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual({'left hand.obj', 'left hand_sphere.obj', 'uv of it.obj'},
                         set(os.listdir(self.directory)), ended.stdout)
        sphere, same_faces = mesh.read_obj(self.path('left hand_sphere.obj'))
        np.testing.assert_array_equal(faces, same_faces)
        self.assertGreater(mesh.solid_angles(sphere, faces).min(), 0)
