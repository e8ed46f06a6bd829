"""Seen tests of two blocks that contact dynamics made, with a cause or without one."""

from made_up_decision import made_up_cause

from blockshake.diagnosis.gain.extended_model import extended_experiment
from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.files import PACKAGE
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.sensors.found_noise import found_noise
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.simulation.simulate import simulate

STRUCTURES = PACKAGE.parents[1] / "hidden_effects" / "structures"
DURATION = 6.0  # s
RIGID = "nscd-rigid", {}, 5e-4


def cause_of(name, place, values, when=None):
    """A cause with one member."""
    return made_up_cause(name, place, members=(values,), when=when or {})


def seen_tests(structure, motions, cause=None, change=None, duration=DURATION, model=RIGID, noise=None):
    """`ReconstructedTest` of every motion, by name with its scale, as the sensors of the structure read it.

    ``change`` of an experiment and the name of its test: what happens there, and the structure does not know.
    ``model`` has the solver, its parameters and the time step [s]. With ``noise``, `Instruments`, the noise is found
    as a campaign's is; without it is as stated.
    """
    file, tests = read_tests(structure, motions, cause, change, duration, model, noise)
    sensors = found_noise(tests, file, Sensors()) if noise else Sensors()
    return [reconstruct_test(name, readings, file, sensors) for name, readings in tests.items()]


def read_tests(structure, motions, cause=None, change=None, duration=DURATION, model=RIGID, noise=None):
    """`Structure` and readings by name, as of `seen_tests`."""
    path = STRUCTURES / f"{structure}.yaml"
    file, tests = load_structure(path if path.is_file() else structure), {}
    solver, parameters, time_step = model
    for seed, (name, (motion, scale)) in enumerate(motions.items()):
        experiment = Experiment(file, load_motion(motion, scale), noise or Instruments())
        if change:
            experiment = change(experiment, name)
        if cause:
            experiment = extended_experiment(experiment, cause, 0, name)
        run = simulate(
            experiment.structure, experiment.motion, solver, parameters,
            time_step=time_step, duration=duration, output_rate=200.0,
        )  # fmt: skip
        readings = observe(run, experiment.structure, experiment.instruments, seed)
        known = [marker.name for marker in file.file.markers]
        tests[name] = without_outliers(readings.sel(marker=known), file)
    return file, tests
