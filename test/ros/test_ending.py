"""However and whenever a node ends, it does not hang, and every file is whole."""

import glob
import os
import random
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import rosgraph
import rospy
from spherical_springs.msg import Status
from spherical_springs.srv import SaveScene

from node_client import LONG, NodeProcess, Refused, service_address, wait_until
from scenes import add_knot, add_random_scene

RELAXING = ('relax', {'method': 'dynamics', 'tolerance': 1e-30})
STEPPING = ('step', {'steps': 4294967295})


def read(path):
    with open(path, 'rb') as file:
        return file.read()


class EndingTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name
        self.path = os.path.join(self.directory, 'scene.json')

    def start(self, **parameters):
        return NodeProcess(scene_directory=self.directory, **parameters)

    def parts(self):
        """Files that a save has begun."""
        return glob.glob(os.path.join(self.directory, '*.part*'))

    def save_old_and_new(self):
        """Two contents of the file; it now has the first, and a node with the second is started by
        begin_with_new()."""
        with self.start(running='false') as process:
            node = process.client()
            add_random_scene(node, seed=1, particles=3000, springs=3000)
            node.save_scene('scene.json')
            self.old = read(self.path)
            node.step(steps=1)
            node.save_scene('new.json')
        self.new = read(os.path.join(self.directory, 'new.json'))

    def begin_with_new(self):
        return self.start(running='false', scene='new.json')


def begin_saving(process):
    """Return when the node is about to answer to it."""
    service = process.name + '/save_scene'
    # ROS's own way to wait for a service looks three times a second.
    wait_until(lambda: service_address(rosgraph.get_master_uri(), service))

    def save():
        try:
            rospy.ServiceProxy(service, SaveScene)('scene.json')
        except rospy.ServiceException:
            pass  # the node has ended

    thread = threading.Thread(target=save)
    thread.start()
    return thread


class TestKilled(EndingTest):
    TIMES = 100

    def kill_while_saving(self, share):
        """Kill a node when it has written so much of the file; return whether it was at it."""
        process = self.begin_with_new()
        saving = begin_saving(process)

        def written():
            return any(os.path.getsize(part) >= share * len(self.new) for part in self.parts())

        while saving.is_alive():
            try:
                if written():
                    break
            except FileNotFoundError:
                break  # it has just got its name
        process.kill()
        saving.join()
        parts = self.parts()
        for part in parts:
            os.remove(part)
        return len(parts) > 0

    def test_in_the_middle_of_saving_loses_nothing(self):
        self.save_old_and_new()
        moments = random.Random(1)
        in_the_middle = 0
        for _ in range(3 * self.TIMES):
            in_the_middle += self.kill_while_saving(moments.random())
            content = read(self.path)
            self.assertIn(content, (self.old, self.new))
            if content == self.new:
                with open(self.path, 'wb') as file:
                    file.write(self.old)
            if in_the_middle == self.TIMES:
                break
        self.assertEqual(self.TIMES, in_the_middle)
        with self.start(scene='scene.json') as process:
            self.assertEqual(3000, len(process.client().get_scene().particles))


def interrupt(process):
    process.send_signal(signal.SIGINT)


def terminate(process):
    process.send_signal(signal.SIGTERM)


def rosnode_kill(process):
    subprocess.run(['rosnode', 'kill', process.name], check=True, timeout=LONG,
                   stdout=subprocess.DEVNULL)


WAYS = (interrupt, terminate, rosnode_kill)


class TestToldToEnd(EndingTest):
    def assert_ends(self, process):
        self.assertEqual(0, process.exit_code(), process.output())
        self.assertEqual([], self.parts())

    def test_while_it_saves(self):
        self.save_old_and_new()
        for way in WAYS:
            with self.begin_with_new() as process:
                saving = begin_saving(process)
                wait_until(lambda: self.parts() or not saving.is_alive())
                way(process)
                self.assert_ends(process)
                saving.join()
            self.assertIn(read(self.path), (self.old, self.new))

    def test_while_long_calls_come_in(self):
        for way in WAYS:
            with self.start(running='false') as process:
                node = process.client()
                add_knot(node, particles=300)
                callers = [threading.Thread(target=self.call_until_the_end, args=(node, call))
                           for call in (RELAXING, STEPPING, ('cancel', {})) for _ in range(2)]
                with node.listen('status', Status) as statuses:
                    for caller in callers:
                        caller.start()
                    statuses.first(lambda status: status.state == 'relaxing')
                    statuses.first(lambda status: status.state == 'running')
                    way(process)
                    self.assert_ends(process)
                for caller in callers:
                    caller.join()

    @staticmethod
    def call_until_the_end(node, call):
        service, fields = call
        while True:
            try:
                getattr(node, service)(**fields)
            except Refused:
                pass
            except (rospy.ServiceException, rospy.ROSException):
                return

    def test_while_it_starts(self):
        for milliseconds in range(0, 200, 8):
            for way in (interrupt, terminate):
                with self.start() as process:
                    time.sleep(milliseconds / 1000)  # the moment, not a wait for anything
                    way(process)
                    ended = process.exit_code()
                    # Before it has begun to listen to signals, they end it themselves.
                    self.assertIn(ended, (0, -signal.SIGINT, -signal.SIGTERM), process.output())
