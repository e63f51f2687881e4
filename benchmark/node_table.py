"""A table of what a node of its own does with scene files."""
import argparse
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                os.pardir, "scripts", "demo_parts"))

from node import NAME, launched  # noqa: E402,F401


def parser_of(description):
    """With what every table takes."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("scenes", nargs="+", help="scene files, all in one directory")
    parser.add_argument("--runs", type=int, default=5, help="of which the median is taken")
    parser.add_argument("--threads", type=int, default=0, help="of the node; 0: as many as it may use")
    parser.add_argument("--log", default=os.devnull, help="where the node's output goes")
    return parser


def print_row(cells):
    print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def print_table(parser, columns, row, *launch_arguments):
    """A row for each scene file: row(node, path, arguments)."""
    arguments = parser.parse_args()
    directories = {os.path.dirname(os.path.abspath(path)) for path in arguments.scenes}
    if len(directories) > 1:
        parser.error("the scene files are in %d directories; allowed: one" % len(directories))
    with launched("spherical_springs.launch", "running:=false",
                  "threads:=%d" % arguments.threads, "scene_directory:=" + directories.pop(),
                  *launch_arguments, log=arguments.log) as node:
        print_row(columns)
        print_row(["---"] * len(columns))
        for path in arguments.scenes:
            print_row(row(node, path, arguments))
