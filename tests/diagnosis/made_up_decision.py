"""A decision whose numbers are made up."""

from blockshake.diagnosis.answer.decision import Cause, Decision, Part

_PARAMETERS = {
    "table-pitch": {"coefficient": {"estimate": 4e-4, "lower": 3e-4, "upper": 5e-4, "unit": "rad s2/m"}},
    "push": {"force": {"estimate": 4e3, "lower": 3e3, "upper": 5e3, "unit": "N"}},
}
_PLACES = {"weak-joint": {"joint": ["slab", "block-1"]}, "push": {"body": "block-2", "height": 0.42}}


def made_up_cause(name, place, **changed):
    """A cause at a place, without sizes but for those of its one member."""
    values = {"places": ("there",), "gain": 30.0, "odds": 0.0, "parameters": {}, "members": ({},)}
    return Cause(name=name, place=place, **values | changed)


def made_up_part(*names):
    """One part of the readings, and the causes that cannot be distinguished in it."""
    causes = [
        made_up_cause(
            name, _PLACES.get(name, {}), gain=30.0 - number, odds=float(number),
            parameters=_PARAMETERS.get(name, {}), when={"starts": {"t1": 2.5}} if name == "push" else {},
        )
        for number, name in enumerate(names)
    ]  # fmt: skip
    return part_of(*causes)


def part_of(*causes):
    """One part of the readings of causes."""
    odds, gains = ({cause.name: getattr(cause, of) for cause in causes} for of in ("odds", "gain"))
    return Part(readings="joints", causes=causes, odds=odds, gains=gains)


def made_up_decision(kind="none", *parts, **changed):
    """A decision on three tests; ``parts`` are tuples of names."""
    values = {
        "decision": kind,
        "parts": [made_up_part(*names) for names in parts],
        "probabilities": {"table-pitch": 0.6, "weak-joint": 0.02},
        "limits": {"table-pitch": {"all": 2e-4}},
        "excluded_above": {"table-pitch": 2e-4},
        "p": 1e-9 if parts else 1.0,
        "where": "block-1 in t1 at 2.00 s: +3 kN that the model does not have",
        "tests": ["t1", "t2", "t3"],
        "silent": [],
        "n_rows": 300,
    }
    return Decision.model_validate(values | changed)
