#!/usr/bin/env python3
"""Ask a node for twelve directions that lie as far apart as they can, and print them.

The node is `spherical_springs` in this program's namespace; it loses the scene that it has.
"""
import math
import random
import sys

import actionlib
import rospy
from geometry_msgs.msg import Point
from spherical_springs.msg import AngleSpring, Particle, RelaxAction, RelaxGoal
from spherical_springs.srv import AddParticles, AddSprings, GetScene
from std_srvs.srv import Trigger

NODE = 'spherical_springs/'
PATIENCE = 10  # [s] for the node to be there


def call(service, service_type, *args, **fields):
    """Return the response of a service of the node; exit where it says that it failed."""
    rospy.wait_for_service(NODE + service, PATIENCE)
    response = rospy.ServiceProxy(NODE + service, service_type)(*args, **fields)
    if not response.success:
        sys.exit('%s: %s' % (rospy.resolve_name(NODE + service), response.message))
    return response


def relax():
    """Relax the scene and return the result; exit where the node says that it failed."""
    client = actionlib.SimpleActionClient(NODE + 'relax', RelaxAction)
    client.wait_for_server()
    client.send_goal_and_wait(RelaxGoal(max_time=60))
    if not client.get_result().success:
        sys.exit('relax: ' + client.get_goal_status_text())
    return client.get_result()


def main():
    rospy.init_node('spread_directions', anonymous=True)
    try:
        call('clear', Trigger)
    except rospy.ROSException:
        sys.exit('there is no node %s; start one: roslaunch spherical_springs '
                 'spherical_springs.launch' % rospy.resolve_name(NODE.rstrip('/')))
    starts = [Point(*(random.gauss(0, 1) for _ in range(3))) for _ in range(12)]
    ids = call('add_particles', AddParticles, [Particle(position=p) for p in starts]).ids
    call('add_springs', AddSprings, angle_springs=[
        AngleSpring(particles=(a, b), rest_angle=math.pi, stiffness=1)
        for a in ids for b in ids if a < b])
    print(relax().message)
    for particle in call('get_scene', GetScene).particles:
        print('%9.6f %9.6f %9.6f' % tuple(getattr(particle.position, axis) for axis in 'xyz'))


if __name__ == '__main__':
    main()
