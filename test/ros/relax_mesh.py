"""The command relax_mesh, and what it says and writes."""

import re
import resource
import subprocess

import roslib.packages

from node_client import LONG, PACKAGE

FIGURES = ('spread', 'mean', 'worst face', 'folded', 'sum')


class Outcome:
    """`error` is what it says on standard error but for the lines of `progress`, which it writes
    every few seconds where that is no terminal."""

    def __init__(self, process):
        self.code, self.output = process.returncode, process.stdout
        lines = process.stderr.strip().splitlines()
        self.progress = [line for line in lines if line.startswith('mapping ...')]
        self.error = '\n'.join(line for line in lines if line not in self.progress)

    def figures(self, when):
        """What the line of that name says of areas, by name."""
        line, = re.findall('^%s: areas: (.*?);' % when, self.output, re.MULTILINE)
        return {name: float(re.search(name + r' ([-+.e\d]+)', line).group(1)) for name in FIGURES}


def command(**options):
    """command(mesh='a.obj', angle_weight=1, load=True) asks for --mesh a.obj --angle-weight 1
    --load."""
    return [roslib.packages.find_node(PACKAGE, 'relax_mesh')[0]] + [
        text for name, value in options.items()
        for text in ('--' + name.replace('_', '-'), str(value))[:1 if value is True else 2]]


def relax_mesh(environment=None, longest_file=None, **options):
    """Run it to its end. `longest_file`: in bytes, which it cannot write more of."""
    def limit():
        if longest_file is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (longest_file, longest_file))

    return Outcome(subprocess.run(command(**options), stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True, timeout=4 * LONG,
                                  env=environment, preexec_fn=limit))
