"""The action ~map_mesh."""

import math
import unittest

import numpy as np
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point
from shape_msgs.msg import Mesh, MeshTriangle
from spherical_springs.msg import MapMeshAction, MapMeshGoal

from action_client import ActionClient
from node_client import NodeProcess, NodeTest, Refused, wait_until
from scenes import add_knot, add_octant, exact, positions, solid_angles
from shapes import bumpy, mesh

BUMPY = bumpy(2)


def points(vertices):
    return [Point(*vertex) for vertex in vertices]


def goal(surface=BUMPY, **fields):
    vertices, faces = surface
    return MapMeshGoal(mesh=Mesh([MeshTriangle(list(face)) for face in faces], points(vertices)),
                       **fields)


def for_ever(**fields):
    return goal(bumpy(3), spread=1e-300, max_time=1e6, **fields)


def sphere_of(result):
    return np.array([(p.x, p.y, p.z) for p in result.sphere])


class MapTest(NodeTest):
    def setUp(self):
        super().setUp()
        self.map = ActionClient(self.node, 'map_mesh', MapMeshAction)
        self.addCleanup(self.node.cancel)

    def assert_map(self, surface, result, shares=None):
        """Check the map by itself, and what is said of it."""
        vertices, faces = surface
        shares = mesh.areas(vertices, faces) if shares is None else shares
        sphere = sphere_of(result)
        self.assertEqual(vertices.shape, sphere.shape)
        np.testing.assert_allclose(np.linalg.norm(sphere, axis=1), 1, atol=1e-14)
        areas = solid_angles(*np.moveaxis(sphere[faces], 1, 0))
        self.assertGreater(areas.min(), 0)
        self.assertAlmostEqual(4 * np.pi, areas.sum(), delta=1e-9)
        ratios = np.log(areas / shares * shares.sum() / (4 * np.pi))
        self.assertAlmostEqual(ratios.std(), result.spread, delta=1e-9)
        self.assertAlmostEqual(np.abs(ratios).max(), result.worst, delta=1e-9)
        self.assertEqual(0, result.folded)
        self.assertLess(result.mean_angle, result.worst_angle)
        self.assertGreater(result.wall_time, 0)

    def succeeded(self, goal):
        state, text, result = self.map.outcome(goal)
        self.assertEqual(GoalStatus.SUCCEEDED, state, text)
        self.assertTrue(result.success)
        self.assertEqual(text, result.message)
        return result

    def assert_refused(self, goal, words, state=GoalStatus.REJECTED):
        before = exact(self.node.get_scene())
        client = ActionClient(self.node, 'map_mesh', MapMeshAction)
        ended, text, result = client.outcome(goal)
        self.assertEqual((state, False), (ended, result.success), text)
        self.assertEqual(text, result.message)
        self.assertIn(words, text)
        self.assertEqual(before, exact(self.node.get_scene()))
        return result

    def begin_and_find_a_map(self, goal):
        self.map.begin(goal)
        wait_until(lambda: any(feedback.spread > 0 for feedback in self.map.feedback))

    def preempted(self):
        state, text, result = self.map.ended()
        self.assertEqual((GoalStatus.PREEMPTED, True), (state, result.success), text)
        self.assertIn('cancelled; best map so far', text)
        self.assertEqual(text, result.message)
        return result


