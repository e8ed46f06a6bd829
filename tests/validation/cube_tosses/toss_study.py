"""The tosses replayed by both solvers: fit on half, predict the other half, and what the errors come from.

Run it as ``python tests/validation/cube_tosses/toss_study.py --figure docs/results/tosses.png`` from the root; it
takes about a quarter of an hour on one core. Without the data it says so and ends well. The tables of
``docs/results/tosses.md`` are its output.
"""

import argparse
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from calibration import fit
from first_impact import first_impact
from flight import common_fall, flight_noise, initial_state, length_scale, rest_bias
from replay import Cube, replay
from scores import difference, horizons, impacts, quantiles, score
from toss_figure import draw
from tosses import halves, read_tosses, tosses_folder

SEED = 1
FITTED = 60  # tosses of the fit half that the grid is run on
AS_TEXT = "{:.1f} +- {:.1f} % of the width, {:.1f} +- {:.1f} deg"

# Acosta, Yang and Posa (2022), "Validating robotics simulators on real-world impacts", IEEE Robotics and Automation
# Letters 7(3), 6471-6478: mean and standard deviation over 550 tosses of the path's mean error, position
# as a share of the cube's width [%] and rotation [deg], each simulator with its own fitted parameters
PUBLISHED = {
    "Drake": (13.5, 8.2, 16.5, 20.0),
    "Bullet": (14.9, 8.9, 16.5, 20.2),
    "MuJoCo": (25.1, 10.8, 21.7, 21.4),
}


@dataclass(frozen=True)
class Data:
    """The ``experiment`` with the fit half's scale, its halves, two cubes, ``noise`` and ``bias`` of poses (m, rad)."""

    experiment: object
    to_fit: list
    to_predict: list
    uniform: Cube
    measured: Cube
    noise: np.ndarray
    bias: np.ndarray


def read_data():
    """Tosses, halved, with the scale, mass centre and noise that the fit half's flights give."""
    folder = tosses_folder()
    names = halves(read_tosses(folder).tosses, SEED)
    scale = float(np.mean(length_scale(read_tosses(folder).sample(names[0]))))
    experiment = read_tosses(folder, scale)
    to_fit, to_predict = (experiment.sample(half) for half in names)
    side, mass = 2.0 * experiment.half_width, experiment.mass
    centre = tuple(common_fall(to_fit).mass_centre)
    return Data(
        experiment=experiment,
        to_fit=to_fit,
        to_predict=to_predict,
        uniform=Cube(side, mass),
        measured=Cube(side, mass, mass_centre=centre, inertia=experiment.inertia),
        noise=flight_noise(to_fit),
        bias=rest_bias(to_fit),
    )


def predict(tosses, model, friction, restitution, cube, **options):
    """Replays of all tosses and their scores."""
    runs = [replay(toss, model, friction, restitution, cube, **options) for toss in tosses]
    return runs, [score(toss, run) for toss, run in zip(tosses, runs, strict=True)]


def twins(tosses, runs, model, friction, restitution, cube, noise, bias, seed=SEED):
    """Scores between each replay and one from a start that the measurement's noise allows as well."""
    random = np.random.default_rng(seed)
    found = []
    for toss, run in zip(tosses, runs, strict=True):
        start = initial_state(toss, cube.mass_centre).perturbed(noise, bias, random)
        other = replay(toss, model, friction, restitution, cube, start)
        found.append(difference(run.position, run.rotation, other.position, other.rotation, toss.half_width))
    return found


def summary(scores, width):
    """Mean and standard deviation over tosses of the path's mean errors: position [% of width] and rotation [deg]."""
    position = np.array([one.position.mean() for one in scores]) / width * 100.0
    rotation = np.degrees([one.rotation.mean() for one in scores])
    return position.mean(), position.std(), rotation.mean(), rotation.std()


def along_the_path(tosses, scores):
    """By horizon: number of tosses, quantiles of position error [mm] and of rotation error [deg]."""
    gathered = {}
    for toss, one in zip(tosses, scores, strict=True):
        for horizon, reading in horizons(toss).items():
            gathered.setdefault(horizon, []).append(
                (one.position[reading] * 1e3, np.degrees(one.rotation[reading]))
            )
    order = sorted(gathered, key=lambda name: (name == "at rest", name))
    columns = {name: zip(*gathered[name], strict=True) for name in order}
    return {name: (len(gathered[name]), *map(quantiles, columns[name])) for name in order}


def wrong_face(scores):
    """Share of the tosses that end on another face, or turned by a quarter, or both [1]."""
    return np.mean([one.rotation[-1] > np.pi / 4.0 for one in scores])


