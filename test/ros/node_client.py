"""What all tests of the node share: calling it, listening to it, starting it, waiting for it."""

import itertools
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

import rosgraph
import roslib.packages
import rospy
from spherical_springs.srv import (
    AddParticles, AddSprings, GetCovariance, GetScene, GetStrains, LoadScene, Relax,
    RemoveParticles, RemoveSprings, SaveScene, SetParticles, SetSprings, Step)
from std_srvs.srv import SetBool, Trigger

PACKAGE = 'spherical_springs'
SERVICES = {
    'add_particles': AddParticles,
    'set_particles': SetParticles,
    'remove_particles': RemoveParticles,
    'add_springs': AddSprings,
    'set_springs': SetSprings,
    'remove_springs': RemoveSprings,
    'get_scene': GetScene,
    'get_strains': GetStrains,
    'get_covariance': GetCovariance,
    'load_scene': LoadScene,
    'save_scene': SaveScene,
    'clear': Trigger,
    'reset': Trigger,
    'set_running': SetBool,
    'step': Step,
    'relax': Relax,
    'cancel': Trigger,
}
LONG = 60  # [s] on the wall; only a broken node takes that long


def wait_until(condition, timeout=LONG):
    """Return the first true value of condition()."""
    end = time.monotonic() + timeout
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError('not so within %g s: %r' % (timeout, condition))
        time.sleep(0.01)


def service_address(master, service):
    """Where a service is to be found, or None as long as the master does not know it."""
    try:
        return rosgraph.Master('/test', master).lookupService(service)
    except rosgraph.MasterError:
        return None


class Refused(Exception):
    """What a service said when it answered with success: false."""


class NodeClient:
    """Every service of a node as a method: client.step(steps=3) returns the response of ~step."""

    def __init__(self, name='/' + PACKAGE):
        self.name = name
        for service, service_type in SERVICES.items():
            rospy.wait_for_service(name + '/' + service, LONG)
            setattr(self, service, self._method(service, service_type))

    def _method(self, service, service_type):
        def call(*args, **fields):
            if args and not hasattr(args[0], 'serialize'):
                # Arguments by position are the first fields; rospy would want all of them.
                fields.update(zip(service_type._request_class.__slots__, args))
                args = ()
            # Each call has a proxy of its own, as threads may not share one.
            response = rospy.ServiceProxy(self.name + '/' + service, service_type)(*args, **fields)
            if not response.success:
                raise Refused(response.message)
            return response
        return call

    def begin(self, service, **fields):
        """Call in the background; .result() of what is returned is the response."""
        executor = ThreadPoolExecutor(1)
        future = executor.submit(getattr(self, service), **fields)
        executor.shutdown(wait=False)
        return future

    def listen(self, topic, message_type):
        return Listener(self.name + '/' + topic, message_type)


class Listener:
    """Keeps the messages of a topic, from __enter__ to __exit__."""

    def __init__(self, topic, message_type):
        self._topic, self._type = topic, message_type
        self._arrived = threading.Condition()
        self._messages = []

    def __enter__(self):
        self._subscriber = rospy.Subscriber(self._topic, self._type, self._keep)
        return self

    def __exit__(self, *_):
        self._subscriber.unregister()

    def _keep(self, message):
        with self._arrived:
            self._messages.append(message)
            self._arrived.notify_all()

    def all(self):
        """The messages so far."""
        with self._arrived:
            return list(self._messages)

    def first(self, condition=lambda message: True, timeout=LONG):
        """The first message so far, or to come, that fulfils the condition."""
        return self.several(1, condition, timeout)[0]

    def several(self, count, condition=lambda message: True, timeout=LONG):
        """The first messages, as many as asked, that fulfil the condition."""
        def found():
            fitting = [m for m in self._messages if condition(m)]
            return fitting[:count] if len(fitting) >= count else None

        with self._arrived:
            messages = self._arrived.wait_for(found, timeout)
        if messages is None:
            raise AssertionError('%s: no %d such messages in %g s' % (self._topic, count, timeout))
        return messages


class NodeProcess:
    """A node of one's own, with private parameters; it ends with the `with` block."""

    _numbers = itertools.count()

    def __init__(self, environment=None, name=None, **parameters):
        self.name = name or '/springs_%d' % next(self._numbers)
        program = roslib.packages.find_node(PACKAGE, PACKAGE + '_node')[0]
        command = [program, '__name:=' + self.name[1:]]
        command += ['_%s:=%s' % item for item in parameters.items()]
        self._output = tempfile.TemporaryFile('w+')
        self._process = subprocess.Popen(
            command, stdout=self._output, stderr=subprocess.STDOUT,
            env={**os.environ, 'ROSCONSOLE_STDOUT_LINE_BUFFERED': '1', **(environment or {})})

    def __enter__(self):
        return self

    @property
    def pid(self):
        return self._process.pid

    def __exit__(self, *_):
        self.stop()
        self._process.kill()
        self._output.close()

    def client(self):
        return NodeClient(self.name)

    def stop(self):
        """Ask it to end; return its exit code."""
        self.send_signal(signal.SIGINT)
        return self.exit_code()

    def send_signal(self, number):
        self._process.send_signal(number)

    def kill(self):
        """End it at once, with no chance to do anything more."""
        self._process.kill()
        self._process.wait()
        self._output.close()

    def exit_code(self, timeout=LONG):
        """Wait for its end; None if it goes on all the same."""
        try:
            return self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            return None

    def output(self):
        self._output.seek(0)
        return self._output.read()


class NodeTest(unittest.TestCase):
    """A test on the node that the launch file has started: paused, with an empty scene."""

    maxDiff = 4000

    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()

    def setUp(self):
        self.node.set_running(False)
        self.node.clear()

    def make_scene_directory(self):
        """The node's directory of files: empty now, and gone after the test."""
        directory = rospy.get_param(self.node.name + '/scene_directory')
        shutil.rmtree(directory, ignore_errors=True)
        os.makedirs(directory)
        self.addCleanup(shutil.rmtree, directory)
        return directory
