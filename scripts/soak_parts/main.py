"""A mesh of 10,242 particles runs at 1 kHz and relaxes, in turn, while others read, listen and go."""
import contextlib
import os
import pathlib
import subprocess
import sys
import threading
import time
import xmlrpc.client

import mesh
import network
import numpy as np
import rosgraph
from node import NAME, launched
from spherical_springs.srv import Relax
from std_srvs.srv import SetBool, Trigger

HERE = pathlib.Path(__file__).parent
LOADS = 2
LONGEST_TURN = 60  # [s]
GROWTH, SLACK = 1.05, 20  # of memory from the middle third of the rounds to the last: factor, [MB]
GOAL = 50  # [ms]


class Reader:
    """Times the calls of a process that does nothing else."""

    def __init__(self, log):
        self._log = log
        self._file = open(log, "w")
        self.process = start_client("read", output=self._file)

    def latencies(self, begin, end):
        """Of the calls that began in between, by service [ms]."""
        found = {}
        for line in self._log.read_text().splitlines():
            when, service, took = line.split()
            if begin <= float(when) < end:
                found.setdefault(service, []).append(1000 * float(took))
        return found


def start_client(*arguments, output=None):
    return subprocess.Popen([sys.executable, str(HERE / "clients.py"), *arguments], stdout=output)


@contextlib.contextmanager
def clients():
    reader = Reader(pathlib.Path("build/soak-latencies.txt"))
    loads = [start_client("load", str(seed)) for seed in range(LOADS)]
    try:
        yield reader
        gone = [p for p in (reader.process, *loads) if p.poll() is not None]
        if gone:
            raise RuntimeError("a client ended: the node did not answer it")
    finally:
        for process in (reader.process, *loads):
            process.terminate()
            process.wait()


def resident_memory():
    """Of the node [MB]."""
    master = rosgraph.Master("/soak")
    address = master.lookupNode("/" + NAME)
    _, _, pid = xmlrpc.client.ServerProxy(address).getPid("/soak")
    with open("/proc/%d/status" % pid) as status:
        return next(int(line.split()[1]) / 1000 for line in status if line.startswith("VmRSS"))


def send_mesh(node):
    points, faces, _ = mesh.icosphere(levels=5, line_level=5)
    areas = mesh.areas(mesh.bumpy(points), faces)
    network.send(node, points, mesh.edges_of(faces), faces, areas / areas.sum())


def run(node, seconds):
    node.call("set_running", SetBool, data=True)
    time.sleep(seconds)
    node.call("set_running", SetBool, data=False)


def relax(node, seconds, **fields):
    """Relaxes from the start, again and again."""
    end = time.monotonic() + seconds
    timer = threading.Timer(seconds, node.call, ("cancel", Trigger))
    timer.start()
    while time.monotonic() < end:
        node.call("reset", Trigger)
        node.call("relax", Relax, tolerance=1e-30, max_time=max(0.1, end - time.monotonic()), **fields)
    timer.join()


TURNS = {
    "running at 1 kHz": run,
    "relaxing, newton": lambda node, seconds: relax(node, seconds, method="newton"),
    "relaxing, dynamics": lambda node, seconds: relax(node, seconds, method="dynamics"),
}


def soak(node, seconds):
    """What each turn of each round came to: its name, latencies by service, memory at its end."""
    rounds = max(3, round(seconds / (LONGEST_TURN * len(TURNS))))
    turn = seconds / rounds / len(TURNS)
    results = []
    with clients() as reader:
        for number in range(rounds):
            for name, work in TURNS.items():
                begin = time.monotonic()
                work(node, turn)
                latencies = reader.latencies(begin, time.monotonic())
                results.append((number, name, latencies, resident_memory()))
                tell(*results[-1])
    return results


def tell(number, name, latencies, memory):
    for service, times in sorted(latencies.items()):
        p50, p99 = np.percentile(times, [50, 99])
        print("round %d, %-18s  ~%-9s  %5d calls  p50 %6.1f ms  p99 %6.1f ms  worst %6.1f ms  %4d MB"
              % (number + 1, name, service, len(times), p50, p99, max(times), memory), flush=True)


def sum_up(results):
    """Print the figures of all rounds; return whether memory has stayed."""
    print("\nall rounds:")
    for name in TURNS:
        together = {}
        for _, turn, latencies, memory in results:
            if turn == name:
                for service, times in latencies.items():
                    together.setdefault(service, []).extend(times)
        for service, times in sorted(together.items()):
            p50, p99 = np.percentile(times, [50, 99])
            print("%-18s  ~%-9s  %6d calls  p50 %6.1f ms  p99 %6.1f ms  (goal: %d ms)"
                  % (name, service, len(times), p50, p99, GOAL))
    memory = [max(m for n, _, _, m in results if n == number)
              for number in range(1 + results[-1][0])]
    print("memory, round by round: %s MB" % ", ".join("%d" % m for m in memory))
    third = len(memory) // 3
    return max(memory[-third:]) <= GROWTH * max(memory[third:2 * third]) + SLACK


def main(seconds):
    os.makedirs("build", exist_ok=True)
    with launched("spherical_springs.launch", "running:=false", log="build/soak-node.log") as node:
        send_mesh(node)
        results = soak(node, seconds)
    if not sum_up(results):
        sys.exit("error: memory has grown")


if __name__ == "__main__":
    main(float(sys.argv[1]))
