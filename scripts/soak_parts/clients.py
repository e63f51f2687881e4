"""Clients of the node, each a process of its own: clients.py read, clients.py load SEED.

`read` writes a line for every call: when, which, how long it took, and how it ended. `load` listens,
calls, adds a particle, removes it and goes away again, over and over; it writes a line for each
particle of which it cannot tell whether it was added.
"""
import contextlib
import enum
import random
import signal
import sys
import threading
import time

import rospy
from geometry_msgs.msg import Point
from spherical_springs.msg import Particle
from spherical_springs.srv import AddParticles, GetScene, RemoveParticles, Step

NAME = "spherical_springs"
PAUSE = 0.02  # [s] between the calls of a reader
over = threading.Event()  # set by SIGTERM: a client puts back what it has changed and ends


class Ending(enum.Enum):
    """How a call ended."""

    answered = enum.auto()
    refused = enum.auto()
    lost = enum.auto()  # the connection ended before the answer came


class Unread(GetScene._response_class):
    """A scene that is received but not taken apart, which takes Python longer than all else."""

    def deserialize(self, content):
        self.success = bool(content[0])
        return self


class GetUnreadScene(GetScene):
    _response_class = Unread


READS = {"get_scene": (GetUnreadScene, {}), "step": (Step, {"steps": 0})}


def call(service, kind, **fields):
    """Return the response, or None where it was lost, and the ending."""
    try:
        response = rospy.ServiceProxy("%s/%s" % (NAME, service), kind)(**fields)
    except rospy.ServiceException:
        return None, Ending.lost
    return response, Ending.answered if response.success else Ending.refused


def read():
    while not over.is_set():
        for service, (kind, fields) in READS.items():
            begin = time.monotonic()
            _, ending = call(service, kind, **fields)
            print(begin, service, time.monotonic() - begin, ending.name, flush=True)
            time.sleep(PAUSE)


def add_and_remove():
    """Add a particle and remove it, however often memory or a relaxation stands in the way."""
    added, ending = call("add_particles", AddParticles,
                         particles=[Particle(position=Point(1, 2, 3))])
    if ending == Ending.lost:
        print("lost", flush=True)
    if ending != Ending.answered:
        return
    any_lost = False
    while True:
        _, ending = call("remove_particles", RemoveParticles, ids=added.ids)
        any_lost = any_lost or ending == Ending.lost
        # Where an answer was lost, the particle may be gone: then its id is refused.
        if ending == Ending.answered or (ending == Ending.refused and any_lost):
            return
        time.sleep(PAUSE)


def load(seed):
    choice = random.Random(seed)
    while not over.is_set():
        topics = choice.sample(["poses", "energies", "status"], choice.randint(1, 3))
        listeners = [rospy.Subscriber("%s/%s" % (NAME, topic), rospy.AnyMsg, lambda _: None)
                     for topic in topics]
        for _ in range(choice.randint(1, 5)):
            service = choice.choice(list(READS))
            kind, fields = READS[service]
            call(service, kind, **fields)
            time.sleep(choice.random() / 2)
        add_and_remove()
        for listener in listeners:
            listener.unregister()


if __name__ == "__main__":
    rospy.init_node(sys.argv[1], anonymous=True, disable_signals=True)
    signal.signal(signal.SIGTERM, lambda *_: over.set())
    # The node may go first.
    with contextlib.suppress(rospy.ROSException, rospy.ROSInterruptException):
        read() if sys.argv[1] == "read" else load(int(sys.argv[2]))
    rospy.signal_shutdown("the soak is over")
