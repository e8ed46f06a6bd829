"""Residuals of measured joints against an ensemble by joint, phase, quantity and side, and their code word."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.stats import t as student

from blockshake.diagnosis.features.phases import PHASES, known_values

QUANTITIES = ("slip", "rotation", "opening")
SIDES = ("+", "-")
_LEVEL = 0.05  # chance of any cell beyond the limit where nothing is missing
_ONE_SIDED = 0.5  # of (difference of the sides) over (sum of their magnitudes)
_ONE_JOINT = 0.7  # of all residuals that a joint must have to be the only one


@dataclass(frozen=True)
class CodeWord:
    """Structure of a residual, to be held against the signatures of effects.

    Attributes
    ----------
    phase : str
        First phase with a residual: ``quiet``, ``strong``, ``after`` or ``none``.
    symmetry : str
        ``both`` sides alike, ``one-sided``, or ``none``.
    profile : str
        Over the joints from below: ``one`` joint, ``rising``, ``falling``, ``even``, or ``none``.
    law : str
        Over the tests by intensity: ``proportional``, ``faster``, ``slower``, ``threshold`` (only in stronger
        tests), ``unknown`` with one test, or ``none``.
    joint, quantity : str
        With the largest standardised residual; empty where there is none.
    """

    phase: str
    symmetry: str
    profile: str
    law: str
    joint: str
    quantity: str


def residual_atlas(measured, members):
    """Standardised residuals of the motion in every phase to each side.

    Parameters
    ----------
    measured : xarray.Dataset
        From `read_off`.
    members : xarray.Dataset
        Histories of simulated tests, along ``draw``, with the noise of the measurement.

    Returns
    -------
    xarray.Dataset
        Over (joint, phase, quantity, side): ``measured``, root mean square over the phase of the part to that side,
        ``mean`` and ``sd`` over the members [m, rad], ``residual`` = (measured - mean) / (sd sqrt(1 + 1 / n)) [1];
        positive: the measured joint moved farther than simulated. ``limit``: magnitude that any cell exceeds in 5 of
        100 cases where nothing is missing. NaN where the phase has no time or nobody can know. Attribute
        ``intensity``: peak acceleration of the base [m/s2].

    Notes
    -----
    The phases are the measured ones for all. The members hold the noise, so that ``sd`` does. The limit is Student's
    with n - 1 degrees of freedom, Bonferroni's over the cells that are known: for Gaussian members; a heavy tail needs
    the rank test. Sizes are mean squares and not peaks, whose noise has a long tail.
    """
    own = _sizes(measured.expand_dims("draw"), measured["phase"].to_numpy())[0]
    others = _sizes(members.sel(time=measured["time"]), measured["phase"].to_numpy())
    count = len(others)
    mean, spread = others.mean(axis=0), others.std(axis=0, ddof=1)
    known = np.isfinite(own) & (spread > 0.0)
    residual = (own - mean) / np.where(known, spread * np.sqrt(1.0 + 1.0 / count), np.nan)
    dims = ("joint", "phase", "quantity", "side")
    return xr.Dataset(
        {
            "measured": (dims, own),
            "mean": (dims, mean),
            "sd": (dims, spread),
            "residual": (dims, residual),
            "limit": ((), _limit(int(known.sum()), count)),
        },
        {
            "joint": measured["joint"].values,
            "phase": list(PHASES),
            "quantity": list(QUANTITIES),
            "side": list(SIDES),
        },
        {
            "intensity": float(np.abs(measured["acceleration"]).max()),
            "members": count,
            "cells": int(known.sum()),
        },
    )


def code_word(atlases):
    """`CodeWord` of the residuals of several tests.

    Parameters
    ----------
    atlases : sequence of xarray.Dataset
        From `residual_atlas`, of tests of one structure.

    Notes
    -----
    The limit is Bonferroni's over the cells of all tests. Phase, symmetry and profile are read off the test with the
    largest residual, in the first phase in which any test goes beyond it, for the quantity that does so most. The law
    is the slope of ln|measured - mean| over ln(intensity) of that cell: proportional within 0.5 of 1.
    """
    limit = _limit(
        sum(atlas.attrs["cells"] for atlas in atlases), min(atlas.attrs["members"] for atlas in atlases)
    )
    beyond = [atlas["residual"].where(abs(atlas["residual"]) > limit, 0.0) for atlas in atlases]
    phase = next(
        (name for name in PHASES if any(abs(part.sel(phase=name)).max() > 0.0 for part in beyond)), None
    )
    if phase is None:
        return CodeWord("none", "none", "none", "none", "", "")
    here = [abs(part.sel(phase=phase)) for part in beyond]
    test = int(np.argmax([float(part.max()) for part in here]))
    joint, quantity, side = np.unravel_index(int(here[test].values.argmax()), here[test].shape)
    residual = atlases[test]["residual"].fillna(0.0).sel(phase=phase).isel(quantity=quantity)
    pair = residual.isel(joint=joint).to_numpy()
    sided = abs(pair[0] - pair[1]) > _ONE_SIDED * np.abs(pair).sum()
    cells = [atlas.sel(phase=phase).isel(joint=joint, quantity=quantity, side=side) for atlas in atlases]
    return CodeWord(
        phase, "one-sided" if sided else "both", _profile(abs(residual).max("side").to_numpy()), _law(cells, limit),
        str(residual["joint"].values[joint]), QUANTITIES[quantity],
    )  # fmt: skip


def _limit(cells, members):
    """Magnitude that none of so many standardised residuals exceeds in 95 of 100 cases."""
    return float(student.ppf(1.0 - 0.5 * _LEVEL / max(cells, 1), members - 1))


def _sizes(histories, phases):
    """Root mean squares of the parts to each side, (n_draws, n_joints, n_phases, n_quantities, 2); NaN if unknown."""
    read = [histories[name].transpose("draw", "joint", "time").to_numpy() for name in QUANTITIES]
    values = np.stack(read).astype(float)
    found = np.full((*values.shape[1:3], len(PHASES), len(QUANTITIES), 2), np.nan)
    for quantity, draw, joint in np.ndindex(values.shape[:3]):
        history = values[quantity, draw, joint]
        if not np.isfinite(history).any():
            continue
        history = known_values(history)
        for place in range(len(PHASES)):
            part = history[phases == place]
            if len(part):
                found[draw, joint, place, quantity] = [
                    np.sqrt((np.maximum(sign * part, 0.0) ** 2).mean()) for sign in (1.0, -1.0)
                ]
    return found


def _profile(sizes):
    """Profile of the residuals over the joints from below."""
    if sizes.max() >= _ONE_JOINT * sizes.sum():
        return "one"
    change = np.diff(sizes)
    if np.ptp(sizes) <= 0.5 * sizes.max():
        return "even"
    return "rising" if (change >= 0.0).all() else "falling" if (change <= 0.0).all() else "even"


def _law(cells, limit):
    """Growth of one cell's residual with the intensity of the tests."""
    cells = sorted(cells, key=lambda cell: cell.attrs["intensity"])
    intensity = np.array([cell.attrs["intensity"] for cell in cells])
    if len(cells) < 2 or intensity[-1] < 1.2 * intensity[0]:
        return "unknown"
    seen = np.array([abs(float(cell["residual"])) > limit for cell in cells])
    if not seen[0] and seen[-1]:
        return "threshold"
    if seen.sum() < 2:
        return "unknown"
    size = np.array([abs(float(cell["measured"] - cell["mean"])) for cell in cells])
    exponent = np.polyfit(np.log(intensity[seen]), np.log(size[seen]), 1)[0]
    return "proportional" if abs(exponent - 1.0) <= 0.5 else "faster" if exponent > 1.0 else "slower"
