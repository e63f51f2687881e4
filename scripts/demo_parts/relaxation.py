"""A bumpy mesh of unequal areas, mapped to the sphere so that each face has its fair share."""
import collections
import subprocess

import mesh
import numpy as np

SURFACE, START, SPHERE = ("build/demo_%s.obj" % name for name in ("mesh", "start", "sphere"))

Relaxed = collections.namedtuple("Relaxed", "surface faces lines before after")
Map = collections.namedtuple("Map", "points log_ratios")


def relax():
    """Makes the mesh, has relax_mesh map it, and prints and returns what became of it."""
    print("\n2. A bumpy mesh on the sphere, mapped so that each face has its share of 4 pi;")
    print("   spread: standard deviation of log(share of the sphere / share of the surface)\n",
          flush=True)
    start, faces, lines = mesh.icosphere(levels=5, line_level=3)
    surface = mesh.bumpy(start)
    mesh.write_obj(SURFACE, surface, faces)
    mesh.write_obj(START, start, faces)
    subprocess.run(["rosrun", "spherical_springs", "relax_mesh", "--mesh", SURFACE, "--sphere",
                    START, "--output", SPHERE, "--angle-weight", "0.01"], check=True)
    end, _ = mesh.read_obj(SPHERE)
    areas = mesh.areas(surface, faces)
    shares = areas / areas.sum()
    before, after = (Map(points, mesh.log_area_ratios(points, faces, shares))
                     for points in (start, end))
    folded = np.count_nonzero(mesh.solid_angles(end, faces) <= 0)
    print("\n   {:,} vertices, {:,} faces, {} folded; from {} to {}".format(
        len(start), len(faces), folded, START, SPHERE))
    return Relaxed(surface, faces, lines, before, after)
