"""A decision whose numbers are made up."""

from blockshake.diagnosis.answer.decision import Cause, Decision, Part

_PARAMETERS = {
    "table-pitch": {"coefficient": {"estimate": 4e-4, "lower": 3e-4, "upper": 5e-4, "unit": "rad s2/m"}},
    "push": {"force": {"estimate": 4e3, "lower": 3e3, "upper": 5e3, "unit": "N"}},
}
_PLACES = {"weak-joint": {"joint": ["slab", "block-1"]}, "push": {"body": "block-2", "height": 0.42}}


def made_up_part(*names):
    """One part of the readings, and the causes that cannot be told apart in it."""
    causes = [
        Cause(
            name=name, place=_PLACES.get(name, {}), places=("there",), gain=30.0 - number, odds=float(number),
            parameters=_PARAMETERS.get(name, {}), members=({},), when={"starts": {"t1": 2.5}} if name == "push" else {},
        )
        for number, name in enumerate(names)
    ]  # fmt: skip
    return Part(
        readings="joints", causes=causes, odds={one.name: one.odds for one in causes},
        gains={one.name: one.gain for one in causes},
    )  # fmt: skip


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
