"""RViz on a display of its own, drawn by software, and pictures of it."""

import math
import os
import shutil
import signal
import subprocess
import tempfile

import numpy as np
from matplotlib import image

from node_client import LONG, PACKAGE

PROGRAMS = ('rviz', 'Xvfb', 'import')
MISSING = [program for program in PROGRAMS if shutil.which(program) is None]

# The view of launch/spherical_springs.rviz.
BACKGROUND = (250, 250, 252)
FIELD_OF_VIEW = math.pi / 4
DISTANCE = 3
PITCH, YAW = 0.26, 0.28
TOWARDS_EYE = np.array([math.cos(PITCH) * math.cos(YAW), math.cos(PITCH) * math.sin(YAW),
                        math.sin(PITCH)])
RIGHT = np.array([-math.sin(YAW), math.cos(YAW), 0])
UP = np.cross(TOWARDS_EYE, RIGHT)


class Display:
    """An X server of its own, from __enter__, which returns its environment, to __exit__."""

    def __enter__(self):
        receive, send = os.pipe()
        self._server = subprocess.Popen(
            ['Xvfb', '-displayfd', str(send), '-screen', '0', '1200x800x24', '-nolisten', 'tcp'],
            pass_fds=[send], stderr=subprocess.DEVNULL)
        os.close(send)
        with os.fdopen(receive) as numbers:
            return {'DISPLAY': ':' + numbers.readline().strip(), 'LIBGL_ALWAYS_SOFTWARE': '1'}

    def __exit__(self, *_):
        self._server.terminate()
        self._server.wait(LONG)


class Window:
    """A launch file with rviz:=true, from __enter__ to __exit__."""

    def __init__(self, launch_file, *arguments):
        self._command = ['roslaunch', PACKAGE, launch_file, 'rviz:=true', *arguments]
        self._display = Display()

    def __enter__(self):
        self._environment = {**os.environ, **self._display.__enter__()}
        self._launch = subprocess.Popen(self._command, env=self._environment,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return self

    def __exit__(self, *_):
        self._launch.send_signal(signal.SIGINT)
        self._launch.wait(LONG)
        self._display.__exit__()

    def picture(self):
        with tempfile.NamedTemporaryFile(suffix='.png') as file:
            subprocess.run(['import', '-window', 'root', 'PNG24:' + file.name],
                           env=self._environment, check=True)
            return Picture(image.imread(file.name)[..., :3])


class Picture:
    """The pixels of a screen, and which of them show what place near the sphere."""

    def __init__(self, pixels):
        background = np.all(np.rint(255 * pixels) == BACKGROUND, axis=2)
        rows, columns = (np.flatnonzero(background.any(axis=axis)) for axis in (1, 0))
        self.is_drawn = len(rows) > 100 and len(columns) > 100
        if self.is_drawn:
            self._pixels, self._background = pixels, background
            self._middle = np.array([rows[0] + rows[-1], columns[0] + columns[-1]]) / 2
            self._scale = np.ptp(rows) / 2 / math.tan(FIELD_OF_VIEW / 2)

    def has_sphere(self):
        """Whether the background ends at the outline of the sphere, all the way round."""
        angles = np.linspace(0, 2 * math.pi, 24, endpoint=False)
        directions = np.stack([np.sin(angles), np.cos(angles)], axis=1)

        def background_at(radii):
            places = self._middle + radii * self._outline() * directions
            return self._background[tuple(np.rint(places).astype(int).T)]

        return not background_at(0.96).any() and background_at(1.04).all()

    def colour_at(self, point):
        """Of the pixels about a point of the sphere, the middle one by each channel."""
        depth = DISTANCE - point @ TOWARDS_EYE
        place = self._middle + self._scale / depth * np.array([-point @ UP, point @ RIGHT])
        row, column = np.rint(place).astype(int)
        around = self._pixels[row - 1:row + 2, column - 1:column + 2]
        return np.median(around.reshape(-1, 3), axis=0)

    def _outline(self):
        return self._scale / (DISTANCE ** 2 - 1) ** 0.5

    def save(self, path):
        """The sphere and a margin."""
        half = 1.1 * self._outline()
        (top, left), (bottom, right) = ((self._middle + d).astype(int) for d in (-half, half))
        image.imsave(path, self._pixels[top:bottom, left:right])


def visible(point, margin=0.8):
    """Whether a point of the sphere is in front, and not near the outline."""
    return np.asarray(point) @ TOWARDS_EYE > (1 + margin) / DISTANCE


def name_of(colour):
    """What a person would call it."""
    red, _, blue = colour
    if abs(red - blue) > 0.15:
        return 'blue' if blue > red else 'orange'
    return 'white' if min(colour) > 0.7 else 'dark' if max(colour) < 0.35 else 'grey'
