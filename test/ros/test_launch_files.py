"""What the launch files start, as roslaunch reads them."""

import os
import signal
import subprocess
import tempfile
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
import roslaunch
import rospkg

from node_client import LONG, PACKAGE, NodeClient, wait_until
from scenes import particle

LAUNCH = os.path.join(rospkg.RosPack().get_path(PACKAGE), 'launch')
FILES = {'spherical_springs': (), 'octant': (), 'pan_tilt': (), 'viewing_directions': (),
         'mesh': ('mesh:=a.obj', 'rviz:=true'), 'host': ('host:=10.0.0.2', 'namespace:=far')}
ARGUMENTS = {'time_step': 0.5, 'integrator': 'euler', 'publish_rate': 7, 'real_time_factor': 2.5,
             'frame_id': 'globe', 'radius': 3.5, 'threads': 3, 'spring_damping': 'own',
             'max_particles': 100, 'max_springs': 200, 'scene_directory': '/tmp/scenes'}


def configuration(name, *arguments):
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load(
        os.path.join(LAUNCH, name + '.launch'), config, argv=[*FILES[name], *arguments],
        verbose=False)
    return config


def loaded(name, *arguments):
    """The node that a file starts, and its parameters."""
    config = configuration(name, *arguments)
    node, = (node for node in config.nodes if node.type == PACKAGE + '_node')
    prefix = node.namespace + node.name + '/'
    return node, {key[len(prefix):]: parameter.value
                  for key, parameter in config.params.items() if key.startswith(prefix)}


def process_of(node):
    """The id of a node's process; None while there is none."""
    try:
        uri = rosgraph.Master('/test').lookupNode(node)
        return ServerProxy(uri).getPid('/test')[2]
    except (OSError, rosgraph.MasterError):
        return None


class TestLaunchFiles(unittest.TestCase):
    def test_all_of_them_are_tried(self):
        there = {name[:-len('.launch')] for name in os.listdir(LAUNCH) if name.endswith('.launch')}
        self.assertEqual(there, set(FILES))

    def test_every_argument_goes_on_to_the_node(self):
        for name in FILES:
            node, parameters = loaded(
                name, 'name:=other', *('%s:=%s' % item for item in ARGUMENTS.items()))
            self.assertEqual('other', node.name)
            self.assertEqual(ARGUMENTS, {key: parameters[key] for key in ARGUMENTS}, name)

    def test_scenes_and_running_are_those_of_the_file(self):
        for name in FILES:
            _, parameters = loaded(name, 'running:=false')
            self.assertFalse(parameters['running'])
            scene = '' if name in ('spherical_springs', 'mesh', 'host') else name + '.json'
            self.assertEqual(scene, os.path.basename(parameters['scene']))

    def test_what_becomes_of_the_node_that_ends(self):
        for name in FILES:
            node, _ = loaded(name)
            self.assertEqual((False, False, 'screen'), (node.required, node.respawn, node.output))
            self.assertTrue(loaded(name, 'required:=true')[0].required)
            self.assertTrue(loaded(name, 'respawn:=true')[0].respawn)
            if name != 'mesh':  # whose output is the map
                self.assertEqual('log', loaded(name, 'output:=log')[0].output)


class TestHost(unittest.TestCase):
    def test_the_node_is_on_the_other_machine(self):
        config = configuration('host', 'user:=anna', 'env_loader:=/home/anna/env.sh')
        config.assign_machines()
        node, = config.nodes
        self.assertEqual('/far/', node.namespace)
        machine = node.machine
        self.assertEqual(('10.0.0.2', 'anna', '/home/anna/env.sh'),
                         (machine.address, machine.user, machine.env_loader))


class TestRespawn(unittest.TestCase):
    def test_the_scene_that_was_saved_is_there_again(self):
        with tempfile.TemporaryDirectory() as directory:
            launched = subprocess.Popen(
                ['roslaunch', PACKAGE, 'spherical_springs.launch', 'name:=respawned',
                 'respawn:=true', 'scene:=saved.json', 'scene_directory:=' + directory],
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.addCleanup(launched.wait, LONG)
            self.addCleanup(launched.terminate)
            with open(directory + '/saved.json', 'w') as file:
                file.write('{"format": "spherical_springs scene 1"}')
            node = NodeClient('/respawned')
            node.add_particles([particle((1, 2, 3))] * 2)
            node.save_scene('saved.json')
            first = process_of('/respawned')
            os.kill(first, signal.SIGKILL)
            wait_until(lambda: process_of('/respawned') not in (None, first))
            self.assertEqual(2, len(NodeClient('/respawned').get_scene().particles))
