"""Twins of LS-DEM that differ by one part in a million of the motion, by the damping of the shear springs."""

import textwrap

import numpy as np
from motions import NUDGE

from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.markers import block_markers, driven_marker
from blockshake.pages.wording import number, percent, share_words
from blockshake.simulation.simulate import simulate
from blockshake.study.ensembles.ensemble import relative_to_slab

CONFIGURATIONS = ("configuration-1", "configuration-2", "configuration-3", "configuration-4")
SCALES = (1.0, 1.5, 2.0)
RATIOS = (0.0, 0.1, 0.3)
DURATION, TIME_STEP = 10.0, 5e-5  # s


def shear_damping_rows():
    """Peak of any block and largest distance of the twins [mm], a pair for each ratio, by structure and scale."""
    rows = []
    for name in CONFIGURATIONS:
        structure = load_structure(name)
        for scale in SCALES:
            cells = []
            for ratio in RATIOS:
                one, twin = (_moved(structure, scale * factor, ratio) for factor in (1.0, 1.0 + NUDGE))
                cells.append(_peak_and_twin(one, twin))
            rows.append(cells)
    return rows


def shear_damping_words(rows):
    """In how many of the rows twins stay nearer, and peaks differ, with a dashpot than without one."""
    told = []
    for place, ratio in enumerate(RATIOS[1:], start=1):
        pairs = [(row[0], row[place]) for row in rows]
        nearer = sum(damped[1] < plain[1] for plain, damped in pairs)
        moved = max(abs(damped[0] / plain[0] - 1.0) for plain, damped in pairs)
        told.append(
            f"with a ratio of {ratio:g} the twins stay nearer in {share_words(nearer, len(rows))} cases, and the peak "
            f"changes by up to {percent(moved)} %"
        )
    return textwrap.fill(f"{'; '.join(told).capitalize()}.", 100)


def _moved(structure, scale, ratio):
    """Displacement along x of a marker of each block relative to the slab's marker, over time and marker [m]."""
    run = simulate(
        structure, load_motion("basso-tirreno", scale), "ls-dem", {"ls_dem.shear_damping_ratio": ratio},
        time_step=TIME_STEP, duration=DURATION, accelerometers=False,
    )  # fmt: skip
    along = run["marker_displacement"].sel(axis="x")
    markers = list(block_markers(structure).values())
    return relative_to_slab(along, driven_marker(structure)).sel(marker=markers)


def _peak_and_twin(one, twin):
    """Largest displacement, to a tenth, and largest distance, to two digits or a whole one [mm]."""
    return round(1e3 * float(np.abs(one).max()), 1), float(number(1e3 * float(np.abs(one - twin).max()), 2))
