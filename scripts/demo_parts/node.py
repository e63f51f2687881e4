"""The node under a master of its own, and calls of its services."""
import contextlib
import os
import signal
import socket
import subprocess
import time

import numpy as np
import rosgraph
import rospy
from spherical_springs.srv import GetScene

NAME = "spherical_springs"
DEADLINE = 30  # [s] for starting and for stopping
INTERRUPTIONS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def launched(launch_file, *arguments, log):
    """Runs a launch file of the package, with a Node to talk to, until the block ends."""
    port = free_port()
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
    os.environ["ROS_HOSTNAME"] = "localhost"
    command = ["roslaunch", "-p", str(port), NAME, launch_file, *arguments]
    with open(log, "w") as output:
        # In a session of its own, so that Ctrl-C reaches it once, from here.
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=output, stderr=output,
            start_new_session=True)
    try:
        wait_until_up(process)
        yield Node()
    finally:
        stop(process)


def wait_until_up(process):
    end = time.monotonic() + DEADLINE
    while not rosgraph.is_master_online():
        if process.poll() is not None or time.monotonic() > end:
            raise RuntimeError("roslaunch did not start")
        time.sleep(0.05)
    rospy.init_node("demo", anonymous=True, disable_signals=True)
    try:
        rospy.wait_for_service(NAME + "/cancel", timeout=DEADLINE)
    except rospy.ROSException:
        raise RuntimeError("the node did not start")


def stop(process):
    # A second Ctrl-C must not leave what roslaunch is about to stop.
    handlers = [(number, signal.signal(number, signal.SIG_IGN)) for number in INTERRUPTIONS]
    rospy.signal_shutdown("the demo is over")
    process.send_signal(signal.SIGINT)
    try:
        process.wait(DEADLINE)
    except subprocess.TimeoutExpired:
        process.kill()
    for number, handler in handlers:
        signal.signal(number, handler)


class Node:
    """Calls services."""

    def call(self, service, kind, **fields):
        """The response to a request of these fields. A refusal is an error."""
        response = rospy.ServiceProxy("%s/%s" % (NAME, service), kind)(**fields)
        if not response.success:
            raise RuntimeError("~%s: %s" % (service, response.message))
        return response

    def positions(self):
        particles = self.call("get_scene", GetScene).particles
        return np.array([(p.position.x, p.position.y, p.position.z) for p in particles])
