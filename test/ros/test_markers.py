"""~markers, as RViz gets them."""

import subprocess
import threading

import numpy as np
import rospy
from geometry_msgs.msg import Vector3
from visualization_msgs.msg import Marker, MarkerArray

from node_client import LONG, NodeProcess, NodeTest
from scenes import add_octant, angle_spring, particle, positions, solid_angle_spring, vector

ALL = {'sphere', 'particles', 'arcs', 'triangles'}


def names(array):
    return {marker.ns for marker in array.markers}


def by_name(array):
    return {marker.ns: marker for marker in array.markers}


def points(marker):
    return np.array([vector(p) for p in marker.points])


class TestMarkers(NodeTest):
    def markers(self, node):
        with node.listen('markers', MarkerArray) as arrays:
            return by_name(arrays.first())

    def test_each_new_listener_gets_all_at_once(self):
        ids = add_octant(self.node, damping=0)
        self.node.add_springs(solid_angle_springs=[solid_angle_spring(ids, at_rest=True)])
        self.markers(self.node)
        markers = self.markers(self.node)
        self.assertEqual(ALL, set(markers))
        self.assertEqual({'map'}, {m.header.frame_id for m in markers.values()})
        self.assertLess(rospy.Time(0), markers['arcs'].header.stamp)
        np.testing.assert_array_equal(positions(self.node.get_scene()),
                                      points(markers['particles']))
        np.testing.assert_allclose(np.linalg.norm(points(markers['arcs']), axis=1), 1, rtol=1e-15)
        for marker in markers.values():
            self.assertEqual(1, marker.pose.orientation.w)
            self.assertEqual(Marker.ADD, marker.action)

    def test_arcs_alone_change_colour(self):
        add_octant(self.node, damping=0)
        with self.node.listen('markers', MarkerArray) as arrays:
            before = by_name(arrays.first())['arcs']
            spring_ids = self.node.get_scene().angle_spring_ids
            springs = self.node.get_scene().angle_springs
            springs[0].stiffness *= 2  # cannot be seen
            self.node.set_springs(angle_spring_ids=spring_ids, angle_springs=springs)
            springs[0].rest_angle = 0.1  # can be
            self.node.set_springs(angle_spring_ids=spring_ids, angle_springs=springs)
            recoloured = arrays.first(
                lambda a: 'arcs' in names(a) and by_name(a)['arcs'].colors != before.colors)
            self.assertEqual({'sphere', 'arcs'}, names(recoloured))
            self.assertEqual(before.points, by_name(recoloured)['arcs'].points)

    def test_only_what_changes_is_sent_again(self):
        add_octant(self.node, damping=0)
        pinned = self.node.add_particles(
            [particle((0, 0, -1), pinned=True), particle((0, 1, -1), pinned=True)]).ids
        self.node.remove_springs(self.node.get_scene().angle_spring_ids, [], [])
        self.node.add_springs(angle_springs=[angle_spring(pinned, rest_angle=1)])
        ids = self.node.get_scene().particle_ids
        with self.node.listen('markers', MarkerArray) as arrays:
            arrays.first()
            moving = self.node.get_scene().particles[:1]
            moving[0].angular_velocity = Vector3(0.1, 0.2, 0.3)
            self.node.set_particles(ids[:1], moving)
            self.node.set_running(True)
            # The second may hold what a listener of the test before, not yet gone, has missed.
            sent = [names(array) for array in arrays.several(12)[2:]]
            self.assertGreater(sent.count({'sphere', 'particles'}), 7, sent)

    def test_only_all_are_sent_while_nothing_changes(self):
        add_octant(self.node, damping=0)
        with self.node.listen('markers', MarkerArray) as arrays:
            with self.node.listen('poses', rospy.AnyMsg) as poses:
                arrays.first()
                poses.several(30)
            for array in arrays.all():
                self.assertEqual(ALL, names(array) | {'triangles'})
            self.assertLess(len(arrays.all()), 10)

    def test_all_are_sent_again_for_those_who_have_lost_them(self):
        add_octant(self.node, damping=0)
        with self.node.listen('markers', MarkerArray) as arrays:
            first, *again = arrays.several(4)
        for array in again:
            self.assertEqual(names(first), names(array))
            self.assertEqual(by_name(first)['arcs'].points, by_name(array)['arcs'].points)

    def test_all_are_sent_again_where_the_rate_is_low(self):
        with NodeProcess(running='false', publish_rate=0.001) as process:
            node = process.client()
            add_octant(node, damping=0)
            with node.listen('markers', MarkerArray) as arrays:
                arrays.several(3)

    def test_what_changes_back_is_sent_to_those_who_saw_it_changed(self):
        here, there = particle((0, 0, -1)), particle((-1, 0, 0))
        with NodeProcess(running='false', publish_rate=0.2) as process:
            node = process.client()
            ids = node.add_particles([here]).ids
            with node.listen('markers', MarkerArray) as early:
                early.first()
                node.set_particles(ids, [there])
                late = self.listener_of_its_own(process.name + '/markers')
                self.assertTrue(any('x: -1.0' in line for line in late))
                node.set_particles(ids, [here])
                self.assertTrue(any('z: -1.0' in line for line in late))

    def listener_of_its_own(self, topic):
        """The lines of a process that prints what comes; listeners in one share a connection."""
        process = subprocess.Popen(['rostopic', 'echo', topic], stdout=subprocess.PIPE, text=True)
        end = threading.Timer(LONG, process.kill)
        end.start()
        for clean_up in (process.stdout.close, process.wait, process.kill, end.cancel):
            self.addCleanup(clean_up)
        return process.stdout

    def test_what_is_gone_is_deleted(self):
        ids = add_octant(self.node, damping=0)
        with self.node.listen('markers', MarkerArray) as arrays:
            arrays.first()
            self.node.remove_particles(ids)
            deleted = arrays.several(2)[1].markers
        self.assertEqual({'particles': Marker.DELETE, 'arcs': Marker.DELETE, 'sphere': Marker.ADD},
                         {marker.ns: marker.action for marker in deleted})

    def test_frame_radius_and_rate_are_parameters(self):
        with NodeProcess(running='false', frame_id='globe', radius=6.5,
                         publish_rate=4) as process:
            node = process.client()
            add_octant(node, damping=0)
            markers = self.markers(node)
            self.assertEqual({'globe'}, {m.header.frame_id for m in markers.values()})
            self.assertAlmostEqual(2 * 6.5, markers['sphere'].scale.x, delta=0.1)
            np.testing.assert_allclose(np.linalg.norm(points(markers['arcs']), axis=1), 6.5,
                                       rtol=1e-14)
            with node.listen('markers', MarkerArray) as arrays:
                node.set_running(True)
                stamps = [a.markers[0].header.stamp.to_sec() for a in arrays.several(6)[1:]]
        self.assertGreater(stamps[-1] - stamps[0], 0.5 * (len(stamps) - 1) / 4)
