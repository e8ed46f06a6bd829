"""Every effect: null to the byte, its looks in both solvers, its names and places."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from blockshake import effects
from blockshake.dynamics.motion import ground_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import EFFECTS, with_effect
from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.simulation.simulate import simulate

STEPS = {"nscd-rigid": 1e-3, "ls-dem": 5e-5}
WEAK, STRONG = (
    0.4,
    4.0,
)  # m/s2; the stack rocks at 2.4, slides with friction of 0.2 at 1.96, a weak joint of it at 0.49
FREQUENCY, DURATION = 1.5, 1.0  # Hz, s
SILENT = Instruments(marker_noise=0.0, accelerometer_noise=0.0)
# when an effect shows: in the "quiet" phase and then in proportion to the motion, "later", once blocks rock, slide or
# meet something, or "always" and alike; and whether the mirrored motion adds the mirror image
LOOKS = {
    "table-pitch": ("quiet", "symmetric"),
    "vertical-motion": ("quiet", "one-sided"),
    "clock-lag": ("quiet", "symmetric"),
    "sensor-gain": ("quiet", "symmetric"),
    "marker-offset": ("later", "symmetric"),
    "stopper-contact": ("later", "one-sided"),
    "impact-restitution": ("later", "symmetric"),
    "reduced-bearing": ("later", "symmetric"),
    "sensor-drift": ("always", "one-sided"),
    "sensor-saturation": ("later", "symmetric"),
    "eccentricity": ("later", "one-sided"),
    "block-mass": ("later", "symmetric"),
    "weak-joint": ("later", "symmetric"),
    "rate-weakening-friction": ("later", "symmetric"),
    "slip-weakening-friction": ("later", "symmetric"),
    "friction-asymmetry": ("later", "one-sided"),
    "joint-compliance": ("quiet", "symmetric"),
    "base-compliance": ("quiet", "symmetric"),
}
SLIDES = ("weak-joint", "rate-weakening-friction", "slip-weakening-friction", "friction-asymmetry")
# m, what an effect that shows only later may leave before, by the elastic joints of LS-DEM: a tenth of a marker's
# noise, and a tenth of what it must leave later
LEFT_BEFORE, SHOWN_LATER = 1e-5, 1e-4
# of the largest difference: how far the mirror image of a symmetric effect may be off; the order of contact points
# changes with the mirror, and the solvers' sums with it
MIRROR = 1e-3


@pytest.fixture
def structure(tmp_path, make_mapping):
    def make(friction):
        blocks = [
            {"name": f"block-{n}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * (n - 1)]}
            for n in (1, 2)
        ]
        markers = [
            {"name": f"{body}-{n}", "body": body, "position": place}
            for body, places in (
                ("slab", ([1.2, 0.0, 0.0], [-1.2, 0.0, 0.0], [0.0, 1.2, 0.0])),
                ("block-1", ([0.4, 0.0, 0.6], [-0.4, 0.0, 0.6], [0.0, -1.2, -0.6])),
                ("block-2", ([0.4, 0.0, 0.6], [-0.4, 0.0, 0.6], [0.0, -1.2, -0.6])),
            )
            for n, place in enumerate(places)
        ]
        path = tmp_path / f"stack-{friction}.yaml"
        path.write_text(yaml.safe_dump(make_mapping(blocks, friction=friction, markers=markers)))
        return str(path)

    return make


def _motion(amplitude):
    """One cycle of a sine, of an acceleration that ends the table at rest."""
    time = np.arange(0.0, DURATION + 1e-9, 0.002)
    omega = 2.0 * np.pi * FREQUENCY
    acceleration = amplitude * np.sin(omega * time) * (time <= 1.0 / FREQUENCY)
    return ground_motion("sine", time, {"x": acceleration}, "acceleration")


def _place(effect, structure):
    """The place highest up, where most is to be seen."""
    return effect.places(structure)[-1]


def _experiment(structure, name, amplitude):
    friction = 0.2 if name in SLIDES else 0.75
    return Experiment(load_structure(structure(friction)), _motion(amplitude), SILENT)


def _readings(experiment, model):
    run = simulate(
        experiment.structure, experiment.motion, model, time_step=STEPS[model],
        duration=DURATION, accelerometers=False,
    )  # fmt: skip
    # the window ends while the blocks still rock, some towards a fall
    assert run.attrs["status"] in ("completed", "falling")
    return run, observe(run, experiment.structure, experiment.instruments, seed=1)


@pytest.fixture(scope="module")
def nominal():
    """Runs without an effect by friction, amplitude and model; many tests share them."""
    return {}


def _nominal(nominal, structure, name, amplitude, model):
    key = (name in SLIDES, amplitude, model)
    if key not in nominal:
        nominal[key] = _readings(_experiment(structure, name, amplitude), model)
    return nominal[key]


def _with(structure, name, amplitude, share):
    """The experiment with a share of the effect's visible size; its other parameters are such that it shows here."""
    effect = EFFECTS[name]
    experiment = _experiment(structure, name, amplitude)
    size = effect.parameters[0]
    values = {size.name: size.null + share * (size.visible - size.null)} | SHOWN.get(name, {})
    return with_effect(experiment, name, values, _place(effect, experiment.structure))


SHOWN = {"stopper-contact": {"gap": 0.02}}


def _added(nominal, structure, name, amplitude, model, share=1.0):
    """Displacement that the effect adds at the markers, float64 (n_times, n_markers, 3) [m]."""
    _, plain = _nominal(nominal, structure, name, amplitude, model)
    _, read = _readings(_with(structure, name, amplitude, share), model)
    return (read["marker_displacement"] - plain["marker_displacement"]).to_numpy()


