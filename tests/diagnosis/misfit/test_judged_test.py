"""A measured test with ensembles of two solvers: what is judged, and until when."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.misfit.judged_test import judged_test

TIME = np.arange(101) / 50.0
JOINTS, BODIES = ["slab-a", "a-b"], ["slab", "a", "b"]
RNG = np.random.default_rng(0)


def _histories(rotation, runs=None):
    """Histories in which the upper joint alone turns, ``rotation`` (..., n_times), with readings' noise of 0.1 mrad."""
    rotation = np.asarray(rotation, dtype=float)
    shape = rotation.shape
    still = RNG.normal(0.0, 1e-4, (*shape, 2)) + 0.0 * rotation[..., None]
    turned = still + np.stack([np.zeros(shape), rotation], axis=-1)
    dims = ["run"] * (rotation.ndim - 1) + ["time"]
    found = xr.Dataset(
        {
            "rotation": ((*dims, "joint"), turned),
            "slip": ((*dims, "joint"), still),
            "drift": ((*dims, "body"), np.stack([0.0 * rotation, 0.0 * rotation, 2.0 * rotation], axis=-1)),
        },
        {"time": TIME, "joint": JOINTS, "body": BODIES},
        {"top": "b"},
    )
    for name, dim in (("rotation", "joint"), ("slip", "joint"), ("drift", "body")):
        noise = np.full((*shape[:-1], found.sizes[dim]), 1e-4)
        found[f"{name}_noise"] = ((*dims[:-1], dim), noise)
    return found


def _ensemble(model, nominal, twins):
    found = _histories(np.concatenate([nominal, twins]))
    kinds = ["nominal"] * len(nominal) + ["twin"] * len(twins)
    numbers = [*range(len(nominal)), *range(len(twins))]
    labels = {"kind": ("run", kinds), "number": ("run", numbers)}
    return found.assign_coords(labels).assign_attrs(model=model)


WAVE = 0.02 * np.sin(3.0 * TIME)
NOMINAL = WAVE * (1.0 + 0.1 * RNG.normal(size=(8, 1)))


def _judged(twins, nominal=NOMINAL):
    ensembles = [_ensemble(model, nominal, twins) for model in ("ls-dem", "nscd-rigid")]
    return judged_test("t", _histories(WAVE), ensembles)


def test_joints_that_stay_still_are_not_judged():
    test = _judged(np.repeat(WAVE[None], 3, axis=0))
    assert test.members["nominal"].sizes["run"] == 16
    assert test.models.tolist() == ["ls-dem"] * 8 + ["nscd-rigid"] * 8
    judged = test.judged.any(axis=0)
    assert test.measured["cell"].values[judged].tolist() == ["rotation a-b", "drift b"]
    assert test.judged[:, judged].all()


def test_a_cell_is_judged_until_twins_part_by_what_matters():
    parting = np.where(TIME > 1.0, 1.0, 0.0) * np.array([[0.0], [0.01], [-0.01]])
    horizon = _judged(WAVE + parting).horizon
    assert horizon[1] == horizon[4]
    assert TIME[50] < horizon[1] <= TIME[52]


def test_a_test_is_judged_until_half_the_members_have_fallen():
    fallen = NOMINAL.copy()
    fallen[:5, 40:] = np.nan
    test = _judged(np.repeat(WAVE[None], 3, axis=0), fallen)
    assert test.horizon.max() == TIME[39]
