"""Error against CPU time of a shaken stack, a curve a program, for ``docs/results/peers.md``; needs ``make peers``.

Run it from the project's root as ``python bench/stack_accuracy.py``: three sharp blocks at several steps, as the test
"666" of RaiSim's benchmark has balls. Without the peers it states it and ends well.
"""

import argparse
import sys
import time
from pathlib import Path

import matplotlib

matplotlib.use("agg")

import numpy as np
import peers
from compare_mujoco import ACCELERATION, sharp_stack
from matplotlib import pyplot as plt
from motions import harmonic

from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

DURATION, RATE = 2.0, 250  # s, and Hz of the histories that are compared
STEPS = (4e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5)  # s
REFERENCE_STEP = 1e-5  # s, of our run that all others are held against
STIFFEST = 2.0  # steps: the shortest time constant of MuJoCo's contacts
LABELS = {"blockshake": "blockshake", peers.MUJOCO: "MuJoCo", peers.LMGC90: "LMGC90"}


def main():
    """Measure, print, draw and write."""
    parser = argparse.ArgumentParser(prog="stack_accuracy", description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=Path("docs/results/peers-accuracy.png"))
    output = parser.parse_args().output
    for peer in peers.PROGRAMS:
        if peers.peer_version(peer) is None:
            sys.stdout.write(f"skipped: {peers.MISSING.format(peer)}\n")
            return
    curves = measure(STEPS)
    sys.stdout.write(as_table(curves))
    draw(curves, output)


def measure(steps):
    """CPU seconds of a simulated second and error by program and step, a list of pairs each.

    The error is the largest difference of the top block's displacement over the slab, as a share of its peak.
    """
    structure, motion = sharp_stack(), harmonic(DURATION + 0.1, ACCELERATION)
    times = np.arange(1, round(DURATION * RATE) + 1) / RATE
    ground = motion.evaluate(times)[:, 0] - motion.evaluate(np.zeros(1))[0, 0]
    exact, _ = _ours(structure, motion, REFERENCE_STEP)
    peak = np.abs(exact - ground).max()

    def point(moved, seconds):
        return seconds / DURATION, float(np.abs(moved - exact).max() / peak)

    curves = {"blockshake": [point(*_ours(structure, motion, step)) for step in steps]}
    for peer in peers.PROGRAMS:
        curves[peer] = [point(*_theirs(peer, structure, motion, step)) for step in steps]
    return curves


def _ours(structure, motion, step):
    """Top block along x [m] at the compared times, and CPU time without set-up and compiling [s]."""
    times = np.arange(round(DURATION * RATE) + 1) / RATE
    simulate_nscd(structure, motion, NscdParameters(), times[:2], step)
    spent = []
    for until in (times[:2], times):
        began = time.process_time()
        run = simulate_nscd(structure, motion, NscdParameters(), until, step)
        spent.append(time.process_time() - began)
    return run.position[1:, -1, 0], spent[1] - spent[0]


def _theirs(peer, structure, motion, step):
    """The same of a peer, of whose run no step is left out."""
    steps, every = round(DURATION / step), round(1.0 / RATE / step)
    soft = {"solref": (STIFFEST * step, 1.0)} if peer == peers.MUJOCO else {}
    task = peers.block_task(structure, motion, step, steps, record_every=every, **soft)
    answer = peers.ask_peer(peer, task)
    return answer["position"][:, -1, 0], 1e-6 * steps * float(answer["cpu_us_per_step"])


def as_table(curves):
    """Rows of step, and of CPU time and error of every program, in Markdown."""
    head = ["step [ms]", *(f"{LABELS[name]}, CPU [s/s], error [%]" for name in curves)]
    lines = [head, ["---"] * len(head)]
    for place, step in enumerate(STEPS):
        cells = (f"{pairs[place][0]:.3g}, {100.0 * pairs[place][1]:.2g}" for pairs in curves.values())
        lines.append([f"{1e3 * step:g}", *cells])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def draw(curves, output):
    """Write the figure."""
    figure, axes = plt.subplots(figsize=(5.5, 3.8), layout="constrained")
    for name, pairs in curves.items():
        axes.loglog(*np.transpose([(cost, 100.0 * error) for cost, error in pairs]), "o-", label=LABELS[name])
    axes.set(xlabel="CPU time of a simulated second [s]", ylabel="largest error in 2 s, of the peak [%]")
    axes.legend(fontsize=8)
    axes.grid(alpha=0.3, which="both")
    figure.savefig(output, dpi=110, metadata={"Software": None})
    plt.close(figure)


if __name__ == "__main__":
    main()
