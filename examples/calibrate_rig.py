#!/usr/bin/env python3
"""Find the directions of six cameras by the angles between them, one of which was measured wrong.

The node is `spherical_springs` in this program's namespace; it loses the scene that it has.
"""
import itertools
import math
import sys

import rospy
from geometry_msgs.msg import Point
from spherical_springs.msg import AngleSpring, Particle
from spherical_springs.srv import (
    AddParticles, AddSprings, GetCovariance, GetScene, GetStrains, Relax)
from std_srvs.srv import Trigger

NODE = 'spherical_springs/'
PATIENCE = 10  # [s] for the node to be there
SIGMA = math.radians(0.2)  # of a measurement
# The drawing: azimuth and elevation of each camera [degrees].
DRAWING = ((0, 0), (60, 0), (120, 0), (180, 0), (240, 0), (300, 45))
# Measured angles [degrees] between cameras 0 and 1, 0 and 2, ... 4 and 5. Cameras 1 and 3 are
# 3 degrees less apart.
ANGLES = (61.62, 122.02, 172.88, 120.18, 63.96, 68.88, 127.40, 158.27, 119.16, 61.00, 117.04,
          124.87, 55.89, 108.70, 76.05)


def call(service, service_type, *args, **fields):
    """Return the response of a service of the node; exit where it says that it failed."""
    try:
        rospy.wait_for_service(NODE + service, PATIENCE)
    except rospy.ROSException:
        sys.exit('there is no node %s; start one: roslaunch spherical_springs '
                 'spherical_springs.launch' % rospy.resolve_name(NODE.rstrip('/')))
    response = rospy.ServiceProxy(NODE + service, service_type)(*args, **fields)
    if not response.success:
        sys.exit('%s: %s' % (rospy.resolve_name(NODE + service), response.message))
    return response


def direction(azimuth, elevation):
    """Return the unit vector of an azimuth and an elevation [degrees]."""
    turn, lift = math.radians(azimuth), math.radians(elevation)
    return Point(math.cos(lift) * math.cos(turn), math.cos(lift) * math.sin(turn), math.sin(lift))


def main():
    rospy.init_node('calibrate_rig', anonymous=True)
    call('clear', Trigger)
    # The first camera defines the frame.
    ids = call('add_particles', AddParticles, [
        Particle(position=direction(*place), pinned=place == DRAWING[0]) for place in DRAWING]).ids
    pairs = list(itertools.combinations(range(len(ids)), 2))
    call('add_springs', AddSprings, angle_springs=[
        AngleSpring(particles=(ids[a], ids[b]), rest_angle=math.radians(measured),
                    stiffness=1 / SIGMA ** 2)
        for (a, b), measured in zip(pairs, ANGLES)])

    answer = call('relax', Relax, method='global', starts=5)
    print(answer.message)
    print('free rotations: %d; mirror image as good: %s; residual in the mean: %.2f degrees' % (
        answer.free_rotations, 'yes' if answer.mirror_ambiguous else 'no',
        math.degrees(answer.rms_strain)))

    print('camera: direction, and how sure along x and y of its pose [degrees]')
    covariances = call('get_covariance', GetCovariance, ids=ids).covariances
    for i, particle in enumerate(call('get_scene', GetScene).particles):
        variances = covariances[4 * i], covariances[4 * i + 3]
        print('%d: %9.6f %9.6f %9.6f  %.2f %.2f' % (
            i, particle.position.x, particle.position.y, particle.position.z,
            *(math.degrees(math.sqrt(max(variance, 0))) for variance in variances)))

    print('cameras: by how many sigma the result misses the measurement')
    conditions = call('get_strains', GetStrains).angle_conditions
    for (a, b), condition in zip(pairs, conditions):
        print('%d %d: %5.1f' % (a, b, condition / SIGMA))


if __name__ == '__main__':
    main()
