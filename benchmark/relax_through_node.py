#!/usr/bin/env python3
"""Seconds that ~relax takes from call to answer, in a node of its own.

For each scene file (relaxation_benchmark --levels 5 --write-scene FILE makes one): from the start,
and again from the end after every rest angle has changed by up to a hundredth.
"""
import json
import os
import random
import statistics
import time

from node_table import parser_of, print_table
from spherical_springs.msg import AngleSpring
from spherical_springs.srv import LoadScene, Relax, SetSprings
from std_srvs.srv import Trigger

COLUMNS = ("particles", "from the start [s]", "the node's own word [s]", "iterations",
           "after small changes [s]", "iterations", "share", "message")


def timed_relax(node, tolerance):
    begin = time.monotonic()
    response = node.call("relax", Relax, tolerance=tolerance)
    return time.monotonic() - begin, response


def changed_springs(springs, seed):
    """Ids and messages of a scene file's angle springs, at slightly other rest angles."""
    generator = random.Random(seed)
    ids = [spring["id"] for spring in springs]
    messages = [AngleSpring(particles=spring["particles"], stiffness=spring["stiffness"],
                            damping=spring.get("damping", 0),
                            rest_angle=spring["rest_angle"] * generator.uniform(0.99, 1.01))
                for spring in springs]
    return ids, messages


def measure(node, path, arguments):
    """A row of the table."""
    with open(path) as file:
        scene = json.load(file)
    node.call("load_scene", LoadScene, path=os.path.basename(path))
    cold = []
    for _ in range(arguments.runs):
        node.call("reset", Trigger)
        cold.append(timed_relax(node, arguments.tolerance))
    warm = []
    for seed in range(arguments.runs):
        ids, springs = changed_springs(scene["angle_springs"], seed)
        node.call("set_springs", SetSprings, angle_spring_ids=ids, angle_springs=springs)
        warm.append(timed_relax(node, arguments.tolerance))
    cold_seconds, warm_seconds = (statistics.median(seconds for seconds, _ in measured)
                                  for measured in (cold, warm))
    own = statistics.median(response.wall_time for _, response in cold)
    return (len(scene["particles"]), "%.3g" % cold_seconds, "%.3g" % own, cold[-1][1].iterations,
            "%.3g" % warm_seconds, warm[-1][1].iterations, "%.2f" % (warm_seconds / cold_seconds),
            warm[-1][1].message)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--tolerance", type=float, default=1e-9, help="largest torque left [N m]")
    print_table(parser, COLUMNS, measure)


if __name__ == "__main__":
    main()
