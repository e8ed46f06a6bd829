"""Every cause that has a column: put into the simulation, it is found in the readings, where it is and as large."""

import pytest
from simulated_tests import cause_of, seen_tests

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.answer.places import place_name
from blockshake.diagnosis.gain.extended_model import can_extend
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS

pytestmark = pytest.mark.usefixtures("without_limits")
MOTIONS = {
    "weak": ("alkion", 1.0), "first": ("alkion", 2.5), "second": ("basso-tirreno", 2.0), "third": ("alkion", 3.0),
}  # fmt: skip
STARTS = {"weak": 3.0, "first": 2.5, "second": 2.0, "third": 3.0}  # s, of a push
TOP = {"body": "block-2", "height": 0.42}
BASE = {"joint": ["slab", "block-1"]}
# cause, place, size, what else it is, structure; the first of the sizes is the one that is requested
CAUSES = [
    ("eccentricity", {"body": "block-2"}, {"offset": 0.06}, {}, "two-blocks"),
]
SLOW = [
    ("push", TOP, {"force": 4000.0}, {"starts": STARTS}, "two-blocks"),
    ("rope", TOP, {"stiffness": 2e5}, {}, "two-blocks"),
    ("reduced-bearing", {}, {"inset": 0.08}, {}, "two-blocks"),
    (
        "stopper-contact",
        {"body": "block-2", "height": 0.5},
        {"stiffness": 1e7, "gap": 0.02, "side": 1.0, "other_gap": 1e3},
        {},
        "two-blocks",
    ),
    ("weak-joint", {"joint": ["block-1", "block-2"]}, {"factor": 0.2}, {}, "sliding-blocks"),
    ("rate-weakening-friction", {}, {"drop": 0.8, "scale": 0.01}, {}, "sliding-blocks"),
    ("joint-compliance", BASE, {"compliance": 4e-10}, {}, "two-blocks"),
    ("table-pitch", {}, {"coefficient": 6e-4, "frequency": 12.0}, {}, "two-blocks"),
    ("base-compliance", {}, {"compliance": 2e-9}, {}, "two-blocks"),
    ("vertical-motion", {}, {"ratio": 0.4, "delay": 0.05}, {}, "two-blocks"),
    ("blow", TOP, {"impulse": 2500.0}, {"blows": {"second": {"time": 3.0, "width": 0.08}}}, "two-blocks"),
    ("drag", TOP, {"damping": 3e4}, {}, "two-blocks"),
    ("spring-and-damper", TOP, {"stiffness": 2e5, "damping": 3e4}, {}, "two-blocks"),
    ("dry-drag", TOP, {"force": 4000.0}, {}, "two-blocks"),
    ("spring-once", TOP, {"stiffness": 5e6}, {"test": "third", "side": 1, "gap": 0.012}, "two-blocks"),
    ("changed-edge", BASE, {"inset": 0.08}, {"before": ["weak", "first"], "lasts": True}, "two-blocks"),
    ("loose-weight", {"body": "block-2"}, {"mass": 1800.0}, {"grip": 0.2}, "two-blocks"),
    ("block-mass", TOP, {"excess": 0.25}, {}, "two-blocks"),
    ("slip-weakening-friction", {}, {"drop": 0.8, "scale": 0.02}, {}, "sliding-blocks"),
    ("friction-asymmetry", {}, {"asymmetry": -0.25}, {}, "sliding-blocks"),
]
WITHIN = 0.25  # of the size: the forms in the solvers are the columns' own, the discretisation is not
# a force elsewhere makes the same rows by its moment; one that follows the motion there by the arm squared
ARMS = {"rope": 2, "drag": 2, "spring-and-damper": 2, "spring-once": 2, "stopper-contact": 2}
FOLLOWING = {"rope", "drag", "spring-and-damper"}  # of which each is called by its own name alone


def _arm(place):
    """Height of a point over the edge that the stack turns about [m]: blocks of 1.6 m."""
    return 1.6 * (int(place["body"][-1]) - 0.5 + place.get("height", 0.0))


@pytest.mark.parametrize("case", [*CAUSES, *(pytest.param(case, marks=pytest.mark.slow) for case in SLOW)])
def test_a_cause_is_found_with_its_size(case):
    name, place, values, when, structure = case
    decision = decide(seen_tests(structure, MOTIONS, cause_of(name, place, values, when))).decision
    found = {one.name: one for part in decision.parts for one in part.causes}
    assert name in found, decision.parts
    size = next(iter(values))
    assert not place or place_name(place) in found[name].places or found[name].places == ("all",)
    arm = _arm(found[name].place) / _arm(place) if "height" in place else 1.0
    true = values[size] / arm ** ARMS.get(name, 1)
    estimate = found[name].parameters[size]
    near = estimate.estimate == pytest.approx(true, rel=WITHIN)
    assert near or estimate.lower <= true <= estimate.upper
    if name == "spring-and-damper":
        assert found[name].parameters["damping"].estimate == pytest.approx(
            values["damping"] / arm**2, rel=WITHIN
        )
    if name in FOLLOWING:
        assert FOLLOWING & set(found) == {name}


def test_sound_blocks_are_called_nothing():
    decision = decide(seen_tests("two-blocks", MOTIONS)).decision
    assert (decision.decision, decision.parts) == ("none", ())
    assert decision.p == 1.0


@pytest.mark.slow
def test_sound_elastic_blocks_under_a_tall_stack_are_called_nothing():
    """The joint under four blocks bears 5 cm within its edge as it opens, and on the edge from 1 mrad on."""
    motions = {f"alkion-{scale}": ("alkion", scale) for scale in (1.25, 2.0, 2.75)}
    motions |= {f"basso-tirreno-{scale}": ("basso-tirreno", scale) for scale in (1.25, 2.0)}
    model = "ls-dem", {"ls_dem.node_spacing": 0.16}, 5e-5
    assert decide(seen_tests("configuration-2", motions, duration=10.0, model=model)).decision.parts == ()


def test_every_effect_of_forces_and_every_form_is_tried():
    tried = {name for name, *_ in CAUSES + SLOW}
    of_forces = {name for name, effect in EFFECTS.items() if effect.columns or effect.turns or effect.lifts}
    assert tried == of_forces | {name for name, form in FORMS.items() if form.act}


def test_what_ends_before_a_test_to_come_extends_no_model():
    blow = cause_of("blow", TOP, {"impulse": 1.0}, {"blows": {"first": {"time": 1.0, "width": 0.1}}})
    assert not can_extend(blow)
    assert not can_extend(cause_of("unknown-force", TOP, {"size": 1.0}, {}))
    assert can_extend(cause_of("rope", TOP, {"stiffness": 1.0}, {}))
