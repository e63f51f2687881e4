"""Parameters that change amid long calls, under load and from several clients at once."""

import random
import threading

from node_client import Refused, wait_until
from reconfiguring import ReconfigurationTest
from scenes import add_knot, add_random_scene, exact

ROUNDS = 40


class TestLongCalls(ReconfigurationTest):
    def begin(self, service, **fields):
        self.start(running='false')
        add_knot(self.node)
        self.call = self.node.begin(service, **fields)
        self.addCleanup(self.node.cancel)

    def test_steps_under_way_end_as_they_began(self):
        self.begin('step', steps=4294967295)
        self.status(lambda s: s.state == 'running')
        reason = 'a ~step is under way; wait for it or end it by ~cancel'
        self.assert_refuses(reason, time_step=0.5)
        self.assert_refuses(reason, integrator='euler')
        self.assert_refuses(reason, running=True)
        self.assert_refuses(reason, publish_rate=5, time_step=0.5)
        self.reconfigure(publish_rate=5, real_time_factor=2)
        self.assert_holds(publish_rate=5.0, real_time_factor=2.0, running=False)
        self.node.cancel()
        response = self.call.result()
        self.assertAlmostEqual(0.001 * response.steps, response.time, delta=1e-9 * response.time)
        self.reconfigure(time_step=0.5)
        self.assert_holds(publish_rate=5.0, real_time_factor=2.0, running=False, time_step=0.5)

    def test_a_relaxation_goes_on(self):
        self.begin('relax', method='dynamics', tolerance=1e-30)
        self.status(lambda s: s.state == 'relaxing')
        self.assert_refuses('a ~relax is under way', running=True)
        self.assert_refuses('a ~relax is under way', running=True, time_step=0.5)
        self.reconfigure(time_step=0.25, integrator='euler')
        self.assert_holds(time_step=0.25, integrator='euler', running=False)
        self.assertEqual('relaxing', self.status().state)
        self.node.cancel()
        self.assertFalse(self.call.result().converged)
        time = self.node.get_scene().time
        self.assertAlmostEqual(time + 0.25, self.node.step(steps=1).time)


class TestManyClients(ReconfigurationTest):
    def together(self, *clients):
        """Run each on a thread of its own; return when all have ended, without a fault."""
        faults = []

        def run(client):
            try:
                client()
            except Exception as fault:  # which a thread would keep to itself
                faults.append(fault)

        threads = [threading.Thread(target=run, args=(client,)) for client in clients]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([], faults)

    def test_no_change_undoes_that_of_another_client(self):
        self.start()
        add_random_scene(self.node, seed=1, particles=1000, springs=1000)
        first, second = self.another_client(), self.another_client()

        def change_steps():
            for i in range(ROUNDS):
                time_step = 1e-4 * (1 + i % 7)
                self.assertEqual(time_step, first(time_step=time_step)['time_step'])
            first(time_step=0.002)

        def change_rates():
            for i in range(ROUNDS):
                rate = 20.0 + i % 5
                self.assertEqual(rate, second(publish_rate=rate, real_time_factor=rate / 50)
                                 ['publish_rate'])
            second(integrator='fourth_order')

        def pause_and_go():
            for _ in range(ROUNDS):
                self.node.set_running(True)
                self.node.set_running(False)

        self.together(change_steps, change_rates, pause_and_go)
        rate = 20.0 + (ROUNDS - 1) % 5
        self.assert_holds(time_step=0.002, publish_rate=rate, real_time_factor=rate / 50,
                          integrator='fourth_order', running=False)
        self.status(lambda s: s.state == 'paused')
        standing = exact(self.node.get_scene())
        self.status()
        self.assertEqual(standing, exact(self.node.get_scene()))

    def test_beside_every_other_call(self):
        self.start(threads=2)
        add_random_scene(self.node, seed=1, particles=100, springs=100)

        def call(seed):
            choice = random.Random(seed)
            requests = [
                lambda: self.node.set_running(choice.random() < 0.5), self.node.reset,
                lambda: self.node.step(steps=20), lambda: self.node.step(duration=0.01),
                lambda: self.node.relax(max_time=0.05), self.node.cancel, self.node.get_scene]
            for _ in range(ROUNDS):
                try:
                    choice.choice(requests)()
                except Refused:
                    pass

        def reconfigure(seed):
            choice, client = random.Random(seed), self.another_client()
            for _ in range(ROUNDS):
                client(time_step=choice.choice((1e-3, 1e-4, -1.0)), running=choice.random() < 0.5,
                       integrator=choice.choice(('verlet', 'euler', 'implicit_euler', 'none')))

        self.together(lambda: call(1), lambda: call(2), lambda: reconfigure(3),
                      lambda: reconfigure(4))
        wait_until(self.is_idle)
        self.reconfigure(time_step=0.01, integrator='euler', running=True)
        self.assert_holds(time_step=0.01, integrator='euler')
        self.assertEqual(0, self.process.stop(), self.process.output())

    def is_idle(self):
        try:
            self.node.set_running(False)
        except Refused:
            return False
        return True
