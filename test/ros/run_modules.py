#!/usr/bin/env python3
"""Run some of the test modules beside this file as one test of rostest, on one roscore.

run_modules.py NAME MODULE...
"""

import sys
import unittest

import rospy
import rostest

PACKAGE = 'spherical_springs'


def suite():
    return unittest.defaultTestLoader.loadTestsFromNames(MODULES)


if __name__ == '__main__':
    NAME, *MODULES = rospy.myargv()[1:]
    MODULES = [module for module in MODULES if not module.startswith('--')]
    rospy.init_node(NAME, anonymous=True)
    rostest.rosrun(PACKAGE, NAME, '__main__.suite', sys.argv)
