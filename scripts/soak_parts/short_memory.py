"""A limit on the memory of a running process that is drawn anew all the time."""
import random
import resource
import threading

PERIOD = 0.2  # [s]
ROOM = 2e6, 60e6  # [bytes] above what the process has mapped


def virtual_size(pid):
    """Return what a process has mapped, in bytes."""
    with open("/proc/%d/status" % pid) as status:
        return next(1024 * int(line.split()[1]) for line in status if line.startswith("VmSize"))


class ShortMemory:
    """Limits the address space of a process until the block ends, with little room to grow."""

    def __init__(self, pid, seed=0):
        self._pid = pid
        self._choice = random.Random(seed)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._draw)

    def _draw(self):
        while not self._over.wait(PERIOD):
            self._limit(int(virtual_size(self._pid) + self._choice.uniform(*ROOM)))

    def _limit(self, size):
        resource.prlimit(self._pid, resource.RLIMIT_AS, (size, resource.RLIM_INFINITY))

    def __enter__(self):
        self._thread.start()

    def __exit__(self, *_):
        self._over.set()
        self._thread.join()
        self._limit(resource.RLIM_INFINITY)
