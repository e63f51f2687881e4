"""A mesh of 10,242 particles runs at 1 kHz and relaxes, in turn, while others read, listen and go."""
import argparse
import collections
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
import rospy
from clients import Ending
from node import DEADLINE, NAME, launched
from short_memory import ShortMemory
from spherical_springs.srv import GetScene, Relax
from std_srvs.srv import SetBool, Trigger

HERE = pathlib.Path(__file__).parent
LOADS = 2
LONGEST_TURN = 60  # [s]
GROWTH, SLACK = 1.05, 20  # of memory from the middle third of the rounds to the last: factor, [MB]
GOAL = 50  # [ms]


class Reader:
    """Times the calls of a process that does nothing else."""

    def __init__(self):
        self._log = pathlib.Path("build/soak-latencies.txt")
        self.process = start_client("read", log=self._log)

    def calls(self, begin, end):
        """Yield service, time taken [ms] and ending of each call that began in between."""
        for line in self._log.read_text().splitlines():
            when, service, took, ending = line.split()
            if begin <= float(when) < end:
                yield service, 1000 * float(took), Ending[ending]

    def latencies(self, begin, end):
        """Return the times [ms] of the calls that were answered, by service."""
        found = collections.defaultdict(list)
        for service, took, ending in self.calls(begin, end):
            if ending == Ending.answered:
                found[service].append(took)
        return found


def start_client(*arguments, log):
    with open(log, "w") as output:
        return subprocess.Popen([sys.executable, str(HERE / "clients.py"), *arguments],
                                stdout=output)


def load_log(seed):
    return pathlib.Path("build/soak-load-%d.txt" % seed)


@contextlib.contextmanager
def clients():
    reader = Reader()
    loads = [start_client("load", str(seed), log=load_log(seed)) for seed in range(LOADS)]
    try:
        yield reader
        gone = [p for p in (reader.process, *loads) if p.poll() is not None]
        if gone:
            raise RuntimeError("a client ended: the node did not answer it")
    finally:
        for process in (reader.process, *loads):
            process.terminate()
        for process in (reader.process, *loads):
            end(process)


def end(process):
    try:
        process.wait(DEADLINE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def process_of_node():
    address = rosgraph.Master("/soak").lookupNode("/" + NAME)
    _, _, pid = xmlrpc.client.ServerProxy(address).getPid("/soak")
    return pid


def resident_memory(pid):
    """Return the resident memory of a process [MB]."""
    with open("/proc/%d/status" % pid) as status:
        return next(int(line.split()[1]) / 1000 for line in status if line.startswith("VmRSS"))


def send_mesh(node):
    points, faces, _ = mesh.icosphere(levels=5, line_level=5)
    areas = mesh.areas(mesh.bumpy(points), faces)
    network.send(node, points, mesh.edges_of(faces), faces, areas / areas.sum())


def keep_on(node, service, kind, **fields):
    """Call until it is done, however often memory is too short for it or the answer is lost."""
    while True:
        try:
            return node.call(service, kind, **fields)
        except rospy.ServiceException:
            pass
        except RuntimeError as refusal:
            if "memory" not in str(refusal):
                raise
        time.sleep(0.02)


def run(node, seconds):
    keep_on(node, "set_running", SetBool, data=True)
    time.sleep(seconds)
    keep_on(node, "set_running", SetBool, data=False)


def relax(node, seconds, **fields):
    """Relaxes from the start, again and again."""
    end = time.monotonic() + seconds
    timer = threading.Timer(seconds, keep_on, (node, "cancel", Trigger))
    timer.start()
    while time.monotonic() < end:
        keep_on(node, "reset", Trigger)
        keep_on(node, "relax", Relax, tolerance=1e-30, max_time=max(0.1, end - time.monotonic()),
                **fields)
    timer.join()


TURNS = {
    "running at 1 kHz": run,
    "relaxing, newton": lambda node, seconds: relax(node, seconds, method="newton"),
    "relaxing, dynamics": lambda node, seconds: relax(node, seconds, method="dynamics"),
}


def soak(node, pid, seconds):
    """Return what each turn of each round came to, and how all calls of the reader ended.

    A turn comes to its name, latencies by service, and memory at its end.
    """
    rounds = max(3, round(seconds / (LONGEST_TURN * len(TURNS))))
    turn = seconds / rounds / len(TURNS)
    results = []
    start = time.monotonic()
    with clients() as reader:
        for number in range(rounds):
            for name, work in TURNS.items():
                begin = time.monotonic()
                work(node, turn)
                latencies = reader.latencies(begin, time.monotonic())
                results.append((number, name, latencies, resident_memory(pid)))
                tell(*results[-1])
        endings = collections.Counter(
            ending for _, _, ending in reader.calls(start, time.monotonic()))
    return results, endings


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


def check_endings(endings, short_memory):
    """Tell how the calls ended; exit where none was refused for memory, or one was without need."""
    print("calls of the reader: " + ", ".join("%d %s" % (endings[e], e.name) for e in Ending))
    if short_memory and not endings[Ending.refused]:
        sys.exit("error: no call was refused: the limit of memory did not bite")
    if not short_memory and endings[Ending.answered] != sum(endings.values()):
        sys.exit("error: calls were refused or lost")


def check_scene(node, before):
    """Exit unless the scene holds what it held before, and particles of lost calls at most."""
    after = node.call("get_scene", GetScene)
    lost = sum(len(load_log(seed).read_text().splitlines()) for seed in range(LOADS))
    added = len(after.particle_ids) - len(before.particle_ids)
    print("particles that lost calls have added: %d of %d" % (added, lost))
    if (not 0 <= added <= lost or after.angle_springs != before.angle_springs
            or after.solid_angle_springs != before.solid_angle_springs):
        sys.exit("error: the scene has changed")


def parse():
    parser = argparse.ArgumentParser(prog="scripts/soak", description=__doc__)
    parser.add_argument("seconds", type=float, nargs="?", default=3600)
    parser.add_argument("--short-memory", action="store_true",
                        help="limit the node's memory, with little room that changes all the time")
    return parser.parse_args()


def main(seconds, short_memory):
    os.makedirs("build", exist_ok=True)
    with launched("spherical_springs.launch", "running:=false", log="build/soak-node.log") as node:
        send_mesh(node)
        before = node.call("get_scene", GetScene)
        pid = process_of_node()
        with ShortMemory(pid) if short_memory else contextlib.nullcontext():
            results, endings = soak(node, pid, seconds)
        memory_stayed = sum_up(results)
        check_endings(endings, short_memory)
        check_scene(node, before)
    if not memory_stayed:
        sys.exit("error: memory has grown")


if __name__ == "__main__":
    main(**vars(parse()))