def main():
    """Fit, predict, print, draw."""
    parser = argparse.ArgumentParser(prog="toss_study", description=__doc__.partition("\n")[0])
    parser.add_argument("--figure", type=Path)
    figure = parser.parse_args().figure
    if not tosses_folder().exists():
        say(f"skipped: no tosses in {tosses_folder()}")
        return
    data = read_data()
    describe(data)
    drawn = {}
    for name, model, cube in (
        ("LS-DEM", "ls-dem", data.uniform),
        ("NSCD", "nscd-rigid", data.uniform),
        ("NSCD, measured mass centre and inertia", "nscd-rigid", data.measured),
    ):
        best = fit(data.to_fit[:FITTED], model, cube)
        say(
            f"\n{name}: friction {best.friction}, restitution {best.restitution}, fit {best.error / cube.side:.1%}"
        )
        _say_grid(best, cube.side)
        runs, scores = predict(data.to_predict, model, best.friction, best.restitution, cube)
        _say_prediction(data, scores, cube.side)
        for words, bias in (("noise", data.noise), ("noise and bias", data.bias)):
            pairs = twins(
                data.to_predict, runs, model, best.friction, best.restitution, cube, data.noise, bias
            )
            say(f"  between twins, starts apart by {words}:")
            _say_prediction(data, pairs, cube.side)
        bad = {run.reason for run in runs if run.status != "completed"}
        say(
            f"  not completed: {bad or 'none'}; worst energy audit {max(run.energy_residual for run in runs):.1e}"
        )
        _say_variants(data, model, best, cube)
        drawn[name] = scores, pairs
    for name, numbers in PUBLISHED.items():
        say(f"published {name}: " + AS_TEXT.format(*numbers))
    if figure:
        draw(data, drawn, figure)


def describe(data):
    """Measured figures."""
    tosses = data.experiment.tosses
    heights, gravity = length_scale(read_tosses(tosses_folder()).sample([toss.name for toss in data.to_fit]))
    say(f"{len(tosses)} tosses; {FITTED} of {len(data.to_fit)} to fit, {len(data.to_predict)} to predict")
    say(f"lengths over true ones: {heights:.4f} by the height at rest, {gravity:.4f} by gravity")
    for half, some in (("fit", data.to_fit), ("predicted", data.to_predict)):
        fall = common_fall(some)
        position, rotation = flight_noise(some)
        say(
            f"{half} half: mass centre {1e3 * fall.mass_centre} mm, sd {1e3 * fall.errors[3:]}; gravity {fall.gravity}"
        )
        say(f"  noise {1e3 * position:.3f} mm, {np.degrees(rotation):.3f} deg about flights")
    say(
        f"readings in flight, quartiles: {np.quantile([toss.flight for toss in tosses], [0, 0.25, 0.5, 0.75, 1])}"
    )
    say(f"tosses by impacts: {np.bincount([len(impacts(toss)) for toss in tosses])}")
    height, tilt = rest_bias(data.to_fit)
    say(
        f"poses at rest are off by {1e3 * height:.2f} mm in height, {np.degrees(tilt):.2f} deg about a level axis"
    )
    for words, corner in (("a corner", True), ("an edge or a face", False)):
        found = [one for one in map(first_impact, tosses) if one is not None and one.corner == corner]
        values = np.quantile([one[:2] for one in found], [0.25, 0.5, 0.75], axis=0).T
        say(
            f"first impact on {words}, {len(found)} tosses: restitution {values[0]}, impulse ratio {values[1]}"
        )
    up = [tuple(np.rint(toss.rotation[-1, 2]).astype(int).tolist()) for toss in tosses]
    say("face up at rest: " + ", ".join(f"{face} {up.count(face)}" for face in sorted(set(up))))


def _say_grid(best, width):
    errors = np.array(list(best.table.values()))
    for (mu, e), values in sorted(best.table.items()):
        say(f"    friction {mu:.2f} restitution {e:.3f}: {values.mean() / width:.1%}")
    say(f"    the best of the grid for each toss on its own: {errors.min(axis=0).mean() / width:.1%}")


def _say_prediction(data, scores, width):
    say("  path's mean: " + AS_TEXT.format(*summary(scores, width)))
    for horizon, (count, places, angles) in along_the_path(data.to_predict, scores).items():
        say(f"    {horizon:<16} {count:4d}  {np.round(places, 1)} mm  {np.round(angles, 1)} deg")
    say(f"    otherwise on the table: {wrong_face(scores):.1%}")


def _say_variants(data, model, best, cube):
    """One thing changed at a time, at the fitted friction and restitution."""
    experiment = data.experiment
    at = {"friction": best.friction, "restitution": best.restitution, "cube": cube}
    published = {"friction": experiment.friction, "restitution": experiment.restitution}
    inertia = {"cube": replace(cube, inertia=experiment.inertia)}
    variants = {"the authors' friction and restitution": published}
    if model == "ls-dem":
        stiff = {"ls_dem.shear_stiffness": 8e9}
        variants |= {
            "shear dashpot 0.3, friction 0.18": {
                "friction": 0.18,
                "parameters": {"ls_dem.shear_damping_ratio": 0.3},
            },
            "shear stiffness 8e9, friction 0.18": {"friction": 0.18, "parameters": stiff, "time_step": 1e-5},
            "inertia as published": inertia,
        }
    elif cube is data.uniform:
        variants |= {
            "step 0.1 ms": {"time_step": 1e-4},
            "chamfer 3 mm": {"cube": replace(cube, chamfer=3e-3)},
            "inertia as published": inertia,
            "mass centre as measured": {"cube": replace(cube, mass_centre=data.measured.mass_centre)},
        }
    for name, change in variants.items():
        _, scores = predict(data.to_predict, model, **{**at, **change})
        say(f"  {name}: " + AS_TEXT.format(*summary(scores, cube.side)))
    if cube is data.uniform:
        raw = read_tosses(tosses_folder()).sample([toss.name for toss in data.to_predict])
        _, scores = predict(raw, model, **at)
        say("  lengths as in the file: " + AS_TEXT.format(*summary(scores, cube.side)))


def say(line):
    """Print at once: a run takes minutes."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
