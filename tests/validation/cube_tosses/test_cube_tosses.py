"""Real tosses of a cube by both solvers (docs/results/tosses.md): data of ContactNets, Pfrommer, Halm and Posa (2020).

The data are no part of the project; what needs them is skipped where they are absent.
"""

import json
from dataclasses import replace

import numpy as np
import pytest
import toss_study
from calibration import fit
from first_impact import first_impact
from flight import InitialState, common_fall, flight_noise, initial_state, length_scale
from replay import Cube, replay
from scipy.spatial.transform import Rotation
from scores import difference, impacts
from tosses import Toss, halves, read_tosses, rest_heights, tosses_folder

HALF_WIDTH = 0.0524
MODELS = ("nscd-rigid", "ls-dem")
AUTHORS = {"friction": 0.18, "restitution": 0.125}


@pytest.fixture(scope="session")
def data():
    if not tosses_folder().exists():
        pytest.skip(f"no measured tosses in {tosses_folder()} (set BLOCKSHAKE_SHARED)")
    return toss_study.read_data()


@pytest.fixture
def thrown(tmp_path):
    """Folder like the measured one: forty tosses in vacuum about a known mass centre, and then at rest."""
    random = np.random.default_rng(3)
    time, centre, files, starts = np.arange(24) / 148.0, np.array([1e-3, -2e-3, 5e-3]), {}, {}
    for number in range(40):
        first, velocity = np.array([0.1, 0.2, 0.5]), random.normal(size=3) * [1.0, 1.0, 0.3]
        spin, turned = random.normal(size=3) * 4.0, Rotation.random(rng=random)
        rotation = Rotation.from_rotvec(time[:, None] * spin) * turned
        fall = np.outer(0.5 * time**2, [0.0, 0.0, -9.81])
        middle = first + np.outer(time, velocity) + fall - rotation.apply(centre)
        rows = np.zeros((30, 19))
        rows[:24, :3] = middle / HALF_WIDTH
        rows[24:, 2] = 1.0
        rows[:24, 3:7] = rotation.as_quat(scalar_first=True) * random.choice([-1.0, 1.0], size=(24, 1))
        rows[24:, 3] = 1.0
        files[f"t{number:03d}"] = rows
        starts[f"t{number:03d}"] = first, velocity, spin, turned
    np.savez(tmp_path / "cube_tosses.npz", **files)
    about = {
        "dt": 1 / 148,
        "g": 9.81 / HALF_WIDTH,
        "mass": 0.37,
        "inertia": 0.295,
        "mu": 0.18,
        "restitution": 0.125,
    }
    (tmp_path / "experiment.json").write_text(json.dumps(about))
    return tmp_path, starts, centre


def test_lengths_are_half_widths_and_the_inertia_is_per_mass_of_kilograms(thrown):
    experiment = read_tosses(thrown[0])
    assert experiment.half_width == pytest.approx(HALF_WIDTH, rel=1e-12)
    assert experiment.inertia == pytest.approx(0.295 * HALF_WIDTH**2, rel=1e-12)
    assert experiment.tosses[0].position[-1, 2] == pytest.approx(HALF_WIDTH, rel=1e-12)
    shrunk = read_tosses(thrown[0], scale=0.5)
    assert shrunk.tosses[0].position == pytest.approx(2.0 * experiment.tosses[0].position)


def test_the_start_is_recovered_from_a_flight_in_vacuum(thrown):
    """Newton and Euler for an isotropic inertia: a parabola and a constant spin; exact, so to rounding."""
    folder, starts, centre = thrown
    for toss in read_tosses(folder).tosses:
        first, velocity, spin, turned = starts[toss.name]
        start = initial_state(toss, centre)
        assert toss.flight == 24
        assert start.position == pytest.approx(first, abs=1e-12)
        assert start.velocity == pytest.approx(velocity, abs=1e-11)
        assert start.angular_velocity == pytest.approx(spin, abs=1e-9)
        found = Rotation.from_quat(start.orientation, scalar_first=True)
        assert (found * turned.inv()).magnitude() < 1e-9


