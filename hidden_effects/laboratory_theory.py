"""MuJoCo's laboratory held against theory: free rocking, sliding and overturning of one block.

``python hidden_effects/laboratory_theory.py`` prints the table and writes it to docs/results/hidden-effects.md.
"""

import sys
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from case_files import PAGE
from mujoco_case import EVERY, TIME_STEP, run_laboratory
from scipy.integrate import solve_ivp
from track_record_text import with_block

from blockshake.files import write_text

G, DENSITY = 9.81, 2400.0  # m/s2, kg/m3
ROCKING, FLAT, SLENDER = (0.4, 1.2, 2.0), (1.6, 2.4, 0.8), (0.24, 1.2, 2.4)  # m, edges of a block
CHAMFER = 0.02  # m
FALLEN = 1.2  # rad
_SHARE = 1.5  # of the acceleration of uplift, in a pulse that overturns
_STEPS = 6  # of the bisection on its duration


class Rigid(NamedTuple):
    """A block that rocks about its edges."""

    half_width: float  # [m]
    half_height: float  # [m]
    frequency: float  # of rocking, ``p`` [rad/s]
    kept: float  # share of its turning that an impact keeps, Housner (1963)

    @property
    def angle(self):
        """Angle of the diagonal, at which it overturns [rad]."""
        return float(np.arctan(self.half_width / self.half_height))


def rigid(box):
    """`Rigid` of a block; its chamfers take 1 % off its mass, which is left out."""
    b, h = 0.5 * box[0] - CHAMFER, 0.5 * box[2]
    central = (box[0] ** 2 + box[2] ** 2) / 12.0
    about_edge = central + b**2 + h**2
    return Rigid(b, h, float(np.sqrt(G * np.hypot(b, h) / about_edge)), (central + h**2 - b**2) / about_edge)


