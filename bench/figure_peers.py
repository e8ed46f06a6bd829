"""Figure of ``docs/results/peers.md``: nine blocks in LMGC90 and here, and three in MuJoCo; needs ``make peers``.

Run it from the project's root as ``python bench/figure_peers.py``; without the peers it states it and ends well.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("agg")

import numpy as np
import peers
from compare_mujoco import ACCELERATION, SETTINGS, sharp_stack
from matplotlib import pyplot as plt
from motions import harmonic
from nscd_step import TIME_STEP

from blockshake.geometry.structure import load_structure
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

EVERY = 5  # steps of 1 ms between points


def main():
    """Draw and write."""
    parser = argparse.ArgumentParser(prog="figure_peers", description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=Path("docs/results/peers.png"))
    output = parser.parse_args().output
    for peer in (peers.LMGC90, peers.MUJOCO):
        if peers.peer_version(peer) is None:
            sys.stdout.write(f"skipped: {peers.MISSING.format(peer)}\n")
            return
    figure, rows = plt.subplots(2, 2, figsize=(10, 5), sharex="col", layout="constrained")
    _nine_blocks(rows[:, 0])
    _three_blocks(rows[:, 1])
    for axes in rows[1]:
        axes.set_xlabel("time [s]")
    rows[0, 0].set_ylabel("top block over the slab [mm]")
    rows[1, 0].set_ylabel("difference [mm]")
    for axes in rows.flat:
        axes.legend(fontsize=8, framealpha=0.6)
        axes.grid(alpha=0.3)
    figure.savefig(output, dpi=110, metadata={"Software": None})
    plt.close(figure)


def _top(structure, motion, duration, time_step=TIME_STEP):
    """Our top block over the slab, from 5 ms on [mm]."""
    time = EVERY * TIME_STEP * np.arange(round(duration / TIME_STEP / EVERY) + 1)
    run = simulate_nscd(structure, motion, NscdParameters(), time, time_step)
    return time[1:], 1e3 * (run.position[1:, -1, 0] - run.position[1:, 0, 0])


def _peer_top(peer, structure, motion, duration, **options):
    """The same in a peer."""
    steps = round(duration / TIME_STEP)
    task = peers.block_task(structure, motion, TIME_STEP, steps, record_every=EVERY, **options)
    position = peers.ask_peer(peer, task)["position"]
    return 1e3 * (position[:, -1, 0] - position[:, 0, 0])


def _nine_blocks(axes):
    structure, motion = load_structure("configuration-3"), harmonic(10.1)
    time, ours = _top(structure, motion, 10.0)
    theirs = _peer_top(peers.LMGC90, structure, motion, 10.0)
    axes[0].set_title("configuration 3, 1 Hz, 1.5 m/s2, dt 1 ms", fontsize=10)
    axes[0].plot(time, ours, label="blockshake")
    axes[0].plot(time, theirs, "--", label="LMGC90")
    axes[1].plot(time, theirs - ours, label="LMGC90 less blockshake")


def _three_blocks(axes):
    structure, motion = sharp_stack(), harmonic(3.1, ACCELERATION)
    time, exact = _top(structure, motion, 3.0, 1e-4)
    runs = {"blockshake, 1 ms": _top(structure, motion, 3.0)[1]}
    for name, setting in SETTINGS.items():
        runs[f"MuJoCo, {name}"] = _peer_top(peers.MUJOCO, structure, motion, 3.0, **setting)
    axes[0].set_title(f"three sharp blocks, 1 Hz, {ACCELERATION:g} m/s2", fontsize=10)
    axes[0].plot(time, exact, "k", label="blockshake, 0.1 ms")
    for name, moved in runs.items():
        axes[0].plot(time, moved, "--", label=name)
        axes[1].plot(time, moved - exact, label=f"{name}, less 0.1 ms")


if __name__ == "__main__":
    main()
