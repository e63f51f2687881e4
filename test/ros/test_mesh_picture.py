"""scripts/mesh_picture, on surfaces as relax_mesh takes them."""

import os
import re
import subprocess

import rospkg

from mesh_test import MeshTest
from node_client import LONG, PACKAGE
from shapes import CORNERS, TETRAHEDRON, mesh, obj

PROGRAM = os.path.join(rospkg.RosPack().get_path(PACKAGE), 'scripts', 'mesh_picture')
SURFACE = obj(CORNERS, TETRAHEDRON)


class TestMeshPicture(MeshTest):
    def setUp(self):
        super().setUp()
        self.sphere = self.write('sphere.obj', mesh.unit(CORNERS), TETRAHEDRON)

    def draw(self, surface, sphere=None):
        with open(self.path('surface.obj'), 'w') as file:
            file.write(surface)
        return subprocess.run(
            [PROGRAM, self.path('surface.obj'), sphere or self.sphere, self.path('a.png')],
            stderr=subprocess.PIPE, text=True, timeout=4 * LONG)

    def picture(self, surface):
        outcome = self.draw(surface)
        self.assertEqual((0, ''), (outcome.returncode, outcome.stderr))
        with open(self.path('a.png'), 'rb') as file:
            return file.read()

    def test_colours_and_numbers_that_count_back(self):
        coloured = re.sub('(v .*)', r'\1 0.5 0.5 0.5', SURFACE)
        counting_back = coloured.replace('f 1 2 3', 'f -4 -3 -2')
        self.assertNotEqual(coloured, counting_back)
        self.assertEqual(self.picture(SURFACE), self.picture(counting_back))

    def assert_refused(self, words, surface, sphere=None):
        outcome = self.draw(surface, sphere)
        self.assertEqual(1, outcome.returncode)
        self.assertEqual(1, outcome.stderr.count('\n'), outcome.stderr)
        self.assertIn(words, outcome.stderr)
        self.assertFalse(os.path.exists(self.path('a.png')))

    def test_says_what_is_wrong(self):
        no_triangles = 'surface.obj is not an OBJ file of triangles'
        for surface in ('', 'no mesh\n', SURFACE + 'f 1 2 3 4\n', SURFACE + 'f 1 2 5\n',
                        SURFACE + 'f 1 2 -5\n', SURFACE.replace('v 1', 'v nan')):
            self.assert_refused(no_triangles, surface)
        self.assert_refused('sphere.obj: its faces are not those of the surface',
                            SURFACE + 'f 1 2 3\n')
        self.assert_refused('nowhere.obj', SURFACE, self.path('nowhere.obj'))
