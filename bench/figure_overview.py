"""Figure of the README: a stack that rocks, how sure its prediction is, and an effect that the readings show.

Run it from the project's root as ``python bench/figure_overview.py``: about half a minute. All of it is synthetic.
"""

import argparse
from pathlib import Path

import numpy as np
from figures_of_docs import top_drift
from matplotlib.collections import PolyCollection

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.pages.drawing import BLACK, DARK_GREY, RED, SKY, new_figure, save_picture
from blockshake.pages.scene.bodies import body_colors
from blockshake.pages.scene.projection import Scene
from blockshake.simulation.simulate import simulate
from blockshake.study.ensembles.case_input import driving_motions, measured_input, measured_on_clock
from blockshake.study.sampling.distributions import LINKED
from blockshake.study.sampling.latin_hypercube import draw_samples
from blockshake.study.sampling.sample_parameters import sample_parameters
from blockshake.views.animation import magnified

MEASURED = {"campaign": "data/virtual-campaign/configuration-1", "test": "basso-tirreno-200"}
CASE = {
    "structure": "configuration-1",
    "motion": "basso-tirreno",
    "scale": 2.0,
    "duration": 10.0,
    "input": "measured",
    "baseline": "auto",
}
TIME_STEPS = {"nscd-rigid": 1e-3, "ls-dem": 5e-5}  # s
SAMPLES = 20
MAGNIFICATION = 6.0
INSET = 0.06  # m, of the reduced bearing
LOWEST = 0  # face of the lowest joint
_SIZE = 0.075, 0.25  # m of paper


def main():
    """Draw and write."""
    parser = argparse.ArgumentParser(prog="figure_overview", description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=Path("docs/overview.png"))
    save_picture(parser.parse_args().output, plot_overview)


def plot_overview():
    """The three panels."""
    structure, motion = load_structure(CASE["structure"]), load_motion(CASE["motion"], CASE["scale"])
    figure = new_figure(*_SIZE)
    stack, band, levers = figure.subplots(1, 3, width_ratios=(0.6, 1.5, 1.2))
    _rocking_stack(stack, structure, motion)
    _prediction(band, structure)
    _what_the_readings_show(levers, structure, motion)
    return figure


def _run(structure, motion, parameters=None, model="nscd-rigid"):
    return simulate(
        structure, motion, model, parameters, time_step=TIME_STEPS[model], duration=CASE["duration"]
    )


def _rocking_stack(axes, structure, motion):
    """The blocks when the lowest one leans most, magnified."""
    run = _run(structure, motion)
    lean = np.abs(run["orientation"].isel(body=1).sel(quaternion="y").to_numpy())
    position, orientation = magnified(run.isel(time=[int(lean.argmax())]), structure, MAGNIFICATION)
    outlines, bodies, light = (scene := Scene(structure, "3d")).faces(position[0], orientation[0])
    colours = body_colors(structure)[bodies] * np.array(light)[:, None]
    axes.add_collection(PolyCollection(outlines, facecolors=colours, edgecolors=DARK_GREY, linewidths=0.5))
    low, high = scene.extent(position, orientation)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.set_axis_off()
    axes.set_title(f"simulated stack,\nmotion times {MAGNIFICATION:g}")


def _prediction(axes, structure):
    """Envelope of samples under draws of the slab's measured motion, and the synthetic test."""
    base, drifts = measured_input(CASE, MEASURED), []
    moved = driving_motions(CASE, base, seed=1)
    for sample, (_, row) in enumerate(draw_samples(SAMPLES, 1).values.iterrows()):
        run = _run(structure, moved(sample), sample_parameters(row, structure, LINKED), "ls-dem")
        drifts.append(top_drift(run))
    low, middle, high = 1e3 * np.quantile(drifts, [0.05, 0.5, 0.95], axis=0)
    time = run["time"].to_numpy()
    axes.fill_between(
        time, low, high, color=SKY, alpha=0.4, linewidth=0.0, label=f"5 to 95 % of {SAMPLES} samples"
    )
    axes.plot(time, middle, color=DARK_GREY, linewidth=0.7, label="median")
    test, _ = measured_on_clock(MEASURED, base)
    axes.plot(test["time"], 1e3 * top_drift(test), color=BLACK, linewidth=0.8, label="synthetic test")
    axes.set(xlim=(0.0, CASE["duration"]), xlabel="time [s]", ylabel="top block over the slab [mm]")
    axes.set_title("a prediction, and a test with a slippery joint")
    axes.legend(loc="lower left")


def _what_the_readings_show(axes, structure, motion):
    """Lever of the lowest joint by its rotation, in a test as modelled and in one with reduced bearing."""
    usual = Experiment(structure, motion, Instruments())
    reduced = with_effect(usual, "reduced-bearing", {"inset": INSET}, {})
    for experiment, colour, words in (
        (usual, BLACK, "as modelled"),
        (reduced, RED, f"bearing {1e3 * INSET:.0f} mm in"),
    ):
        test = observe(_run(experiment.structure, motion), structure, experiment.instruments, seed=1)
        seen = reconstruct_test(words, without_outliers(test, structure), structure, Sensors())
        turned = seen.states.edge[:, LOWEST, 0] != 0
        turn, force = seen.joints.rotation[turned, LOWEST], seen.forces.force[turned, LOWEST, 2]
        lever = -seen.forces.moment[turned, LOWEST, 1] / force
        axes.plot(1e3 * turn, 1e3 * lever, ".", color=colour, markersize=2, label=words)
    half = 1e3 * seen.faces[LOWEST].half_width
    for edge in (-half, half):
        axes.axhline(edge, color=DARK_GREY, linewidth=0.6, linestyle=(0, (4, 2)))
    axes.set(
        ylim=(-1.5 * half, 1.5 * half),
        xlabel="rotation of the lowest joint [mrad]",
        ylabel="lever of its force [mm]",
    )
    axes.set_title("an effect, seen in synthetic readings")
    axes.legend(loc="upper left", markerscale=3)


if __name__ == "__main__":
    main()
