"""The same scene and steps give the same bits, whatever publishes, listens or calls beside."""

import tempfile
import threading
import unittest

from geometry_msgs.msg import PoseArray
from spherical_springs.msg import Energies, Status

from node_client import NodeProcess, Refused, wait_until
from scenes import add_random_scene, exact, particle

STEPS = 1500


class TestDeterminism(unittest.TestCase):
    def scene_after(self, bring_there, **parameters):
        """The scene, to the last bit, and the energies where bring_there(node) has brought it."""
        with tempfile.TemporaryDirectory() as directory:
            with NodeProcess(scene_directory=directory, running='false', **parameters) as process:
                node = process.client()
                add_random_scene(node, seed=8, particles=300, springs=400)
                bring_there(node)
                energies = node.step(steps=0).energies
                return exact(node.get_scene()), energies.total, energies.dissipated

    @classmethod
    def setUpClass(cls):
        cls.in_peace = cls().scene_after(lambda node: node.step(steps=STEPS))

    def test_under_all_that_may_go_on_beside(self):
        def step_amid_calls(node):
            calls = {'reads': 0, 'saves': 0, 'refusals': 0}
            steps = node.begin('step', steps=STEPS)

            def keep_reading():
                while not steps.done():
                    node.get_scene()
                    node.step(steps=0)
                    calls['reads'] += 1

            def keep_saving():
                while not steps.done():
                    node.save_scene('beside.json')
                    calls['saves'] += 1

            def keep_being_refused():
                while not steps.done():
                    try:
                        node.add_particles([particle((0, 0, 0))])
                    except Refused:
                        calls['refusals'] += 1

            threads = [threading.Thread(target=target)
                       for target in (keep_reading, keep_saving, keep_being_refused)]
            with node.listen('poses', PoseArray) as poses, \
                    node.listen('energies', Energies), node.listen('status', Status):
                for thread in threads:
                    thread.start()
                for thread in threads:
                    thread.join()
                self.assertEqual(300, len(poses.first().poses))
            self.assertGreater(min(calls.values()), 0, calls)

        self.assertEqual(self.in_peace, self.scene_after(step_amid_calls, publish_rate=1000))

    def test_of_steps_in_any_portions(self):
        def step_in_portions(node):
            for steps in (1, 2, 497, 1000):
                node.step(steps=steps)

        self.assertEqual(self.in_peace, self.scene_after(step_in_portions))

    def test_of_steps_that_the_timer_made(self):
        def run_then_step_the_rest(node):
            node.set_running(True)
            wait_until(lambda: node.get_scene().time > 0.2)
            node.set_running(False)
            done = round(node.get_scene().time * 1000)
            self.assertLess(done, STEPS)
            node.step(steps=STEPS - done)

        # Slowly, so that not all of them are made before the node is told to stop.
        self.assertEqual(self.in_peace,
                         self.scene_after(run_then_step_the_rest, real_time_factor=0.1))