def block_task(
    duration, acceleration=0.0, box=ROCKING, friction=0.75, tilt=0.0, pitch=0.0, blocks=1, **joint
):
    """Task of equal blocks on a slab, at rest or tilted about an edge.

    Parameters
    ----------
    duration : float
        [s]
    acceleration, pitch : float or float64 array, shape (n_steps,)
        The table along x [m/s2] and about y [rad].
    box : tuple of float
        Edges of a block [m].
    friction : float
    tilt : float
        About the edge at +x [rad].
    blocks : int
    **joint
        Entries of every joint, such as ``compliance``.
    """
    steps = round(duration / TIME_STEP)
    x, turned = (np.broadcast_to(values, steps).astype(float) for values in (acceleration, pitch))
    half = 0.5 * np.array(box)
    edge, cosine, sine = half[0] - CHAMFER, np.cos(tilt), np.sin(tilt)
    at = edge - cosine * edge + sine * half[2], sine * edge + cosine * half[2]
    names = [f"block-{number + 1}" for number in range(blocks)]
    kept, plain = np.zeros(steps // EVERY + 1), {"density": DENSITY, "mass_offset": [0.0] * 3}
    return {
        "slab": {
            "name": "slab", "box": [3.0, 3.0, 0.2], "chamfer": 0.0, "position": [0.0, 0.0, -0.1], "compliance": 0.0,
            "damping": 0.0, **plain,
        },
        "bodies": [
            {"name": name, "box": list(box), "chamfer": CHAMFER, **plain,
             "position": [0.0, 0.0, (2 * number + 1) * half[2]]}
            for number, name in enumerate(names)
        ],
        "joints": [
            {"lower": lower, "upper": upper, "friction": friction, "compliance": 0.0, "damping_ratio": 1.0,
             "law": None} | joint
            for lower, upper in zip(["slab", *names], names, strict=False)
        ],
        "sensors": [{"body": "slab", "position": [0.0] * 3}, {"body": "block-1", "position": [0.0] * 3}],
        "tests": [{
            "poses": [
                [at[0], 0.0, at[1] + 2 * number * half[2], np.cos(0.5 * tilt), 0.0, np.sin(0.5 * tilt), 0.0]
                for number in range(blocks)
            ],
            "most_tilt": FALLEN, "forces": [], "chamfers": dict.fromkeys(names, CHAMFER), "at_once": bool(tilt),
            "motion": {"x": x, "z": np.zeros(steps), "pitch": turned, "moved_x": kept, "moved_z": kept},
        }],
    }  # fmt: skip


def tilt_of(pose):
    """Tilt about y of a body's poses (n_times, 7) [rad]."""
    return 2.0 * np.arctan2(pose[:, 5], pose[:, 3])


def free_rocking():
    """Time of the first impact [s] and shares of the energy that the first four impacts keep: found and of theory."""
    block = rigid(ROCKING)
    start = 0.5 * block.angle
    found = tilt_of(run_laboratory(block_task(4.0, tilt=start))["0-pose"][:, 1])
    time = TIME_STEP * EVERY * np.arange(len(found))

    def fall(_, state):
        return state[1], -(block.frequency**2) * np.sin(block.angle - state[0])

    def upright(_, state):
        return state[0]

    upright.terminal = True
    own = solve_ivp(fall, (0.0, 4.0), (start, 0.0), events=upright, rtol=1e-9, atol=1e-12)
    impacts = time[1:][np.diff(np.sign(found)) != 0]
    peaks = [start, *(np.abs(found[(time > one) & (time < other)]).max() for one, other in pairwise(impacts))]
    energy = np.cos(block.angle - np.array(peaks[:5])) - np.cos(block.angle)
    return (impacts[0], own.t_events[0][0]), (energy[1:] / energy[:-1], block.kept**2)


def creep_and_slide():
    """Way in 1 s at 0.95 of the limit of friction [m], and at 3 m/s2: found, and found and of theory."""
    mu, acceleration = 0.15, 3.0
    held, moved = (
        run_laboratory(block_task(1.0, one, FLAT, mu))["0-pose"][:, 1, 0]
        for one in (0.95 * mu * G, acceleration)
    )
    return np.abs(held - held[0]).max(), (moved[0] - moved[-1], 0.5 * (acceleration - mu * G))


def uplift():
    """Tilts at 0.98 and 1.02 of the acceleration at which theory lets a block uplift [rad]."""
    limit = G * np.tan(rigid(ROCKING).angle)
    return [float(run_laboratory(block_task(0.5, share * limit))["0-tilt"]) for share in (0.98, 1.02)]


def overturning_pulse():
    """Shortest rectangular pulse of 1.5 times the acceleration of uplift that overturns [s]: found and of theory.

    Housner (1963), for small angles: ``cosh(p t) = 1 + 1 / (2 x (x - 1))``, x the acceleration over that of uplift.
    """
    block = rigid(SLENDER)
    long = np.arccosh(1.0 + 1.0 / (2.0 * _SHARE * (_SHARE - 1.0))) / block.frequency
    low, high = 0.8 * long, 1.2 * long
    time = TIME_STEP * np.arange(round(4.0 / TIME_STEP))
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        pulse = np.where(time < middle, -_SHARE * G * np.tan(block.angle), 0.0)
        fell = float(run_laboratory(block_task(4.0, pulse, SLENDER))["0-factor"]) < 1.0
        low, high = (low, middle) if fell else (middle, high)
    return 0.5 * (low + high), long


def as_markdown():
    """The table of the page."""
    (impact, of_theory), (ratios, kept) = free_rocking()
    creep, (way, coulomb) = creep_and_slide()
    below, above = uplift()
    shortest, housner = overturning_pulse()
    rows = [
        ("free rocking from half of the overturning angle: first impact", f"{impact:.4f} s", f"{of_theory:.4f} s"),
        (
            "the same: energy kept by the first four impacts",
            ", ".join(f"{ratio:.3f}" for ratio in ratios), f"{kept:.3f} each",
        ),
        ("way in 1 s at 0.95 of the limit of friction", f"{1e6 * creep:.1f} µm", "0"),
        ("way in 1 s at 3 m/s2, friction 0.15", f"{way:.4f} m", f"{coulomb:.4f} m"),
        ("tilt at 0.98 of the acceleration of uplift", f"{1e3 * below:.4f} mrad", "0"),
        ("tilt in 0.5 s at 1.02 of it", f"{1e3 * above:.2f} mrad", "above 0"),
        ("shortest pulse of 1.5 times it that overturns", f"{shortest:.3f} s", f"{housner:.3f} s"),
    ]  # fmt: skip
    lines = ["| one block in MuJoCo's laboratory | found | theory |", "|---|---|---|"]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])


if __name__ == "__main__":
    table = as_markdown()
    sys.stdout.write(table + "\n")
    write_text(PAGE, with_block(PAGE.read_text(encoding="utf-8"), "laboratory", table))
