#!/usr/bin/env python3
"""Ask a node for twelve directions that lie as far apart as they can, and print them."""
import math
import random

import rospy
from geometry_msgs.msg import Point
from spherical_springs.msg import AngleSpring, Particle
from spherical_springs.srv import AddParticles, AddSprings, GetScene, Relax
from std_srvs.srv import Trigger

call = {name: rospy.ServiceProxy('/spherical_springs/' + name, kind) for name, kind in (
    ('clear', Trigger), ('add_particles', AddParticles), ('add_springs', AddSprings),
    ('relax', Relax), ('get_scene', GetScene))}
call['clear']()
starts = [Point(*(random.gauss(0, 1) for _ in range(3))) for _ in range(12)]
ids = call['add_particles']([Particle(position=p) for p in starts]).ids
call['add_springs'](angle_springs=[AngleSpring(particles=(a, b), rest_angle=math.pi, stiffness=1)
                                   for a in ids for b in ids if a < b])
print(call['relax'](max_time=60).message)
for particle in call['get_scene']().particles:
    print('%9.6f %9.6f %9.6f' % tuple(getattr(particle.position, axis) for axis in 'xyz'))
