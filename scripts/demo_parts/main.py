"""The demo; scripts/demo sets up what this needs."""
import signal
import subprocess
import sys

import node
import octant
import picture
import relaxation
import rospy

LOG = "build/demo.log"
PICTURE = "build/demo.png"


def interrupted(number, _):
    sys.exit("demo: stopped by " + signal.Signals(number).name)


def main():
    for number in node.INTERRUPTIONS:
        signal.signal(number, interrupted)
    try:
        with node.launched("octant.launch", "running:=false", log=LOG) as springs:
            moments = octant.watch(springs)
            relaxed = relaxation.relax()
    except (RuntimeError, rospy.ROSException, rospy.ServiceException,
            subprocess.CalledProcessError) as fault:
        sys.exit("demo: %s; more is in %s" % (fault, LOG))
    picture.save(PICTURE, moments, relaxed)
    print("\nThe picture of both is %s" % PICTURE)


main()
