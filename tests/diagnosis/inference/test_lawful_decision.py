"""Decisions that the laws of the joints overrule, narrow or leave as they are."""

import pytest
from made_up_decision import made_up_decision

from blockshake.diagnosis.inference.lawful_decision import with_laws
from blockshake.diagnosis.laws.findings import LawFinding, LawFindings, OutsideForce

PLACES = {"table-pitch": {}, "weak-joint@slab-block-1": {"joint": ("slab", "block-1")}}
PITCH = LawFinding(
    name="table.pitch", unit="rad s2/m", value=3.7, error=0.2, measured={"one": 4.1e-4, "two": 4.3e-4},
    errors={"one": 1e-5, "two": 1e-5}, expected={"one": 0.0, "two": 0.0}, spreads={"one": 0.33, "two": 0.33},
    departures={"one": 9.0, "two": 9.0}, together=9.0, broken=True,
)  # fmt: skip
SOFT = PITCH.model_copy(update={"name": "table.compliance", "unit": "rad/(N m)"})
PUSH = OutsideForce(
    bodies=("block-2",), law="constant", scores={"constant": 0.0}, amplitude=-2e3, lower=-2.2e3, upper=-1.8e3,
    unit="N", tests={"one": {"start": 3.0}},
)  # fmt: skip


SHARES = {"block-1": 0.6, "block-2": 0.4}


def findings(laws=(), isolated=(), outside=None):
    broken = outside or any(law.broken for law in laws)
    readable = tuple(law.name for law in laws)
    return LawFindings(
        laws=laws, isolated=isolated, outside=outside, readable=readable, shares=SHARES,
        p=1e-9 if broken else 0.5,
    )  # fmt: skip


def test_an_isolated_effect_is_the_cause_with_the_size_that_its_law_reads():
    found = with_laws(made_up_decision("none"), findings((PITCH,), ("table-pitch",)), PLACES)
    assert (found.decision, found.causes) == ("named", ("table-pitch",))
    assert found.p_none == 1e-9
    size = found.parameters["table-pitch"]["coefficient"]
    assert size.estimate == pytest.approx(4.2e-4)
    assert size.lower < 4.2e-4 < size.upper


def test_an_effect_whose_law_holds_is_struck_out():
    holds = PITCH.model_copy(
        update={"broken": False, "departures": {"one": 0.4, "two": -0.2}, "together": 0.1}
    )
    found = with_laws(made_up_decision("named", ("table-pitch",)), findings((holds,)), PLACES)
    assert (found.decision, found.causes) == ("none", ())
    law, features = found.struck_out["table-pitch"]
    assert "its law holds" in law
    # no misfit is left that chance does not account for, and what the features said is not lost
    assert found.p_none == 0.5
    assert "by themselves gave p = " in features


def test_features_of_whole_tests_decide_where_no_law_is_broken():
    decision = made_up_decision("named", ("table-pitch",))
    found = with_laws(decision, findings(), PLACES)
    assert (found.decision, found.causes) == ("named", ("table-pitch",))
    assert found.p_none == decision.p_none


def test_laws_that_no_effect_accounts_for_make_the_cause_unknown():
    found = with_laws(made_up_decision("named", ("table-pitch",)), findings((SOFT,)), PLACES)
    assert (found.decision, found.causes) == ("unknown", ())
    assert "does not account for" in found.struck_out["table-pitch"][-1]


def test_a_force_that_nobody_thought_of_makes_the_cause_unknown():
    found = with_laws(made_up_decision("named", ("weak-joint",)), findings(outside=PUSH), PLACES)
    assert found.decision == "unknown"
    assert found.laws.outside.bodies == ("block-2",)


def test_an_isolated_effect_is_where_its_law_is_broken():
    weak = PITCH.model_copy(update={"name": "joint2.friction.loss", "unit": "1", "joint": "block-1-block-2"})
    places = PLACES | {"weak-joint@block-1-block-2": {"joint": ("block-1", "block-2")}}
    decision = made_up_decision("none")
    assert decision.places["weak-joint"] == "weak-joint@slab-block-1"
    found = with_laws(decision, findings((weak,), ("weak-joint",)), places)
    assert found.location == {"weak-joint": {"joint": ("block-1", "block-2")}}


