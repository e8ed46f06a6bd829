"""Machine of a measurement: the processor and its clock, and the versions of the software."""

import os
import platform
import time
from importlib.metadata import version
from pathlib import Path

import llvmlite.binding
import numba
import numpy as np
from measuring import spread

from blockshake.sources import compiled_sources, source_digest

_CHAIN = 100_000_002  # dependent operations: some 30 ms


def describe_machine():
    """Processor and cores, without a name or an address of the machine."""
    return {
        "processor": _processor(),
        "instruction_set": llvmlite.binding.get_host_cpu_name(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
    }


def describe_versions():
    """Versions of all that has a say in the speed."""
    packages = ("blockshake", "numba", "llvmlite", "numpy")
    return {
        "python": platform.python_version(),
        **{package: version(package) for package in packages},
        "llvm": ".".join(map(str, llvmlite.binding.llvm_version_info)),
        "kernel_source_digest": source_digest(*compiled_sources()),
    }


def _processor():
    information = Path("/proc/cpuinfo")
    if information.is_file():
        for line in information.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor()


def peak_memory():
    """Most memory that this process has held [MiB]; NaN where the system does not say."""
    status = Path("/proc/self/status")
    if status.is_file():
        for line in status.read_text().splitlines():
            if line.startswith("VmHWM"):
                return int(line.split()[1]) / 1024.0
    return float("nan")


@numba.njit
def _shift_and_xor(times, x):
    # six operations, each waiting for the one before: six clock cycles on every usual processor
    for _ in range(times):
        x ^= x << np.uint64(13)
        x ^= x >> np.uint64(7)
        x ^= x << np.uint64(17)
    return x


def measure_clock(repeats):
    """Clock rate of the core at work [GHz]; median and quartiles."""
    rates = []
    _shift_and_xor(1, np.uint64(1))
    for _ in range(repeats):
        started = time.process_time()
        _shift_and_xor(_CHAIN // 6, np.uint64(88172645463325252))
        rates.append(_CHAIN / (time.process_time() - started) / 1e9)
    return spread(rates)
