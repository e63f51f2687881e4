#!/usr/bin/env python3
"""Relax many random starts on several nodes, and print the directions of the least energy.

    share_out.py NODE [NODE ...] [--starts 40] [--directions 12]

Each node works on one start at a time and loses the scene that it has. A node that does not answer is
given up, and another one does its work again.
"""
import argparse
import math
import queue
import random
import sys
import threading

import rospy
from geometry_msgs.msg import Point
from spherical_springs.msg import AngleSpring, Particle
from spherical_springs.srv import AddParticles, AddSprings, GetScene, Relax
from std_srvs.srv import Trigger

PATIENCE = 10  # [s] for each answer, beside the time that a relaxation may take
LONGEST_RELAXATION = 60  # [s]


class NoAnswer(Exception):
    pass


def in_time(function, seconds):
    """Return what a function returns. A call to a host that is cut off would wait for ever."""
    outcome = queue.Queue()

    def run():
        try:
            outcome.put((function(), None))
        except Exception as fault:  # of any kind: the node, or the way there
            outcome.put((None, fault))

    threading.Thread(target=run, daemon=True).start()
    try:
        result, fault = outcome.get(timeout=seconds)
    except queue.Empty:
        raise NoAnswer('no answer within %g s' % seconds)
    if fault:
        raise NoAnswer(fault)
    return result


class Node:
    def __init__(self, name):
        self.name = name

    def call(self, service, service_type, seconds=PATIENCE, **fields):
        def call():
            rospy.wait_for_service(self.name + '/' + service, PATIENCE)
            return rospy.ServiceProxy(self.name + '/' + service, service_type)(**fields)

        response = in_time(call, seconds)
        if not response.success:
            raise NoAnswer('%s/%s: %s' % (self.name, service, response.message))
        return response

    def relaxed(self, starts):
        """Return the energy and the directions after relaxing, where each repels all others."""
        self.call('clear', Trigger)
        ids = self.call('add_particles', AddParticles,
                        particles=[Particle(position=Point(*start)) for start in starts]).ids
        self.call('add_springs', AddSprings, angle_springs=[
            AngleSpring(particles=(a, b), rest_angle=math.pi, stiffness=1)
            for a in ids for b in ids if a < b])
        answer = self.call('relax', Relax, PATIENCE + LONGEST_RELAXATION,
                           max_time=LONGEST_RELAXATION)
        scene = self.call('get_scene', GetScene)
        return answer.energy_after, [p.position for p in scene.particles]


def share_out(nodes, tasks):
    """Return the results of all tasks, in their order; None for those that no node was left for."""
    waiting = queue.Queue()
    for task in enumerate(tasks):
        waiting.put(task)
    results = [None] * len(tasks)

    def work(node):
        while not rospy.is_shutdown() and None in results:
            try:
                index, task = waiting.get(timeout=0.2)
            except queue.Empty:
                continue  # another node may give its work back
            try:
                results[index] = node.relaxed(task)
            except NoAnswer as fault:
                waiting.put((index, task))
                print('%s is given up: %s' % (node.name, fault), file=sys.stderr)
                return

    workers = [threading.Thread(target=work, args=(node,)) for node in nodes]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('nodes', nargs='+', metavar='NODE')
    parser.add_argument('--starts', type=int, default=40)
    parser.add_argument('--directions', type=int, default=12)
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node('share_out', anonymous=True)
    starts = [[[random.gauss(0, 1) for _ in 'xyz'] for _ in range(options.directions)]
              for _ in range(options.starts)]
    results = share_out([Node(rospy.resolve_name(name)) for name in options.nodes], starts)
    if None in results:
        sys.exit('%d of %d starts are left: no node answers' % (results.count(None), len(results)))
    energy, directions = min(results, key=lambda result: result[0])
    print('%d starts; the least energy is %.9g J' % (len(results), energy))
    for direction in directions:
        print('%9.6f %9.6f %9.6f' % (direction.x, direction.y, direction.z))


if __name__ == '__main__':
    main()
