"""An effect is one file and an entry of the registry: a campaign with it is explained by it, and without it by none."""

import pytest

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.gain.extended_model import can_extend, extended_experiment
from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.friction.friction_asymmetry import EFFECT
from blockshake.effects.registry import with_effect
from blockshake.files import PACKAGE
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.simulation.simulate import simulate

TRUE = -0.25
TESTS = (("alkion", 2.0), ("basso-tirreno", 2.0), ("alkion", 2.5))


def _experiment(motion, scale):
    structure = load_structure(PACKAGE.parents[1] / "hidden_effects" / "structures" / "sliding-blocks.yaml")
    return Experiment(structure, load_motion(motion, scale), Instruments())


def _seen(seed, motion, scale):
    nominal = _experiment(motion, scale)
    true = with_effect(nominal, EFFECT.name, {"asymmetry": TRUE}, {})
    run = simulate(true.structure, true.motion, "nscd-rigid", duration=6.0, output_rate=200.0)
    return reconstruct_test(
        f"t{seed}", observe(run, true.structure, true.instruments, seed), nominal.structure, Sensors()
    )


@pytest.fixture(scope="module")
def seen():
    return [_seen(seed, *test) for seed, test in enumerate(TESTS)]


def test_it_is_named_with_its_size_and_extends_the_model(seen):
    decision = decide(seen).decision
    assert decision.decision == "named"
    (cause,) = decision.causes
    size = cause.parameters["asymmetry"]
    assert size.lower <= TRUE <= size.upper
    assert EFFECT.name in decision.limits
    assert can_extend(cause)
    extended = extended_experiment(_experiment(*TESTS[0]), cause, 3, "t9")
    assert {one.asymmetry for one in extended.structure.file.friction} == {cause.members[3]["asymmetry"]}


@pytest.mark.usefixtures("without_limits")
def test_without_its_file_nothing_is_named(seen):
    assert decide(seen, (EFFECT.name,)).decision.causes == ()