def _softened(effect, model):
    """Sway at weak shaking that narrower faces add on the springs of LS-DEM, by statics [m]; zero for other effects.

    Each joint leans by M / (k_n I), which moves the highest marker by the lean times its height above the joint.
    """
    if (effect.name, model) != ("reduced-bearing", "ls-dem"):
        return 0.0
    weight = WEAK * 2400.0 * 0.8 * 2.4 * 1.6  # N, of the shaking, on each of the two blocks
    moved = weight * ((0.8 + 2.4) * 3.0 + 0.8 * 1.4)  # N m2
    inset = effect.parameters[0].visible
    inertia = [(2.36 - 2.0 * r) * (0.76 - 2.0 * r) ** 3 / 12.0 for r in (0.0, inset)]  # m4
    return moved / 2.16e10 * (1.0 / inertia[1] - 1.0 / inertia[0])


@pytest.mark.parametrize("model", STEPS)
@pytest.mark.parametrize("name", EFFECTS)
def test_the_null_value_gives_the_nominal_run_to_the_byte(name, model, structure, nominal):
    run, read = _readings(_with(structure, name, STRONG, 0.0), model)
    plain_run, plain = _nominal(nominal, structure, name, STRONG, model)
    for variable in plain_run.data_vars:
        assert run[variable].to_numpy().tobytes() == plain_run[variable].to_numpy().tobytes(), variable
    assert (
        read["marker_displacement"].to_numpy().tobytes() == plain["marker_displacement"].to_numpy().tobytes()
    )


@pytest.mark.parametrize("model", STEPS)
@pytest.mark.parametrize("name", EFFECTS)
def test_it_shows_when_it_should(name, model, structure, nominal):
    strong = np.abs(_added(nominal, structure, name, STRONG, model)).max()
    weak = np.abs(_added(nominal, structure, name, WEAK, model)).max()
    assert strong > SHOWN_LATER
    if LOOKS[name][0] == "always":
        assert weak == pytest.approx(strong, rel=1e-6)
    elif LOOKS[name][0] == "quiet":
        doubled = np.abs(_added(nominal, structure, name, 2.0 * WEAK, model)).max()
        # in proportion to the motion
        assert doubled == pytest.approx(2.0 * weak, rel=0.02)
    else:
        assert abs(weak - _softened(EFFECTS[name], model)) < LEFT_BEFORE


@pytest.mark.parametrize("model", STEPS)
@pytest.mark.parametrize("name", [name for name in EFFECTS if name != "clock-lag"])
def test_the_mirrored_motion_adds_the_mirror_image_or_not(name, model, structure, nominal):
    there = _added(nominal, structure, name, STRONG, model)[..., 0]
    back = _added(nominal, structure, name, -STRONG, model)[..., 0]
    # the mirror exchanges the markers on the two sides
    for body in range(3):
        first = 3 * body
        back[:, [first, first + 1]] = back[:, [first + 1, first]]
    off = np.abs(there + back).max() / np.abs(there).max()
    assert off < MIRROR if LOOKS[name][1] == "symmetric" else off > 0.1


@pytest.mark.parametrize("name", EFFECTS)
def test_an_entry_is_whole(name):
    effect = EFFECTS[name]
    assert effect.name == name
    assert set(effect.confused_with) <= set(EFFECTS)
    for parameter in effect.parameters:
        assert parameter.lower <= parameter.null <= parameter.upper
        assert parameter.lower <= parameter.visible <= parameter.upper
    assert effect.parameters[0].visible != effect.parameters[0].null
    assert effect.equation
    assert effect.source
    assert effect.distinguished_by
    seen = any((effect.columns, effect.turns, effect.lifts))
    # a size that the evidence finds is read as the effect's parameters
    assert bool(effect.reads) == seen


def test_what_does_not_exist_is_refused(structure):
    experiment = _experiment(structure, "table-pitch", WEAK)
    with pytest.raises(InputError, match=r"effect: table-tilt: expected one of table-pitch, "):
        with_effect(experiment, "table-tilt", {}, {})
    with pytest.raises(InputError, match=r"table-pitch.size: expected one of coefficient, frequency"):
        with_effect(experiment, "table-pitch", {"size": 1.0}, {})
    with pytest.raises(InputError, match=r"weak-joint.place: expected one of "):
        with_effect(experiment, "weak-joint", {}, {"joint": ["block-1", "block-9"]})


def test_the_diagnosis_does_not_know_how_virtual_data_are_made():
    package = Path(effects.__file__).parents[1]
    for path in (package / "diagnosis").rglob("*.py"):
        assert "blockshake.virtual" not in path.read_text(), path


@pytest.mark.parametrize("name", EFFECTS)
def test_a_null_effect_keeps_what_the_structure_states_already(name, structure):
    stated = {
        "friction.stone.stone.rate_drop": 0.3,
        "friction.stone.stone.rate_scale": 0.02,
        "joints.block-1.block-2.friction_factor": 0.5,
        "joints.block-1.block-2.compliance": 2e-10,
        "bodies.block-2.mass_offset": [0.01, 0.02, 0.0],
        "restitution": 0.4,
        "shapes.block.chamfer": 0.03,
    }
    experiment = _experiment(structure, name, WEAK).with_parameters(**stated)
    effect = EFFECTS[name]
    size = effect.parameters[0]
    file = with_effect(
        experiment, name, {size.name: size.null}, _place(effect, experiment.structure)
    ).structure.file
    plain = experiment.structure.file
    assert file.model_copy(update={"stoppers": ()}) == plain
    assert all(stop.stiffness == 0.0 for stop in file.stoppers)
