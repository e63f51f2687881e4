#!/usr/bin/env python3
"""Run some of the test modules beside this file as one test of rostest, on one roscore.

run_modules.py NAME MODULE...
"""

import sys
import unittest

import rospy
import rostest

PACKAGE = 'spherical_springs'


def cases(suite):
    for part in suite:
        if isinstance(part, unittest.TestSuite):
            yield from cases(part)
        else:
            yield part


def is_skipped(case):
    method = getattr(case, case.id().rpartition('.')[2], None)
    return any(getattr(part, '__unittest_skip__', False) for part in (case, method))


class Suite(unittest.TestSuite):
    """rosunit writes only what has been started: an error in setUpClass would be without words."""

    def run(self, result, debug=False):
        add_error = result.addError

        def add_and_show_error(test, error):
            is_case = isinstance(test, unittest.TestCase)
            if not is_case:
                result.startTest(test)
            add_error(test, error)
            if not is_case:
                result.stopTest(test)

        result.addError = add_and_show_error
        return super().run(result, debug)


def suite():
    """Without cases that are skipped: rosunit would count them as passed."""
    loaded = unittest.defaultTestLoader.loadTestsFromNames(MODULES)
    return Suite(case for case in cases(loaded) if not is_skipped(case))


if __name__ == '__main__':
    NAME, *MODULES = rospy.myargv()[1:]
    MODULES = [module for module in MODULES if not module.startswith('--')]
    rospy.init_node(NAME, anonymous=True)
    rostest.rosrun(PACKAGE, NAME, '__main__.suite', sys.argv)