def test_gravity_scale_and_mass_centre_are_recovered_from_many_flights(thrown):
    folder, _, centre = thrown
    fall = common_fall(read_tosses(folder).tosses)
    assert fall.gravity == pytest.approx([0.0, 0.0, -9.81], abs=1e-9)
    assert fall.mass_centre == pytest.approx(centre, abs=1e-9)
    assert length_scale(read_tosses(folder, scale=1.25).tosses) == pytest.approx((0.8, 0.8), rel=1e-9)


def test_a_perturbed_start_spreads_as_a_line_through_noisy_poses_does(thrown):
    """Least squares: the slope of a line through n readings has the variance 12 (noise rate)^2 / n (n^2 - 1)."""
    start = initial_state(read_tosses(thrown[0]).tosses[0])
    random = np.random.default_rng(1)
    drawn = [start.perturbed((1e-4, 1e-3), (2e-4, 3e-3), random) for _ in range(2000)]
    n = 24
    slope = 148.0 * np.sqrt(12.0 / (n * (n**2 - 1.0)))
    # 6000 numbers give a standard deviation to 0.9 %; 4 % is beyond four of that
    assert np.std([one.position - start.position for one in drawn]) == pytest.approx(2e-4, rel=0.04)
    assert np.std([one.velocity - start.velocity for one in drawn]) == pytest.approx(1e-4 * slope, rel=0.04)
    spins = [one.angular_velocity - start.angular_velocity for one in drawn]
    assert np.std(spins) == pytest.approx(1e-3 * slope, rel=0.04)


def test_the_distance_of_corners_is_that_of_eight_corners():
    random = np.random.default_rng(2)
    position, other = random.normal(size=(2, 5, 3))
    rotation, turned = (Rotation.random(5, rng=random).as_matrix() for _ in range(2))
    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)])
    here, there = (
        p[:, None] + corners @ r.transpose(0, 2, 1) for p, r in ((position, rotation), (other, turned))
    )
    expected = np.sqrt(np.mean(np.sum((here - there) ** 2, axis=2), axis=1))
    found = difference(position, rotation, other, turned, 0.1)
    assert found.corners == pytest.approx(expected, rel=1e-12)
    relative = Rotation.from_matrix(rotation) * Rotation.from_matrix(turned).inv()
    assert found.rotation == pytest.approx(relative.magnitude(), rel=1e-9)


def test_the_halves_are_halves_and_the_seed_decides(thrown):
    tosses = read_tosses(thrown[0]).tosses
    first, second = halves(tosses, 1)
    assert sorted(first + second) == [toss.name for toss in tosses]
    assert len(first) == len(second)
    assert halves(tosses, 1) == (first, second) != halves(tosses, 2)


def test_rest_and_gravity_agree_on_the_scale_of_the_measured_lengths(data):
    """The tracked lengths are 2 % short, and both witnesses say so.

    The height's median over 190 tosses is good to 0.05 % (spread 0.6 %), gravity to 0.02 %: 0.2 % is beyond
    three of both.
    """
    raw = read_tosses(tosses_folder()).sample([toss.name for toss in data.to_fit])
    height, gravity = length_scale(raw)
    assert height == pytest.approx(gravity, rel=2e-3)
    assert height < 0.99
    assert np.median(rest_heights(data.to_predict)) == pytest.approx(HALF_WIDTH, rel=2e-3)


def test_measured_flight_is_a_parabola_within_the_noise_of_the_cameras(data):
    position, rotation = flight_noise(data.to_predict)
    assert position < 1e-4  # a tenth of a millimetre: what the authors' tags give
    assert np.degrees(rotation) < 0.1
    assert all(len(impacts(toss)) >= 2 for toss in data.to_predict)


