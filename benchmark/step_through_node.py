#!/usr/bin/env python3
"""What stepping and its surroundings take from call to answer, in a node of its own.

For each scene file (stepping_benchmark --write-scene FILE LEVEL makes one): ~load_scene, ~step,
~get_scene, ~save_scene, ~add_springs of all its springs again, and the share of a core that
the node takes while paused, without and with a subscriber to ~poses at 100 Hz. Seconds, but for
~step.
"""
import os
import statistics
import time
import xmlrpc.client

import rosgraph
import rospy
from geometry_msgs.msg import PoseArray
from node_table import NAME, parser_of, print_table
from spherical_springs.srv import (AddParticles, AddSprings, GetScene, LoadScene,
                                   SaveScene, Step)
from std_srvs.srv import Trigger

COLUMNS = ("particles", "springs", "~step [ns a spring]", "~load_scene", "~save_scene",
           "~get_scene", "~add_springs", "nobody listening [share of a core]",
           "~poses at 100 Hz [share of a core]")
FRESH = "fresh.json"


def timed(call, *arguments, **fields):
    begin = time.monotonic()
    response = call(*arguments, **fields)
    return time.monotonic() - begin, response


def step_time(node, springs, seconds, runs):
    """Median of nanoseconds a spring and step."""
    one, _ = timed(node.call, "step", Step, steps=10)
    steps = max(1, int(10 * seconds / one))
    return statistics.median(timed(node.call, "step", Step, steps=steps)[0]
                             for _ in range(runs)) / steps / springs * 1e9


def node_pid():
    uri = rosgraph.Master("/benchmark").lookupNode("/" + NAME)
    return xmlrpc.client.ServerProxy(uri).getPid("/benchmark")[2]


def processor_time(pid):
    """Seconds that the threads of a process have had of all cores, finer than its ticks are."""
    tasks = "/proc/%d/task/" % pid
    nanoseconds = 0
    for task in os.listdir(tasks):
        with open(tasks + task + "/schedstat") as file:
            nanoseconds += int(file.read().split()[0])
    return nanoseconds / 1e9


def share_of_a_core(seconds):
    """What the node takes."""
    pid = node_pid()
    before = processor_time(pid)
    time.sleep(seconds)
    return (processor_time(pid) - before) / seconds


def share_with_poses(seconds):
    """What it takes with a subscriber that leaves the messages as they are."""
    subscriber = rospy.Subscriber(NAME + "/poses", rospy.AnyMsg, lambda message: None,
                                  queue_size=1)
    rospy.wait_for_message(NAME + "/poses", PoseArray, 30)
    share = share_of_a_core(seconds)
    subscriber.unregister()
    return share


def measure(node, path, arguments):
    """A row of the table."""
    load, _ = timed(node.call, "load_scene", LoadScene, path=os.path.basename(path))
    get, scene = timed(node.call, "get_scene", GetScene)
    springs = len(scene.angle_springs) + len(scene.solid_angle_springs)
    step = step_time(node, springs, arguments.seconds, arguments.runs)
    save, _ = timed(node.call, "save_scene", SaveScene, path=FRESH)
    idle = share_of_a_core(5 * arguments.seconds)
    share = share_with_poses(5 * arguments.seconds)
    node.call("clear", Trigger)
    ids = node.call("add_particles", AddParticles, particles=scene.particles).ids
    new_ids = dict(zip(scene.particle_ids, ids))
    for spring in scene.angle_springs + scene.solid_angle_springs:
        spring.particles = [new_ids[particle] for particle in spring.particles]
    add, _ = timed(node.call, "add_springs", AddSprings, angle_springs=scene.angle_springs,
                   solid_angle_springs=scene.solid_angle_springs)
    return (len(scene.particles), springs, "%.2f" % step, "%.3g" % load, "%.3g" % save,
            "%.3g" % get, "%.3g" % add, "%.3f" % idle, "%.3f" % share)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--seconds", type=float, default=1, help="of a run")
    print_table(parser, COLUMNS, measure, "integrator:=euler", "publish_rate:=100")


if __name__ == "__main__":
    main()
