"""Which part of the core's peak arithmetic the contact kernel reaches.

Operations are counted in the machine code that the compiler made of `contact_forces_into`, in its
innermost loops: one for every element of each addition, subtraction, multiplication, division,
square root, minimum and maximum, two for a fused multiply-add. Comparisons, selections, moves and
conversions do not count. An iteration of such a loop is a packet of nodes.
"""

import re
from collections import Counter

import numba
import numpy as np
from force_evaluation import assembled_stack
from measuring import process_seconds, spread
from numba.core.caching import NullCache

from blockshake.jit import kernel
from blockshake.solvers.ls_dem.contact.contact_forces import contact_forces_into
from blockshake.solvers.ls_dem.contact.packets import LANES
from blockshake.solvers.ls_dem.parameters import LsDemParameters

_LABEL = re.compile(r"^([.\w$@]+):")
_INSTRUCTION = re.compile(r"^\t([a-z]\w*)\s*(.*)")
_OPERATION = re.compile(r"^v?(?:(add|sub|mul|div|sqrt|min|max)|(fn?m(?:add|sub)\d*))([ps])d$")
_GATHER = re.compile(r"^vp?gather")
_WIDTH = {"x": 2, "y": 4, "z": 8}  # numbers in a vector register of this letter
_FEWEST = 20  # packed operations of a loop that is arithmetic and not copying


def count_operations():
    """Operations for a node in each innermost loop of the contact kernel.

    Returns
    -------
    list of dict
        ``operations_per_node``, ``packed_share`` of them in vector instructions, ``vector_bits``
        of the widest and ``gathers``: whether the loop looks up a grid.
    """
    compiled = kernel(contact_forces_into)
    compiled._cache = NullCache()  # Numba shows no machine code of a kernel that it loaded
    compiled(*assembled_stack(LsDemParameters()))
    return [loop for loop in map(operations, _innermost_loops(compiled)) if loop is not None]


def _innermost_loops(compiled):
    """Instructions of each loop that holds no other, as (name, operands)."""
    labels, instructions = {}, []
    for line in compiled.inspect_asm(compiled.signatures[0]).splitlines():
        if label := _LABEL.match(line):
            labels[label[1]] = len(instructions)
        elif instruction := _INSTRUCTION.match(line):
            instructions.append(instruction.groups())
    loops = [
        (labels[target], place)
        for place, (name, target) in enumerate(instructions)
        if name.startswith("j") and labels.get(target, place + 1) <= place
    ]
    # a loop entered in two ways shows as two that overlap: the first to end stands for it
    loops.sort(key=lambda loop: loop[1])
    innermost, end = [], -1
    for start, stop in loops:
        if start > end:
            innermost.append(instructions[start : stop + 1])
            end = stop
    return innermost


def operations(instructions):
    """Operations of a loop's instructions, as in `count_operations`; None where it hardly calculates."""
    packed, scalar, bits = Counter(), 0, 0
    for name, operands in instructions:
        operation = _OPERATION.match(name)
        if operation is None:
            continue
        weight = 2 if operation[2] else 1
        if operation[3] == "p":
            width = _WIDTH[re.search(r"%([xyz])mm", operands)[1]]
            packed[width] += weight * width
            bits = max(bits, 64 * width)
        else:
            scalar += weight
    if sum(packed.values()) < _FEWEST:
        return None
    total = sum(packed.values()) + scalar
    return {
        "operations_per_node": total / LANES,
        "packed_share": sum(packed.values()) / total,
        "vector_bits": bits,
        "gathers": any(_GATHER.match(name) for name, _ in instructions),
    }


def _polynomials(times, points, values):
    # three at a time: enough independent operations to hide the latency of each
    for _ in range(times):
        for i in range(points.size):
            x = points[i]
            a = b = c = x
            for _ in range(16):
                a = a * x + 0.5
                b = b * x + 0.25
                c = c * x + 0.125
            values[i] = a + b + c


def measure_peak(repeats, times=20_000):
    """Most operations a second that a core does in compiled Python [1e9/s].

    Returns
    -------
    dict
        ``fused``: with fused multiply-adds, the peak; ``separate``: without, as the project
        compiles its kernels so that results do not depend on the processor.
    """
    points = np.linspace(-0.4, 0.4, 256)  # in the first cache
    values = np.empty_like(points)
    operations = times * points.size * (16 * 6 + 2)
    peaks = {}
    for name, flags in (("fused", {"contract"}), ("separate", False)):
        compiled = numba.njit(error_model="numpy", fastmath=flags)(_polynomials)
        compiled(1, points, values)
        seconds = [process_seconds(compiled, times, points, values) for _ in range(repeats)]
        peaks[name] = spread(1e-9 * operations / np.array(seconds))
    return peaks


def measure_arithmetic(repeats, ns_per_node):
    """Peak, operations a node, and the share of the peak at this cost of a node [ns]."""
    loops = count_operations()
    peak = measure_peak(repeats)
    per_node = sum(loop["operations_per_node"] for loop in loops if not loop["gathers"])
    return {
        "loops": loops,
        "operations_per_node": per_node,
        "peak_gflops": peak,
        "reached_gflops": per_node / ns_per_node,
        "share_of_peak": per_node / ns_per_node / peak["fused"]["median"],
    }
