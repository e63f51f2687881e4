"""The command relax_mesh, and what it says and writes."""

import re
import resource
import subprocess

import roslib.packages

from node_client import LONG, PACKAGE

FIGURES = ('spread', 'mean', 'worst face', 'folded', 'sum')


class Outcome:
    def __init__(self, process):
        self.code, self.output, self.error = (
            process.returncode, process.stdout, process.stderr.strip())

    def figures(self, when):
        """What the line of that name says of areas, by name."""
        line, = re.findall('^%s: areas: (.*?);' % when, self.output, re.MULTILINE)
        return {name: float(re.search(name + r' ([-+.e\d]+)', line).group(1)) for name in FIGURES}


def command(**options):
    """command(mesh='a.obj', angle_weight=1) asks for --mesh a.obj --angle-weight 1."""
    return [roslib.packages.find_node(PACKAGE, 'relax_mesh')[0]] + [
        text for name, value in options.items()
        for text in ('--' + name.replace('_', '-'), str(value))]


def relax_mesh(environment=None, longest_file=None, **options):
    """Run it to its end. `longest_file`: in bytes, which it cannot write more of."""
    def limit():
        if longest_file is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (longest_file, longest_file))

    return Outcome(subprocess.run(command(**options), stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True, timeout=4 * LONG,
                                  env=environment, preexec_fn=limit))
