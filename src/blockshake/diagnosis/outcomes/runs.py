"""Simulated outcomes: how far a body leans in every test by models drawn over all unknowns, until it falls."""

from dataclasses import dataclass

import numpy as np
import scipy
import xarray as xr

from blockshake.diagnosis.nominal.nominal_model import MODELS
from blockshake.diagnosis.outcomes.unknowns import UNKNOWNS, model_at
from blockshake.dynamics.intensity import motion_figures
from blockshake.dynamics.load_motion import load_motion, scaled
from blockshake.dynamics.motion import GroundMotion
from blockshake.dynamics.system import FALLEN, FINISHED
from blockshake.files import named_file
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.checks.outcomes import standing_body
from blockshake.simulation.simulate import simulate
from blockshake.store import Unit

BATCH = 25  # tests
_KEPT_RATE = 50.0  # Hz, of the orientations that are kept
_SEED = 42


def solvers_of(draws):
    """Solvers by which tests are simulated: with few draws the one that takes longer steps alone."""
    return MODELS if draws > 4 else ("nscd-rigid",)


def shares_of(number, draws):
    """Shares of the models of a test, by its number: the structure file's first, then Halton's next, (draws, n)."""
    sequence = scipy.stats.qmc.Halton(len(UNKNOWNS), seed=_SEED)
    sequence.fast_forward(number * (draws - 1))
    return np.vstack([np.zeros(len(UNKNOWNS)), 2.0 * sequence.random(draws - 1) - 1.0])


def simulate_outcomes(campaign, batch, solver, draws, store):
    """Outcomes of a batch of tests by some models each; each run ends at the fall, and is kept at once.

    Parameters
    ----------
    campaign : Campaign
        Of outcomes, which are not read.
    batch : int
        Number of the batch of `BATCH` tests, in the campaign's order.
    solver : str
    draws : int
        Models of each test.
    store : Store

    Returns
    -------
    xarray.Dataset
        Along ``test`` and ``draw``: ``lean``, the largest angle between the body's first vertical and its own until
        the end [rad], infinite of a body that fell and NaN of a run that was not finished; ``settled``: the body
        moved before the ground did; ``share(test, draw, unknown)``. Along ``test``: ``pga`` [m/s2] and ``pgv`` [m/s]
        of the commanded motion along x.
    """
    structure = load_structure(campaign.structure)
    body = standing_body(structure)
    names = list(campaign.tests)[batch * BATCH : (batch + 1) * BATCH]
    leans, moved, shares, peaks = [], [], [], []
    for done, name in enumerate(names):
        entry = campaign.tests[name]
        shares.append(shares_of(batch * BATCH + done, draws))
        path = campaign.folder / entry.motion
        path = path if path.is_file() else named_file("motions", entry.motion)
        motion = load_motion(path, baseline=entry.baseline)
        figures = motion_figures(scaled(motion, entry.scale, path))
        peaks.append((figures["peak_acceleration"], figures["peak_velocity"]))
        for number, own in enumerate(shares[-1]):
            made, settled = store.value(_Outcome(structure, body, motion, entry.scale, solver, own))
            how = {"inf": "fell", "nan": "not finished"}.get(
                f"{made:g}", f"leant by {np.degrees(made):.2g} degrees"
            )
            store.say(f"{name} {solver} model {number} {done + 1}/{len(names)}: {how} {settled}".rstrip())
            leans.append(made)
            moved.append(bool(settled))
    return xr.Dataset(
        {
            "lean": (("test", "draw"), np.reshape(leans, (len(names), draws)), {"units": "rad"}),
            "settled": (("test", "draw"), np.reshape(moved, (len(names), draws))),
            "share": (("test", "draw", "unknown"), shares),
            "pga": ("test", [peak for peak, _ in peaks], {"units": "m s-2"}),
            "pgv": ("test", [peak for _, peak in peaks], {"units": "m s-1"}),
        },
        {"test": names, "unknown": [unknown.name for unknown in UNKNOWNS]},
        {"model": solver},
    )


@dataclass(frozen=True)
class _Outcome(Unit):
    """Largest lean [rad] of one run, see `simulate_outcomes`, and what moved before the ground did, in words."""

    structure: Structure
    body: int
    motion: GroundMotion  # of scale 1
    scale: float
    solver: str
    shares: np.ndarray  # of the unknowns

    def made(self, checkpoint):
        built, factor = model_at(self.structure, self.body, self.solver, self.shares)
        motion = scaled(self.motion, self.scale * factor, self.motion.name)
        run = simulate(built, motion, self.solver, output_rate=_KEPT_RATE, accelerometers=False)
        if run.attrs["status"] not in FINISHED:
            return np.nan, run.attrs["settled"]
        if run.attrs["status"] in FALLEN:
            return np.inf, run.attrs["settled"]
        turned = rotation_matrices(run["orientation"][:, self.body].to_numpy())
        lean = np.arccos(np.clip(np.einsum("nk,k->n", turned[:, 2], turned[0, 2]), -1.0, 1.0)).max()
        return float(lean), run.attrs["settled"]