class TestGoals(MapTest):
    def test_a_map_is_as_good_as_asked_for(self):
        add_octant(self.node, damping=0)
        before = exact(self.node.get_scene())
        for fields, most in (({}, 1e-3), ({'spread': 0.05}, 0.05)):
            result = self.succeeded(goal(**fields))
            self.assert_map(BUMPY, result)
            self.assertLessEqual(result.spread, most)
        self.assertGreater(result.spread, 1e-3)
        self.assertEqual(before, exact(self.node.get_scene()))

    def test_density_start_and_angle_weight(self):
        vertices, faces = BUMPY
        density = 1.0 + (vertices[faces].mean(axis=1)[:, 2] > 0)
        first = self.succeeded(goal(density=list(density)))
        self.assert_map(BUMPY, first, density * mesh.areas(*BUMPY))
        self.assertLess(first.spread, 1e-3)
        again = self.succeeded(goal(density=list(density), start=points(7 * sphere_of(first))))
        np.testing.assert_allclose(sphere_of(again), sphere_of(first), atol=1e-14)
        some_angles = self.succeeded(goal(angle_weight=1))
        self.assert_map(BUMPY, some_angles)
        self.assertGreater(some_angles.spread, 1e-3)
        self.assertLess(some_angles.mean_angle, self.succeeded(goal()).mean_angle)

    def test_time_ends_it(self):
        result = self.succeeded(goal(bumpy(3), spread=1e-300, max_time=0.5))
        self.assert_map(bumpy(3), result)
        self.assertIn('max_time is over; best map so far: spread ', result.message)

    def test_the_map_is_loaded_as_springs(self):
        add_octant(self.node, damping=0)
        vertices, faces = BUMPY
        result = self.succeeded(goal(load=True))
        self.assertIn('the map is the scene', result.message)
        scene = self.node.get_scene()
        np.testing.assert_allclose(positions(scene), sphere_of(result), atol=1e-15)
        self.assertEqual(list(range(len(vertices))), list(scene.particle_ids))
        self.assertEqual([tuple(face) for face in faces],
                         [spring.particles for spring in scene.solid_angle_springs])
        self.assertEqual(3 * len(faces) // 2, len(scene.angle_springs))
        shares = mesh.areas(vertices, faces)
        np.testing.assert_allclose(
            [spring.rest_solid_angle for spring in scene.solid_angle_springs],
            4 * np.pi * shares / shares.sum(), rtol=1e-12)
        self.assertLess(self.node.step(steps=0).energies.total, 1e-3 * len(faces))
        self.assertTrue(self.node.relax(keep_orientation=True).success)


class TestRefusals(MapTest):
    def test_bad_goals(self):
        add_octant(self.node, damping=0)
        vertices, faces = BUMPY
        wrong = faces.copy()
        wrong[3, 1] = 4000000000 % 2**31
        for bad, words in (
                (MapMeshGoal(), 'the number of faces is 0'),
                (goal((vertices, faces[1:])), 'mesh: the mesh is open: '),
                (goal((vertices, wrong)), 'mesh.triangles[3].vertex_indices[1] is '),
                (goal((vertices * (1, math.nan, 1), faces)), 'mesh.vertices[0].y is nan'),
                (goal(density=[1.0]), 'density has 1 items; allowed: none, or one a triangle'),
                (goal(density=len(faces) * [-1.0]), 'density[0] is -1; allowed: above 0'),
                (goal(start=points(vertices[1:])), 'start has 161 items; allowed: none, or'),
                (goal(start=points(0 * vertices)), 'vertex 0 of the start is zero'),
                (goal(spread=-1), 'spread is -1; allowed: 0 (meaning 1e-3) or more'),
                (goal(spread=math.inf), 'spread is inf; allowed: '),
                (goal(max_time=math.nan), 'max_time is nan; allowed: '),
                (goal(angle_weight=-0.1), 'angle_weight is -0.1; allowed: 0 to 1e6')):
            with self.subTest(words):
                self.assert_refused(bad, words)

    def test_too_little_room_to_load(self):
        for limits, words in (({'max_particles': 161}, 'needs 162 particles; allowed here, by '),
                              ({'max_springs': 799}, 'needs 800 springs; allowed here, by ')):
            with NodeProcess(running=False, **limits) as process:
                client = ActionClient(process.client(), 'map_mesh', MapMeshAction)
                state, text, result = client.outcome(goal(load=True))
                self.assertEqual((GoalStatus.REJECTED, False), (state, result.success))
                self.assertIn(words, text)
                self.assertEqual(GoalStatus.SUCCEEDED, client.outcome(goal())[0])

    def test_one_at_a_time_and_all_else_beside_it(self):
        self.begin_and_find_a_map(for_ever())
        self.assert_refused(goal(), 'a ~map_mesh is under way; wait for it or end it by ~cancel')
        add_octant(self.node, damping=0)
        self.assertEqual(3, self.node.step(steps=3).steps)
        self.assertTrue(self.node.relax().success)
        self.node.set_running(True)
        begin = self.node.get_scene().time
        wait_until(lambda: self.node.get_scene().time > begin + 0.1)
        self.node.set_running(False)
        self.assertEqual(GoalStatus.ACTIVE, self.map.get_state())
        self.map.cancel_goal()
        self.assert_map(bumpy(3), self.preempted())

    def test_a_map_that_cannot_be_loaded_is_not_lost(self):
        add_knot(self.node)
        call = self.node.begin('relax', method='dynamics', tolerance=1e-30)
        wait_until(self.is_busy)
        state, text, result = self.map.outcome(goal(load=True))
        self.assertEqual((GoalStatus.ABORTED, False), (state, result.success))
        self.assertEqual('mapped, but not loaded: a ~relax is under way; wait for it or end it by '
                         '~cancel', text)
        self.assert_map(BUMPY, result)
        self.node.cancel()
        call.result()
        self.assertEqual(2500, len(self.node.get_scene().particles))

    def is_busy(self):
        try:
            self.node.set_running(False)
        except Refused:
            return True
        return False


class TestLongGoals(MapTest):
    def test_feedback(self):
        self.begin_and_find_a_map(for_ever())
        wait_until(lambda: len(self.map.feedback) >= 8)
        self.map.cancel_goal()
        result = self.preempted()
        feedback = list(self.map.feedback)
        for earlier, later in zip(feedback, feedback[1:]):
            self.assertGreater(later.wall_time, earlier.wall_time + 0.09)  # at most 10 Hz
        for message in feedback:
            self.assertTrue(0 <= message.progress <= 1, message)
        first = next(message.spread for message in feedback if message.spread > 0)
        self.assertLess(feedback[-1].spread, first)
        self.assertLess(result.spread, 1.2 * feedback[-1].spread)
        self.assert_map(bumpy(3), result)

    def test_the_service_cancel_ends_it(self):
        self.begin_and_find_a_map(for_ever(load=True))
        self.assertEqual('cancelling', self.node.cancel().message)
        result = self.preempted()
        self.assert_map(bumpy(3), result)
        np.testing.assert_allclose(positions(self.node.get_scene()), sphere_of(result), atol=1e-15)
        self.assertIn('nothing', self.node.cancel().message)

    def test_cancelled_before_there_is_a_map(self):
        add_octant(self.node, damping=0)
        before = exact(self.node.get_scene())
        self.map.begin(goal(bumpy(5), load=True))
        self.map.cancel_goal()
        state, text, result = self.map.ended()
        self.assertEqual((GoalStatus.PREEMPTED, False), (state, result.success), text)
        self.assertEqual('cancelled before there was a map; nothing has changed', text)
        self.assertEqual([], result.sphere)
        self.assertEqual(before, exact(self.node.get_scene()))


class TestEnd(unittest.TestCase):
    def test_the_node_ends_amid_a_goal(self):
        with NodeProcess(running='false') as process:
            client = ActionClient(process.client(), 'map_mesh', MapMeshAction)
            client.begin(for_ever())
            self.assertEqual(0, process.stop(), process.output())
