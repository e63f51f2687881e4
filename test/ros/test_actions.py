"""The actions ~relax and ~step, which do what the services of these names do."""

import math
import unittest

import numpy as np
from actionlib_msgs.msg import GoalStatus
from spherical_springs.msg import (
    RelaxAction, RelaxGoal, RelaxResult, StepAction, StepGoal, StepResult)

from action_client import ActionClient
from node_client import LONG, NodeProcess, NodeTest, Refused, wait_until
from scenes import add_knot, add_octant, add_random_scene, exact, positions

RELAXING_FOR_EVER = RelaxGoal(method='dynamics', tolerance=1e-30)
STEPPING_FOR_EVER = StepGoal(steps=4294967295)


class ActionTest(NodeTest):
    def setUp(self):
        super().setUp()
        self.relax = ActionClient(self.node, 'relax', RelaxAction)
        self.step = ActionClient(self.node, 'step', StepAction)
        self.addCleanup(self.node.cancel)

    def succeeded(self, client, goal):
        state, text, result = client.outcome(goal)
        self.assertEqual(GoalStatus.SUCCEEDED, state, text)
        self.assertTrue(result.success)
        self.assertEqual(text, result.message)
        return result

    def preempted(self, client):
        state, text, result = client.ended()
        self.assertEqual(GoalStatus.PREEMPTED, state, text)
        self.assertTrue(result.success)
        self.assertIn('cancelled', result.message)
        self.assertEqual(text, result.message)
        return result

    def assert_refused(self, client, goal, words):
        """A refused goal changes nothing, and its text is its message."""
        before = self.node.get_scene()
        state, text, result = client.outcome(goal)
        self.assertEqual(GoalStatus.REJECTED, state, text)
        self.assertEqual(text, result.message)
        self.assertEqual(words, text)
        empty = RelaxResult() if client is self.relax else StepResult()
        empty.message = text
        self.assertEqual(empty, result)
        return before

    def refusal(self, service, **fields):
        with self.assertRaises(Refused) as refusal:
            getattr(self.node, service)(**fields)
        return str(refusal.exception)


class TestGoals(ActionTest):
    def test_a_relaxation_is_that_of_the_service(self):
        add_random_scene(self.node, seed=3)
        response = self.node.relax()
        after = exact(self.node.get_scene())
        self.node.reset()
        result = self.succeeded(self.relax, RelaxGoal())
        self.assertEqual(after, exact(self.node.get_scene()))
        for field in ('message', 'converged', 'iterations', 'energy_before', 'energy_after',
                      'max_torque'):
            self.assertEqual(getattr(response, field), getattr(result, field))

    def test_steps_are_those_of_the_service(self):
        add_random_scene(self.node, seed=4)
        response = self.node.step(steps=100)
        after = exact(self.node.get_scene())
        self.node.reset()
        result = self.succeeded(self.step, StepGoal(steps=100))
        self.assertEqual(after, exact(self.node.get_scene()))
        for field in ('message', 'steps', 'time'):
            self.assertEqual(getattr(response, field), getattr(result, field))
        self.assertEqual(response.energies.total, result.energies.total)
        self.assertEqual('map', result.energies.header.frame_id)
        self.assertEqual(50, self.succeeded(self.step, StepGoal(duration=0.05)).steps)

    def test_no_steps_only_report_even_while_it_runs(self):
        add_octant(self.node, damping=0)
        self.node.set_running(True)
        result = self.succeeded(self.step, StepGoal())
        self.assertEqual(0, result.steps)
        self.assertGreater(result.energies.potential, 0)

    def test_goals_of_many_clients_are_answered_one_by_one(self):
        add_octant(self.node, damping=0)
        clients = [ActionClient(self.node, 'step', StepAction) for _ in range(4)]
        for client in clients:
            client.send_goal(StepGoal(steps=20000))
        states = [client.ended()[0] for client in clients]
        done = states.count(GoalStatus.SUCCEEDED)
        self.assertGreater(done, 0)
        self.assertEqual(len(clients) - done, states.count(GoalStatus.REJECTED))
        self.assertAlmostEqual(20 * done, self.node.get_scene().time, delta=1e-6)


