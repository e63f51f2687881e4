"""Services, timers, topics, relaxations and cancels at once, from several clients.

scripts/thread_sanitizer runs it with a node built for ThreadSanitizer, whose exit code then tells
of data races.
"""

import contextlib
import random
import tempfile
import threading
import unittest

import rospy

from node_client import NodeProcess, Refused
from scenes import add_random_scene, angle_spring, particle

CLIENTS = 5
CALLS = 60
TOPICS = ('poses', 'energies', 'status', 'markers')


def change(node):
    ids = node.add_particles([particle((1, 2, 3)), particle((3, 2, 1))]).ids
    springs = node.add_springs(angle_springs=[angle_spring(ids, rest_angle=1)])
    node.set_particles(ids, [particle((0, 1, 0), (0, 0, 1))] * 2)
    node.set_springs(angle_spring_ids=springs.angle_spring_ids,
                     angle_springs=[angle_spring(ids, rest_angle=2)])
    node.remove_particles(ids)


REQUESTS = [
    change,
    lambda node: node.get_scene(),
    lambda node: node.save_scene('scene.json'),
    lambda node: node.load_scene('scene.json'),
    lambda node: node.reset(),
    lambda node: node.set_running(True),
    lambda node: node.set_running(False),
    lambda node: node.step(steps=0),
    lambda node: node.step(steps=20),
    lambda node: node.relax(max_time=0.1),
    lambda node: node.relax(max_time=0.1, method='dynamics', tolerance=1e-30),
    lambda node: node.cancel(),
]


class TestConcurrency(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.process = NodeProcess(scene_directory=directory.name, threads=3, publish_rate=200)
        self.addCleanup(self.process.__exit__)
        self.node = self.process.client()
        # Loops over so many springs are shared among threads.
        add_random_scene(self.node, seed=1, particles=100, springs=5000)
        self.node.save_scene('scene.json')

    def begin(self, keep_calling):
        """Clients, each a thread that calls as `keep_calling(choice)` does."""
        clients = [threading.Thread(target=keep_calling, args=(random.Random(seed),))
                   for seed in range(CLIENTS)]
        for client in clients:
            client.start()
        return clients

    def call(self, choice):
        try:
            choice.choice(REQUESTS)(self.node)
        except Refused:
            pass

    @contextlib.contextmanager
    def listeners(self):
        with contextlib.ExitStack() as stack:
            yield [stack.enter_context(self.node.listen(topic, rospy.AnyMsg)) for topic in TOPICS]

    def test_every_call_is_answered(self):
        faults = []

        def keep_calling(choice):
            for _ in range(CALLS):
                try:
                    self.call(choice)
                except (rospy.ServiceException, rospy.ROSException) as fault:
                    faults.append(fault)

        clients = self.begin(keep_calling)
        while any(client.is_alive() for client in clients):
            # They come and go.
            with self.listeners() as listeners:
                for listener in listeners:
                    listener.first()
        for client in clients:
            client.join()
        self.assertEqual([], faults)
        self.assertEqual(0, self.process.stop(), self.process.output())

    def test_an_end_amid_calls(self):
        def keep_calling(choice):
            while True:
                try:
                    self.call(choice)
                except (rospy.ServiceException, rospy.ROSException):
                    return  # the node has ended

        with self.listeners() as listeners:
            clients = self.begin(keep_calling)
            for listener in listeners:
                listener.first()
            self.assertEqual(0, self.process.stop(), self.process.output())
        for client in clients:
            client.join()