@pytest.mark.parametrize("model", MODELS)
def test_a_replay_flies_as_measured_and_comes_to_rest_on_a_face(data, model):
    noise, _ = flight_noise(data.to_fit)
    for toss in data.to_predict[:3]:
        run = replay(toss, model, **AUTHORS, cube=data.uniform)
        assert run.status == "completed", run.reason
        flown = np.linalg.norm(run.position - toss.position, axis=1)[: toss.flight]
        # of a vector of three components as noisy as a reading; five times that for the worst of sixty
        assert flown.max() < 5.0 * np.sqrt(3.0) * noise
        upward = np.abs(run.rotation[-1, 2]).max()
        assert np.degrees(np.arccos(min(upward, 1.0))) < 0.01
        # LS-DEM sinks in by the weight over k_n A / 2, 0.33 um; NSCD lands with the gap's second order in the step's
        # turn, r (w dt)^2 / 2 for a corner at r = sqrt(3) half-widths and 10 rad/s, 4.5 um, and stays so
        assert run.position[-1, 2] == pytest.approx(HALF_WIDTH, abs=4.5e-6)


def test_the_first_impact_gives_back_the_restitution_that_a_replay_had(data):
    """Newton's law, read back from replayed paths at the cameras' rate.

    The corner turns by up to w dt = 0.07 rad between readings, which spreads single values: medians are compared.
    """
    found = []
    for toss in data.to_predict[:20]:
        run = replay(toss, "nscd-rigid", 0.18, 0.3, data.uniform)
        one = first_impact(replace(toss, position=run.position, orientation=run.orientation))
        if one is not None and one.corner:
            found.append(one[:2])
    assert len(found) >= 8
    restitution, ratio = np.median(found, axis=0)
    assert restitution == pytest.approx(0.3, abs=0.03)
    assert ratio == pytest.approx(0.18, abs=0.02)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_cube_on_its_edge_tips_to_where_its_mass_centre_is(side):
    """Statics: balanced on an edge at 45 degrees, a mass centre 5 mm to one side is the only thing that decides."""
    cube = Cube(2.0 * HALF_WIDTH, 0.37, mass_centre=(0.005 * side, 0.0, 0.0), inertia=8.1e-4)
    eighth = Rotation.from_rotvec([0.0, np.pi / 4.0, 0.0])
    middle = np.array([0.0, 0.0, np.sqrt(2.0) * HALF_WIDTH + 0.005])  # let down from 5 mm
    start = InitialState(
        position=middle + eighth.apply(cube.mass_centre),
        orientation=eighth.as_quat(scalar_first=True),
        velocity=np.zeros(3),
        angular_velocity=np.zeros(3),
        position_residual=np.zeros((0, 3)),
        rotation_residual=np.zeros((0, 3)),
    )
    toss = Toss(
        "edge", np.arange(150) / 148.0, np.zeros((150, 3)), np.tile([1.0, 0, 0, 0], (150, 1)), HALF_WIDTH
    )
    run = replay(toss, "nscd-rigid", 1.0, 0.0, cube, start)
    # rough and without rebound it turns about the edge, which lands 0.1 mm from x = 0, to stand half a width beside it
    assert run.position[-1] == pytest.approx([HALF_WIDTH * side, 0.0, HALF_WIDTH], abs=1e-3)
    with pytest.raises(ValueError, match="LS-DEM"):
        replay(toss, "ls-dem", 1.0, 0.0, cube, start)


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS)
def test_friction_and_restitution_of_one_half_predict_the_other(data, model):
    best = fit(data.to_fit[: toss_study.FITTED], model, data.uniform)
    at = model, best.friction, best.restitution, data.uniform
    runs, scores = toss_study.predict(data.to_predict, *at)
    pairs = toss_study.twins(data.to_predict, runs, *at, data.noise, data.bias)
    assert {run.status for run in runs} == {"completed"}
    position, _, rotation, _ = toss_study.summary(scores, data.uniform.side)
    # not worse than the best of the published simulators by two standard errors of the difference of the means,
    # of 550 tosses there and 190 here
    published, spread, turned, turned_spread = toss_study.PUBLISHED["Drake"]
    share = 2.0 * np.sqrt(1.0 / 550.0 + 1.0 / len(scores))
    assert position < published + share * spread
    assert rotation < turned + share * turned_spread
    # the errors are the model's: what is not known of the start explains less than half of them
    assert toss_study.summary(pairs, data.uniform.side)[0] < 0.5 * position
