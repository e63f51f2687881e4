"""A directory, and checks of what relax_mesh has left there."""

import os
import tempfile

import numpy as np

from node_client import NodeTest
from relax_mesh import relax_mesh
from scenes import solid_angles
from shapes import mesh


class MeshTest(NodeTest):
    def setUp(self):
        super().setUp()
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def write(self, name, vertices, faces):
        mesh.write_obj(self.path(name), vertices, faces)
        return self.path(name)

    def run_to_success(self, **options):
        outcome = relax_mesh(output=self.path('sphere.obj'), **options)
        self.assertEqual((0, ''), (outcome.code, outcome.error))
        return outcome

    def assert_is_map(self, faces, weights, outcome, path=None):
        """Check the sphere that was written, and what was said of it. Return log area ratios."""
        sphere, same_faces = mesh.read_obj(path or self.path('sphere.obj'))
        np.testing.assert_array_equal(faces, same_faces)
        np.testing.assert_allclose(np.linalg.norm(sphere, axis=1), 1, atol=1e-14)
        areas = solid_angles(*np.moveaxis(sphere[faces], 1, 0))
        self.assertGreater(areas.min(), 0)
        self.assertAlmostEqual(4 * np.pi, areas.sum(), delta=1e-9)
        ratios = np.log(areas / weights * weights.sum() / (4 * np.pi))
        figures = outcome.figures('after')
        for name, value in {'spread': ratios.std(), 'mean': np.abs(ratios).mean(),
                            'worst face': np.abs(ratios).max(), 'folded': 0,
                            'sum': 4 * np.pi}.items():
            np.testing.assert_allclose(figures[name], value, rtol=0.01, atol=1e-8, err_msg=name)
        return ratios
