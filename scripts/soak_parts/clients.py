"""Clients of the node, each a process of its own: clients.py read, clients.py load SEED.

`read` writes a line for every call: when, which, and how long it took. `load` listens, calls and
goes away again, over and over.
"""
import contextlib
import random
import sys
import time

import rospy
from geometry_msgs.msg import Point
from spherical_springs.msg import Particle
from spherical_springs.srv import AddParticles, GetScene, RemoveParticles, Step

NAME = "spherical_springs"
PAUSE = 0.02  # [s] between the calls of a reader


class Unread(GetScene._response_class):
    """A scene that is received but not taken apart, which takes Python longer than all else."""

    def deserialize(self, content):
        if not content[0]:
            raise RuntimeError("a reader was refused")
        return self


class GetUnreadScene(GetScene):
    _response_class = Unread


READS = {"get_scene": (GetUnreadScene, {}), "step": (Step, {"steps": 0})}


def call(service, kind, **fields):
    return rospy.ServiceProxy("%s/%s" % (NAME, service), kind)(**fields)


def read():
    while not rospy.is_shutdown():
        for service, (kind, fields) in READS.items():
            begin = time.monotonic()
            call(service, kind, **fields)
            print(begin, service, time.monotonic() - begin, flush=True)
            time.sleep(PAUSE)


def change_and_change_back():
    added = call("add_particles", AddParticles, particles=[Particle(position=Point(1, 2, 3))])
    if added.success:
        call("remove_particles", RemoveParticles, ids=added.ids)


def load(seed):
    choice = random.Random(seed)
    while not rospy.is_shutdown():
        topics = choice.sample(["poses", "energies", "status"], choice.randint(1, 3))
        listeners = [rospy.Subscriber("%s/%s" % (NAME, topic), rospy.AnyMsg, lambda _: None)
                     for topic in topics]
        for _ in range(choice.randint(1, 5)):
            service = choice.choice(list(READS))
            kind, fields = READS[service]
            call(service, kind, **fields)
            time.sleep(choice.random() / 2)
        change_and_change_back()
        for listener in listeners:
            listener.unregister()


if __name__ == "__main__":
    rospy.init_node(sys.argv[1], anonymous=True)
    # The node may go first.
    with contextlib.suppress(rospy.ServiceException, rospy.ROSException, rospy.ROSInterruptException):
        read() if sys.argv[1] == "read" else load(int(sys.argv[2]))