class TestRefusals(ActionTest):
    def test_bad_goals(self):
        add_octant(self.node, damping=0.5)
        for client, goals in ((self.relax, ({'method': 'magic'}, {'tolerance': math.nan},
                                            {'max_time': -2})),
                              (self.step, ({'steps': 3, 'duration': 1}, {'duration': -1}))):
            service, goal = (('relax', RelaxGoal) if client is self.relax else ('step', StepGoal))
            for fields in goals:
                words = self.refusal(service, **fields)
                before = self.assert_refused(client, goal(**fields), words)
                self.assertEqual(exact(before), exact(self.node.get_scene()))

    def test_steps_while_time_goes_on(self):
        self.node.set_running(True)
        self.assert_refused(self.step, StepGoal(steps=1), self.refusal('step', steps=1))

    def test_goals_while_a_service_is_at_work(self):
        add_knot(self.node)
        call = self.node.begin('relax', method='dynamics', tolerance=1e-30)
        self.addCleanup(call.result, LONG)
        self.addCleanup(self.node.cancel)
        words = wait_until(self.words_while_busy)
        self.assertIn('~relax is under way', words)
        self.assert_refused(self.relax, RelaxGoal(), words)
        self.assert_refused(self.step, StepGoal(steps=1), words)

    def words_while_busy(self):
        try:
            self.node.set_running(False)
        except Refused as refusal:
            return str(refusal)
        return None

    def test_services_and_goals_while_a_goal_is_at_work(self):
        add_knot(self.node)
        for client, goal, words in ((self.relax, RELAXING_FOR_EVER, '~relax is under way'),
                                    (self.step, STEPPING_FOR_EVER, '~step is under way')):
            client.begin(goal)
            for service, fields in (('relax', {}), ('step', {'steps': 1}), ('clear', {}),
                                    ('set_running', {'data': True})):
                self.assertIn(words, self.refusal(service, **fields))
            reason = self.refusal('clear')
            self.assert_refused(ActionClient(self.node, 'relax', RelaxAction), RelaxGoal(), reason)
            self.assert_refused(ActionClient(self.node, 'step', StepAction), StepGoal(steps=1),
                                reason)
            self.assertEqual(GoalStatus.ACTIVE, client.get_state())
            client.cancel_goal()
            self.preempted(client)

    def assert_refused(self, client, goal, words):
        if client not in (self.relax, self.step):  # one of its own
            state, text, result = client.outcome(goal)
            self.assertEqual((GoalStatus.REJECTED, words, words, False),
                             (state, text, result.message, result.success))
            return None
        return super().assert_refused(client, goal, words)


class TestLongGoals(ActionTest):
    def setUp(self):
        super().setUp()
        add_knot(self.node)
        self.before = self.node.get_scene()

    def test_feedback_of_a_relaxation(self):
        self.relax.begin(RELAXING_FOR_EVER)
        wait_until(lambda: len(self.relax.feedback) >= 5)
        feedback = list(self.relax.feedback)
        self.relax.cancel_goal()
        result = self.preempted(self.relax)
        self.assertLess(0, feedback[0].iterations)
        for earlier, later in zip(feedback, feedback[1:]):
            self.assertLess(earlier.iterations, later.iterations)
            self.assertGreaterEqual(earlier.energy, later.energy)
            self.assertGreater(later.wall_time, earlier.wall_time + 0.09)  # at most 10 Hz
        for message in feedback:
            self.assertTrue(0 <= message.progress <= 1, message)
            self.assertGreater(message.max_torque, 0)
        self.assertGreaterEqual(feedback[-1].energy, result.energy_after)
        self.assertGreaterEqual(result.wall_time, feedback[-1].wall_time)

    def test_feedback_of_steps(self):
        self.step.begin(STEPPING_FOR_EVER)
        wait_until(lambda: len(self.step.feedback) >= 5)
        feedback = list(self.step.feedback)
        self.step.cancel_goal()
        result = self.preempted(self.step)
        for earlier, later in zip(feedback, feedback[1:]):
            self.assertLess(earlier.steps, later.steps)
        for message in feedback:
            self.assertAlmostEqual(1e-3 * message.steps, message.time, delta=1e-9)
            self.assertGreater(message.real_time_factor, 0)
        self.assertGreaterEqual(result.steps, feedback[-1].steps)

    def test_a_preempted_relaxation_keeps_its_best_state(self):
        self.relax.begin(RELAXING_FOR_EVER)
        wait_until(lambda: self.relax.feedback)
        self.relax.cancel_goal()
        result = self.preempted(self.relax)
        self.assertFalse(result.converged)
        self.assertLess(result.energy_after, result.energy_before)
        report = self.node.step(steps=0).energies
        self.assertAlmostEqual(result.energy_after, report.potential,
                               delta=1e-9 * result.energy_before)
        self.assertEqual(0, report.kinetic)
        self.assertGreater(
            np.abs(positions(self.node.get_scene()) - positions(self.before)).max(), 1e-3)

    def test_preempted_steps_say_how_many_were_done(self):
        self.step.begin(STEPPING_FOR_EVER)
        wait_until(lambda: self.step.feedback)
        self.step.cancel_goal()
        result = self.preempted(self.step)
        self.assertIn('after %d steps of 4294967295' % result.steps, result.message)
        self.assertEqual(result.time, self.node.get_scene().time)
        self.assertAlmostEqual(1e-3 * result.steps, result.time, delta=1e-9)

    def test_the_service_cancel_ends_goals(self):
        for client, goal in ((self.relax, RELAXING_FOR_EVER), (self.step, STEPPING_FOR_EVER)):
            client.begin(goal)
            self.assertEqual('cancelling', self.node.cancel().message)
            self.preempted(client)
            self.assertIn('nothing', self.node.cancel().message)

    def test_a_goal_that_has_ended_cancels_nothing(self):
        self.succeeded(self.step, StepGoal(steps=1))
        call = self.node.begin('relax', method='dynamics', tolerance=1e-30, max_time=1)
        self.step.cancel_goal()
        self.step.cancel_all_goals()
        self.assertIn('max_time', call.result(LONG).message)


class TestEnd(unittest.TestCase):
    def test_the_node_ends_amid_a_goal(self):
        for name, action, goal in (('relax', RelaxAction, RELAXING_FOR_EVER),
                                   ('step', StepAction, STEPPING_FOR_EVER)):
            with NodeProcess(running='false') as process:
                node = process.client()
                add_knot(node)
                ActionClient(node, name, action).begin(goal)
                self.assertEqual(0, process.stop(), process.output())
