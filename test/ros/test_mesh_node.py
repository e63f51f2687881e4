"""relax_mesh beside a node that is too small, busy, ends, starts again or hangs while it maps."""

import os
import signal
import subprocess
import tempfile

import rospkg
from spherical_springs.msg import Status

from mesh_test import MeshTest
from node_client import LONG, PACKAGE, NodeProcess
from relax_mesh import Outcome, command, relax_mesh
from scenes import add_knot, exact
from shapes import CORNERS, TETRAHEDRON, bumpy, double_pyramid, mesh

OCTANT, PAN_TILT = (os.path.join(rospkg.RosPack().get_path(PACKAGE), 'launch', name)
                    for name in ('octant.json', 'pan_tilt.json'))
LONG_MAPPING = bumpy(5)  # 10,242 vertices: 1 to 3 s on two cores
UNRELAXED = '; the map has been written, but springs have not relaxed it'


def scene_of(client):
    """Its ids and bits, and not how long it has been there."""
    scene = client.get_scene()
    scene.time = 0
    return exact(scene)


class Mapping:
    """relax_mesh at work on a mesh of many faces, from a start that it passes over."""

    def __init__(self, node, surface=LONG_MAPPING):
        self._directory = tempfile.TemporaryDirectory()
        vertices, faces = surface
        mesh.write_obj(self.path('surface.obj'), vertices, faces)
        mesh.write_obj(self.path('start.obj'), vertices * (1, 1, -1), faces)  # folded
        self._process = subprocess.Popen(
            command(mesh=self.path('surface.obj'), sphere=self.path('start.obj'),
                    output=self.path('sphere.obj'), uv=self.path('uv.obj'), node=node),
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self._begun = self._process.stdout.readline()  # when it has looked at the node

    def path(self, name):
        return os.path.join(self._directory.name, name)

    def send_signal(self, number):
        self._process.send_signal(number)

    def hold(self):
        """Stop it while it maps, until it is let go."""
        self.send_signal(signal.SIGSTOP)
        os.waitid(os.P_PID, self._process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
        if self.files():
            raise AssertionError('the map was there before anything could happen to the node')

    def let_go(self):
        self.send_signal(signal.SIGCONT)

    def outcome(self):
        output, error = self._process.communicate(timeout=4 * LONG)
        self._process.stdout, self._process.stderr = self._begun + output, error
        return Outcome(self._process)

    def files(self):
        return set(os.listdir(self._directory.name)) - {'surface.obj', 'start.obj'}

    def close(self):
        self._process.kill()
        self._process.wait()
        self._directory.cleanup()


class TestMeanwhile(MeshTest):
    """All maps are held while the nodes end, start again or hang, however long that takes."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.nodes, cls.mappings, cls.scenes = {}, {}, {}
        try:
            for name in ('ended', 'restarted', 'shrunk', 'busy', 'shared', 'stopped'):
                cls.nodes[name] = NodeProcess(scene=OCTANT, running=False)
            cls.begin()
        except BaseException:
            cls.tearDownClass()
            raise

    @classmethod
    def begin(cls):
        nodes, mappings = cls.nodes, cls.mappings
        busy = nodes['busy'].client()
        add_knot(busy)
        cls.scenes['busy'] = busy.get_scene().particle_ids
        with busy.listen('status', Status) as statuses:
            busy.begin('relax', method='dynamics', tolerance=1e-30)
            statuses.first(lambda status: status.state == 'relaxing')
        for name, node in [*nodes.items(), ('shared too', nodes['shared'])]:
            cls.scenes.setdefault(name, scene_of(node.client()))
            mappings[name] = Mapping(node.name)
            mappings[name].hold()

        for name in ('ended', 'restarted', 'shrunk'):
            nodes[name].kill()
        nodes['restarted'] = NodeProcess(name=nodes['restarted'].name, scene=PAN_TILT)
        nodes['shrunk'] = NodeProcess(name=nodes['shrunk'].name, scene=OCTANT, max_springs=9)
        for name in ('restarted', 'shrunk'):
            nodes[name].client()  # when it answers
        nodes['stopped'].send_signal(signal.SIGSTOP)
        for mapping in mappings.values():
            mapping.let_go()
        cls.outcomes = {}

    @classmethod
    def tearDownClass(cls):
        for mapping in cls.mappings.values():
            mapping.close()
        if 'stopped' in cls.nodes:
            cls.nodes['stopped'].send_signal(signal.SIGCONT)
        for node in cls.nodes.values():
            node.kill()

    def outcome(self, name):
        """Of a mapping, whose map has been written."""
        if name not in self.outcomes:
            self.outcomes[name] = self.mappings[name].outcome()
        outcome = self.outcomes[name]
        self.assertEqual(0, outcome.code, outcome.error)
        self.assertEqual({'sphere.obj', 'uv.obj'}, self.mappings[name].files())
        vertices, faces = LONG_MAPPING
        self.assert_is_map(faces, mesh.areas(vertices, faces), outcome,
                           self.mappings[name].path('sphere.obj'))
        return outcome

    def assert_relaxed(self, client):
        """The scene is the map, alone."""
        scene = client.get_scene()
        vertices, faces = LONG_MAPPING
        self.assertEqual((len(vertices), 3 * len(faces) // 2, len(faces)),
                         (len(scene.particles), len(scene.angle_springs),
                          len(scene.solid_angle_springs)))

    def test_node_ends(self):
        name = self.nodes['ended'].name
        self.assertEqual(
            'warning: no node %s answers; start one: roslaunch spherical_springs '
            'spherical_springs.launch running:=false name:=%s' % (name, name[1:]) + UNRELAXED,
            self.outcome('ended').error)

    def test_node_is_started_again(self):
        self.assertEqual('', self.outcome('restarted').error)
        self.assert_relaxed(self.nodes['restarted'].client())

    def test_node_is_started_again_and_takes_too_few_springs(self):
        self.assertRegex(
            self.outcome('shrunk').error,
            r'\Awarning: %s/add_springs: .*allowed.* 9.*' % self.nodes['shrunk'].name + UNRELAXED +
            r'\Z')
        self.assertEqual(self.scenes['shrunk'], scene_of(self.nodes['shrunk'].client()))

    def test_node_relaxes_for_another_client(self):
        name = self.nodes['busy'].name
        self.assertEqual(
            'warning: %s relaxes for another client; it will be asked again when there is a map\n'
            'warning: %s/set_running: a ~relax is under way; wait for it or end it by ~cancel'
            % (name, name) + UNRELAXED, self.outcome('busy').error)
        self.assertEqual(self.scenes['busy'], self.nodes['busy'].client().get_scene().particle_ids)

    def test_of_two_at_one_node_the_first_wins(self):
        first, second = sorted(self.outcome(name).error for name in ('shared', 'shared too'))
        self.assertEqual('', first)
        name = self.nodes['shared'].name
        self.assertRegex(  # where the first relaxes already, the node refuses what the second asks
            second, r'\Awarning: (another client has changed the scene of ' + name +
            ' meanwhile; relax_mesh needs a node to itself|' + name +
            '/.*: a ~relax is under way; wait for it or end it by ~cancel)' + UNRELAXED + r'\Z')
        self.assert_relaxed(self.nodes['shared'].client())

    def test_node_hangs(self):
        name = self.nodes['stopped'].name
        self.assertEqual('warning: %s/get_scene does not answer' % name + UNRELAXED,
                         self.outcome('stopped').error)
        self.nodes['stopped'].send_signal(signal.SIGCONT)
        self.assertEqual(self.scenes['stopped'], scene_of(self.nodes['stopped'].client()))


class TestRoom(MeshTest):
    def assert_refused(self, node, pattern):
        client = node.client()
        before = scene_of(client)
        outcome = relax_mesh(mesh=self.write('surface.obj', CORNERS, TETRAHEDRON), node=node.name,
                             output=self.path('sphere.obj'))
        self.assertEqual(1, outcome.code, outcome.error)
        self.assertRegex(outcome.error, r'\Aerror: ' + node.name + ' takes ' + pattern + r'\Z')
        self.assertEqual(['surface.obj'], os.listdir(self.directory))
        self.assertEqual(before, scene_of(client))

    def test_too_few_particles_or_springs(self):
        for limits, pattern in (
                ({'max_particles': 3}, '3 particles and has 3 until the map replaces them; the map '
                 'needs 4; start the node with a larger ~max_particles, or clear its scene'),
                ({'max_particles': 6}, '6 particles and has 3 until .*'),
                ({'max_springs': 12}, '12 springs and has 3 until .* needs 10; .*')):
            with self.subTest(limits), NodeProcess(scene=OCTANT, running=False, **limits) as node:
                self.assert_refused(node, pattern)

    def test_too_few_particles_for_an_empty_scene(self):
        with NodeProcess(max_particles=3) as node:
            self.assert_refused(node, '3 particles; the map needs 4; start the node with a larger '
                                '~max_particles')

    def test_just_enough(self):
        with NodeProcess(scene=OCTANT, running=True, max_particles=45, max_springs=203) as node:
            client = node.client()
            outcome = relax_mesh(mesh=self.write('surface.obj', *mesh.icosphere(1, 1)[:2]),
                                 node=node.name, output=self.path('sphere.obj'))
            self.assertEqual((0, ''), (outcome.code, outcome.error))
            self.assertIn('removed 3 particles and 3 springs', outcome.output)
            scene = client.get_scene()
            self.assertEqual((42, 120, 80), (len(scene.particles), len(scene.angle_springs),
                                             len(scene.solid_angle_springs)))
            client.step(steps=1)  # only while paused


class TestInterruption(MeshTest):
    def test_mapping_ends_and_nothing_is_written(self):
        for surface in (LONG_MAPPING, double_pyramid(20000)):
            mapping = Mapping(self.node.name, surface)
            self.addCleanup(mapping.close)
            mapping.send_signal(signal.SIGINT)
            outcome = mapping.outcome()
            self.assertEqual((1, 'error: interrupted; no file has been written'),
                             (outcome.code, outcome.error))
            self.assertEqual(set(), mapping.files())
