"""What the sensors would have read of one test, had a model been true."""

from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.measurement.instruments import Instruments, observe
from blockshake.study.placement import placed
from blockshake.study.simulation import part_parameters, simulate

RATE = 200.0  # Hz


def predict_test(structure, motion, duration, draw, sensors, effect=None):
    """Readings of a test that a drawn model gives.

    Parameters
    ----------
    structure : str or path
        The campaign's.
    motion : GroundMotion
        Commanded; the draw says how the table followed.
    duration : float
        [s]
    draw : Draw
    sensors : Sensors
        Whose noise is read.
    effect : dict, optional
        ``name``, ``values`` and ``place`` of an effect that the model has too.

    Returns
    -------
    test : xarray.Dataset
        As in a campaign's test file, synthetic.
    status : str
        How the run ended.
    """
    physical, numerics = part_parameters(draw.parameters)
    instruments = Instruments(
        marker_noise=sensors.marker_noise, accelerometer_noise=sensors.accelerometer_noise
    )
    experiment = Experiment(
        str(structure), physical | placed(structure, draw.places), motion.scaled(draw.amplitude), instruments
    )
    if effect is not None:
        experiment = with_effect(experiment, **effect)
    run = simulate(
        experiment.structure, experiment.motion, draw.model, experiment.parameters | numerics,
        time_step=draw.time_step, duration=duration, output_rate=RATE,
    )  # fmt: skip
    return observe(run, experiment.load(), experiment.instruments, draw.seed), run.attrs["status"]
