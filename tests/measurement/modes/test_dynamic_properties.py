"""Modes against the eigenvalues of the chains that made the records, and none where there is none."""

import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from shear_chain import FINE, answer, exact, reading, states, stiffness, system, white

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.modes.dynamic_properties import modes_from_noise
from blockshake.measurement.sensors.accelerometers import low_pass

SHARED = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[4] / "shared"))
DURATION = 30.0
# Frequencies are asked for within 0.5 % and within 3.5 stated errors: of some 20 figures in these tests one would miss
# 3.5 sigma in a hundred seeds.
SIGMAS, SHARE = 3.5, 0.005


@pytest.fixture(scope="module")
def structure(make_structure):
    bodies = [
        {"name": f"mass-{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(8)
    ]
    markers = [{"name": "slab-face", "body": "slab", "position": [1.5, 0.0, 0.0]}]
    markers += [{"name": f"mass-{i}", "body": f"mass-{i}", "position": [0.4, 0.0, 0.0]} for i in range(8)]
    sensors = [{"name": "slab-acc", "body": "slab", "position": [1.5, 0.0, 0.0], "axes": ["x"]}]
    sensors += [
        {"name": f"mass-{i}-acc", "body": f"mass-{i}", "position": [0.4, 0.0, 0.0], "axes": ["x"]}
        for i in range(8)
    ]
    return make_structure(bodies, markers=markers, accelerometers=sensors)


def _chain(springs, damping):
    K = stiffness(springs)
    return system(np.ones(len(springs)), K, damping(K))


def _proportional(K):
    """Rayleigh: damping ratios alpha / (2 w) + beta w / 2."""
    return 0.5 * np.eye(len(K)) + 2e-4 * K


def _lumped(K):
    """A dashpot at the first mass alone: no real modes."""
    C = np.zeros_like(K)
    C[0, 0] = 3.0
    return C


def _check(found, frequency, damping):
    assert found.sizes["mode"] == len(frequency), found.attrs["finding"]
    np.testing.assert_allclose(found["frequency"], frequency, rtol=SHARE)
    for name, true in (("frequency", frequency), ("damping_ratio", damping)):
        pull = (found[name].to_numpy() - true) / found[f"{name}_error"].to_numpy()
        assert np.abs(pull).max() < SIGMAS, (name, pull)


@pytest.mark.parametrize("springs", [[6000.0, 6000.0], [6000.0, 6000.0, 6000.0]])
@pytest.mark.parametrize("damping", [_proportional, _lumped])
def test_chains_have_the_eigenvalues_of_their_matrices(springs, damping, structure):
    """Poles of the state matrix (complex eigenvalues), 1 um noise, 1 m/s2 rms to 80 Hz."""
    A, B = _chain(springs, damping)
    acceleration, displacement = white(3, DURATION, 1.0)
    noise = 1e-6
    found = modes_from_noise(
        reading(displacement, answer(A, B, acceleration), noise, 3), structure, noise, 0.02
    )
    frequency, ratio, shape = exact(A)
    _check(found, frequency, ratio)
    x = found["shape"].sel(axis="x").to_numpy()
    error = found["shape_error"].sel(axis="x").to_numpy()
    np.testing.assert_array_equal(x[:, 0], 0.0)  # relative to the base
    np.testing.assert_array_less(np.abs(x[:, 1:] - shape.real), SIGMAS * error[:, 1:] + 1e-12)
    assert (found["coherence"].sel(axis="x")[:, 1:] > 0.5).all()


def test_without_noise_it_is_exact(structure):
    """No leakage and no window: 1e-5 of the frequency, 1e-3 of the damping, which is what sampling at 200 Hz leaves."""
    A, B = _chain([6000.0, 6000.0, 6000.0], _proportional)
    acceleration, displacement = white(1, DURATION, 1.0)
    found = modes_from_noise(reading(displacement, answer(A, B, acceleration), 0.0, 1), structure, 0.0, 0.0)
    frequency, damping, _ = exact(A)
    np.testing.assert_allclose(found["frequency"], frequency, rtol=1e-5)
    np.testing.assert_allclose(found["damping_ratio"], damping, rtol=1e-3)


def test_closely_spaced_modes(structure):
    """A small mass tuned to the big one (Den Hartog's absorber): two modes 5 % apart, 2 % damped, each seen apart."""
    mass, w = np.array([1.0, 2.5e-3]), 2.0 * np.pi * 6.0
    K = w**2 * np.array([[1.0 + 2.5e-3, -2.5e-3], [-2.5e-3, 2.5e-3]])
    A, B = system(mass, K, 2.0 * 0.01 / w * K)
    frequency, damping, _ = exact(A)
    assert frequency[1] / frequency[0] < 1.06
    acceleration, displacement = white(5, DURATION, 1.0)
    noise = 1e-5
    _check(
        modes_from_noise(reading(displacement, answer(A, B, acceleration), noise, 5), structure, noise, 0.0),
        frequency,
        damping,
    )


@pytest.mark.slow
def test_stated_errors_are_the_scatter(structure):
    """One mass, the paper's 0.1 mm noise, 12 seeds: the mean square of the pulls is 1, +- 4 sqrt(2 / 12)."""
    A, B = _chain([1200.0], _proportional)
    frequency, damping, _ = exact(A)
    pulls = []
    for seed in range(12):
        acceleration, displacement = white(seed, DURATION, 1.0)
        found = modes_from_noise(
            reading(displacement, answer(A, B, acceleration), 1e-4, seed), structure, 1e-4, 0.0
        )
        assert found.sizes["mode"] == 1
        pulls.append(
            [
                (found["frequency"][0] - frequency[0]) / found["frequency_error"][0],
                (found["damping_ratio"][0] - damping[0]) / found["damping_ratio_error"][0],
            ]
        )
    square = (np.array(pulls) ** 2).mean(axis=0)
    assert (square < 1.0 + 4.0 * np.sqrt(2.0 / 12)).all()
    assert (square > 0.1).all()  # nor larger than it: chi2(12) / 12 is below 0.1 once in 1e5


@pytest.mark.parametrize("seed", range(5))
def test_noise_alone_has_no_mode(seed, structure):
    """Eight rigid blocks on a moving base read with 0.1 mm noise, once in a thousand a mode by chance."""
    _, displacement = white(seed, DURATION, 1.0)
    found = modes_from_noise(
        reading(displacement, np.zeros((len(displacement), 8)), 1e-4, seed), structure, 1e-4, 0.02
    )
    assert found.sizes["mode"] == 0
    assert found.attrs["finding"].startswith("no mode from 0.5")


def test_a_rigid_run_has_no_mode(structure):
    """Exact copies of the base, the rounding of a float apart, and a gain that is 1 % off: static, no mode."""
    _, displacement = white(2, DURATION, 1.0)
    relative = (
        1e-9 * np.random.default_rng(0).normal(size=(len(displacement), 3)) + 0.01 * displacement[:, None]
    )
    found = modes_from_noise(reading(displacement, relative, 0.0, 2), structure, 0.0, 0.0)
    assert found.sizes["mode"] == 0


def _with_accelerometers(A, B, seed, noise=0.02, marker_noise=1e-4):
    """At 512 Hz and low-passed: specific force along x of the base and of the masses, at rest before the start."""
    rate = 2048.0
    fine = np.arange(round(DURATION * rate)) / rate
    acceleration, displacement = white(seed, DURATION, 0.5)
    ramp = np.clip(np.arange(len(acceleration)) / FINE, 0.0, 1.0)
    acceleration = acceleration * ramp
    velocity = np.cumsum(np.r_[0.0, 0.5 * (acceleration[1:] + acceleration[:-1])]) / FINE
    displacement = np.cumsum(
        np.r_[0.0, velocity[:-1] / FINE + (2 * acceleration[:-1] + acceleration[1:]) / 6 / FINE**2]
    )
    test = reading(displacement, answer(A, B, acceleration), marker_noise, seed)
    base = np.interp(fine, np.arange(len(acceleration)) / FINE, acceleration)
    n = len(A) // 2
    # springs and dashpots alone accelerate a mass, so this is absolute
    force = np.column_stack([base, states(A, B, base, rate) @ A[n:].T])
    read = low_pass(force)[::4]
    read += np.random.default_rng([seed, 2]).normal(0.0, noise, read.shape) + 0.05
    names = ["slab-acc-x", *(f"mass-{place}-acc-x" for place in range(n))]
    return test.assign(accelerometer=(("time_acc", "channel"), read)).assign_coords(
        time_acc=np.arange(len(read)) / 512.0, channel=names
    )


def test_accelerometers_see_what_markers_cannot(structure):
    """The paper's sensors and 0.5 m/s2 rms: the modes above the first are in the accelerometers alone."""
    A, B = _chain([3.0e4, 3.0e4, 3.0e4], lambda K: 1e-4 * K)
    frequency, damping, shape = exact(A)
    test = _with_accelerometers(A, B, 4)
    found = modes_from_noise(test, structure, 1e-4, 0.02)
    _check(found, frequency, damping)
    error = found["shape_error"].sel(axis="x").to_numpy()[0, 1:]
    first = found["shape"].sel(axis="x").to_numpy()[0, 1:]
    np.testing.assert_array_less(np.abs(first - shape.real[0]), SIGMAS * error + 1e-12)
    blind = modes_from_noise(test.drop_vars("accelerometer"), structure, 1e-4, 0.02)
    assert blind.attrs["marker_band_hz"][1] < frequency[1]


def test_gaps_and_an_abort(structure):
    """Short gaps are bridged, a channel with a long one is left out, the tail after an abort is cut."""
    A, B = _chain([6000.0, 6000.0], _proportional)
    acceleration, displacement = white(6, DURATION, 1.0)
    test = reading(displacement, answer(A, B, acceleration), 1e-6, 6)
    values = test["marker_displacement"].to_numpy()
    for place in (300, 1000, 3000):
        values[place : place + 5, 1] = np.nan
    values[5500:] = np.nan
    frequency, damping, _ = exact(A)
    found = modes_from_noise(test, structure, 1e-6, 0.0)
    np.testing.assert_allclose(found["frequency"], frequency, rtol=SHARE)
    np.testing.assert_allclose(found["damping_ratio"], damping, rtol=0.05)
    values[2000:2020, 1] = np.nan
    found = modes_from_noise(test, structure, 1e-6, 0.0)
    assert found.attrs["left_out"] == "mass-0.x, mass-0.y, mass-0.z"
    assert np.isnan(found["shape"].sel(marker="mass-0")).all()
    _check(found, frequency, damping)


def test_what_cannot_be_answered_is_refused(structure):
    A, B = _chain([6000.0], _proportional)
    acceleration, displacement = white(7, DURATION, 1.0)
    test = reading(displacement, answer(A, B, acceleration), 1e-4, 7)
    with pytest.raises(InputError, match="longer record"):
        modes_from_noise(test.isel(time=slice(0, 100)), structure, 1e-4, 0.02)
    quiet = reading(1e-4 * displacement, 1e-4 * answer(A, B, acceleration), 1e-4, 7)
    with pytest.raises(InputError, match="rises over the noise"):
        modes_from_noise(quiet, structure, 1e-4, 0.02)
    with pytest.raises(InputError, match="driven body"):
        modes_from_noise(test.sel(marker=["mass-0"]), structure, 1e-4, 0.02)


def test_same_record_same_bytes(structure):
    A, B = _chain([6000.0], _proportional)
    acceleration, displacement = white(8, DURATION, 1.0)
    test = reading(displacement, answer(A, B, acceleration), 1e-5, 8)
    xr.testing.assert_identical(
        modes_from_noise(test, structure, 1e-5, 0.02), modes_from_noise(test, structure, 1e-5, 0.02)
    )


@pytest.mark.parametrize("name", ["example-clean", "example-pitch"])
def test_an_earthquake_that_ends_below_the_modes_finds_none(name):
    """Open example campaigns: t1's base falls to its noise below 10 Hz, the pitch of `example-pitch` is at 11 Hz."""
    if not (SHARED / "campaigns" / name).is_dir():
        pytest.skip(f"no {SHARED / 'campaigns' / name}")
    campaign = load_campaign(SHARED / "campaigns" / name)
    found = modes_from_noise(load_test(campaign, "t1"), load_structure(campaign.structure), 1e-4, 0.02)
    assert found.sizes["mode"] == 0
    assert found.attrs["accelerometer_band_hz"][1] < 11.0
