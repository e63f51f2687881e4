"""Services, timers, topics, relaxations and cancels at once, from several clients.

scripts/thread_sanitizer runs it with a node built for ThreadSanitizer, whose exit code then tells
of data races.
"""

import random
import tempfile
import threading
import unittest

import rospy
from geometry_msgs.msg import PoseArray
from spherical_springs.msg import Energies, Status

from node_client import NodeProcess, Refused
from scenes import add_random_scene, angle_spring, particle

CLIENTS = 5
CALLS = 60


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
    lambda node: node.step(0),
    lambda node: node.step(20),
    lambda node: node.relax(max_time=0.1),
    lambda node: node.relax(max_time=0.1, method='dynamics', tolerance=1e-30),
    lambda node: node.cancel(),
]


class TestConcurrency(unittest.TestCase):
    def test_every_call_is_answered(self):
        faults = []

        def keep_calling(node, seed):
            choice = random.Random(seed)
            for _ in range(CALLS):
                try:
                    choice.choice(REQUESTS)(node)
                except Refused:
                    pass
                except (rospy.ServiceException, rospy.ROSException) as fault:
                    faults.append(fault)

        with tempfile.TemporaryDirectory() as directory, \
                NodeProcess(scene_directory=directory, threads=3, publish_rate=200) as process:
            node = process.client()
            # Loops over so many springs are shared among threads.
            add_random_scene(node, seed=1, particles=100, springs=5000)
            node.save_scene('scene.json')
            clients = [threading.Thread(target=keep_calling, args=(node, seed))
                       for seed in range(CLIENTS)]
            for client in clients:
                client.start()
            while any(client.is_alive() for client in clients):
                # Listeners come and go.
                with node.listen('poses', PoseArray) as poses, \
                        node.listen('energies', Energies) as samples, \
                        node.listen('status', Status) as statuses:
                    for listener in (poses, samples, statuses):
                        listener.first()
            for client in clients:
                client.join()
            self.assertEqual([], faults)
            self.assertEqual(0, process.stop(), process.output())
