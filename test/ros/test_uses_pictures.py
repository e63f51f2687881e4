"""scripts/uses_pictures, which draws the pictures at the head of the README."""

import os
import subprocess
import tempfile
import unittest

import rospkg
from matplotlib import image

from node_client import LONG, PACKAGE

ROOT = rospkg.RosPack().get_path(PACKAGE)
MOST_BYTES = 100000  # of each, for who reads the README over a slow line


class TestUsesPictures(unittest.TestCase):
    def test_draws_both(self):
        with tempfile.TemporaryDirectory() as directory:
            outcome = subprocess.run(
                [os.path.join(ROOT, 'scripts', 'uses_pictures'), directory], timeout=2 * LONG,
                text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual(0, outcome.returncode, outcome.stdout)
            self.assertEqual({'angles.png', 'directions.png'}, set(os.listdir(directory)))
            for name in os.listdir(directory):
                drawn, kept = (os.path.join(place, name)
                               for place in (directory, os.path.join(ROOT, 'doc')))
                self.assertEqual(image.imread(kept).shape, image.imread(drawn).shape)
                self.assertLessEqual(os.path.getsize(kept), MOST_BYTES)