def read(effect, law, measured, expected, place):
    """Parameters of an effect whose law was read in two tests, of the joint beneath all blocks."""
    own = PITCH.model_copy(
        update={
            "name": law, "joint": "slab-block-1", "beneath": True, "measured": dict.fromkeys(PITCH.measured, measured),
            "errors": dict.fromkeys(PITCH.measured, 0.01 * abs(measured)),
            "expected": dict.fromkeys(PITCH.measured, expected),
        }
    )  # fmt: skip
    key = effect if "joint" not in place else f"{effect}@slab-block-1"
    decision = made_up_decision("none").model_copy(update={"places": {effect: key}})
    return with_laws(decision, findings((own,), (effect,)), {key: place}).parameters[effect]


def test_the_levers_tell_how_far_off_a_blocks_mass_is_by_its_share_of_the_weight():
    """20 mm at the joint beneath both blocks is 50 mm of a block that has two fifths of the weight, the other way."""
    size = read("eccentricity", "joint1.lever.bias", -0.019, 0.001, {"body": "block-2"})["offset"]
    assert size.estimate == pytest.approx(0.05)
    assert size.informed
    assert size.lower < 0.045
    assert size.upper > 0.055


def test_the_friction_of_a_joint_tells_the_factor_of_a_weak_one():
    size = read("weak-joint", "joint1.friction.loss", 0.83, 0.03, {"joint": ("slab", "block-1")})["factor"]
    assert size.estimate == pytest.approx(0.2)


def test_features_keep_the_parameters_that_they_found():
    decision = made_up_decision("named", ("table-pitch",))
    assert with_laws(decision, findings(), PLACES).parameters == decision.parameters


def test_a_stop_has_the_stiffness_of_its_force_and_a_gap_that_is_known_to_a_millimetre():
    stop = PUSH.model_copy(
        update={
            "law": "spring", "amplitude": 6e6, "lower": 5e6, "upper": 7e6, "unit": "N/m",
            "tests": {"one": {"gap": 0.0285, "side": 1.0}},
        }
    )  # fmt: skip
    places = PLACES | {"stopper-contact@block-2-+x": {"body": "block-2", "axis": "+x"}}
    decision = made_up_decision("none")
    decision = decision.model_copy(
        update={"places": decision.places | {"stopper-contact": "stopper-contact@block-2-+x"}}
    )
    given = findings((SOFT,), ("stopper-contact",)).model_copy(update={"outside_of_stop": stop})
    found = with_laws(decision, given, places)
    gap, stiffness = (found.parameters["stopper-contact"][name] for name in ("gap", "stiffness"))
    assert (gap.lower, gap.upper) == pytest.approx((0.0285 - 1.6449e-3, 0.0285 + 1.6449e-3), rel=1e-5)
    assert (stiffness.lower, stiffness.estimate, stiffness.upper) == (5e6, 6e6, 7e6)


def test_an_effect_that_no_law_leans_to_is_struck_out():
    own = PITCH.model_copy(
        update={
            "name": "joint1.friction.loss", "unit": "1", "joint": "slab-block-1", "broken": False,
            "departures": {"one": 3.1, "two": -2.9}, "together": 0.1,
        }
    )  # fmt: skip
    found = with_laws(made_up_decision("named", ("weak-joint",)), findings((own,)), PLACES)
    assert (found.decision, found.causes) == ("none", ())
    assert found.struck_out["weak-joint"][0] == "no law departs its way"
    leaning = own.model_copy(update={"departures": {"one": 3.1, "two": 1.2}, "together": 3.04})
    kept = with_laws(made_up_decision("named", ("weak-joint",)), findings((leaning,)), PLACES)
    assert kept.causes == ("weak-joint",)
    nothing_slipped = findings((own.model_copy(update={"name": "joint1.lever.bias"}),)).model_copy(
        update={"readable": ("joint1.friction.loss",)}
    )
    untold = with_laws(made_up_decision("named", ("weak-joint",)), nothing_slipped, PLACES)
    assert untold.struck_out["weak-joint"][0] == "its law is not told"
