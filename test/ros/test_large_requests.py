"""Requests for more than the limits allow, or than memory holds, are refused and harm nothing."""

import os
import resource
import struct
import tempfile
import unittest

import numpy as np
from spherical_springs.srv import (
    AddParticlesRequest, AddSpringsRequest, RemoveParticlesRequest, SetSpringsRequest)

from node_client import NodeProcess, Refused
from scenes import add_random_scene, exact, particle

MEGABYTE = 1e6
PARTICLE = struct.pack('<6d2d?', 1, 2, 3, 0, 0, 0, 1, 0, False)


def claim(request_class, *counts, content=b''):
    """A request whose arrays claim to have so many items, whatever comes after."""
    class Claim(request_class):
        def serialize(self, buffer):
            for count in counts:
                buffer.write(struct.pack('<I', count))
            buffer.write(content)
    return Claim()


def many_particles(count):
    return claim(AddParticlesRequest, count, content=np.tile(
        np.frombuffer(PARTICLE, np.uint8), count).tobytes())


class TestLargeRequests(unittest.TestCase):
    def start(self, **parameters):
        process = NodeProcess(running='false', threads=1, **parameters)
        self.addCleanup(process.__exit__)
        self.node = process.client()
        add_random_scene(self.node, seed=1)
        self.before = self.node.get_scene()
        self.process = process

    def memory(self, figure):
        """Of the node, as the system's table of processes has it [bytes]."""
        with open('/proc/%d/status' % self.process.pid) as status:
            return next(1024 * int(line.split()[1]) for line in status
                        if line.startswith(figure + ':'))

    def assert_refused(self, words, service, request):
        with self.assertRaisesRegex(Refused, words):
            getattr(self.node, service)(request)
        self.assertEqual(exact(self.before), exact(self.node.get_scene()))

    def test_that_claim_more_than_they_hold(self):
        self.start()
        before = self.memory('VmHWM')
        for service, request in (
                ('add_particles', claim(AddParticlesRequest, 15000000)),
                ('add_particles', claim(AddParticlesRequest, 2, content=PARTICLE)),
                ('remove_particles', claim(RemoveParticlesRequest, 4000000000)),
                ('add_springs', claim(AddSpringsRequest, 0, 0, 90000000)),
                ('set_springs', claim(SetSpringsRequest, 0, 1000000000))):
            self.assert_refused('in the request are .*; allowed', service, request)
        self.assertLess(self.memory('VmHWM') - before, 50 * MEGABYTE)
        for service, request in (('add_particles', claim(AddParticlesRequest)),
                                 ('add_springs', claim(AddSpringsRequest, 0, 0))):
            self.assert_refused('ended too early: its [08] bytes', service, request)

    def test_beyond_the_limits(self):
        self.start(max_particles=1000, max_springs=1000)
        before = self.memory('VmHWM')
        request = many_particles(1000000)
        self.assert_refused('particles.*1000000.*allowed.*1000', 'add_particles', request)
        # The bytes received, which ROS holds, and no more.
        self.assertLess(self.memory('VmHWM') - before,
                        1.2 * 1000000 * len(PARTICLE) + 10 * MEGABYTE)

    def test_beyond_the_memory(self):
        self.start()
        bound = int(self.memory('VmSize') + 200 * MEGABYTE)
        resource.prlimit(self.process.pid, resource.RLIMIT_AS, (bound, bound))
        self.assert_refused('not enough memory', 'add_particles', many_particles(1000000))
        self.node.add_particles([particle((1, 2, 3))] * 100)
        self.node.step(steps=10)

    def test_a_file_beyond_the_limits(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.start(max_particles=1000, scene_directory=directory.name)
        with open(os.path.join(directory.name, 'large.json'), 'w') as file:
            file.write('{"format": "spherical_springs scene 1", "particles": [')
            file.write(','.join(['{"position": [1, 2, 3]}'] * 1000000) + ']}')
        before = self.memory('VmHWM')
        with self.assertRaisesRegex(Refused, 'before byte .*particles.*1001.*allowed.*1000'):
            self.node.load_scene('large.json')
        self.assertLess(self.memory('VmHWM') - before, 10 * MEGABYTE)
