"""A decision whose numbers are made up."""

from blockshake.diagnosis.inference.decision import Decision

_PITCH = {
    "coefficient": {"estimate": 4e-4, "lower": 3e-4, "upper": 5e-4, "unit": "rad s2/m", "informed": True},
    "frequency": {"estimate": 17.5, "lower": 6.25, "upper": 28.75, "unit": "Hz", "informed": False},
}


def made_up_decision(kind="none", causes=(), **changed):
    """A decision between a pitch of the table and a weak joint."""
    effects = ["table-pitch", "weak-joint"]
    values = {
        "decision": kind,
        "causes": causes,
        "places": {"table-pitch": "table-pitch", "weak-joint": "weak-joint@slab-block-1"},
        "sizes": dict.fromkeys(causes, 0.9),
        "p_none": 0.5 if kind == "none" else 0.01,
        "probabilities": {"table-pitch": 0.6, "weak-joint": 0.02},
        "adequacy": dict.fromkeys(effects, 0.5),
        "constancy": dict.fromkeys(effects, 0.5),
        "placebo": 1.0,
        "struck_out": {},
        "solver_dependent": (),
        "shown_above": {"table-pitch": 0.5, "weak-joint": None},
        "nominal_distance": 2.0,
        "parameters": {"table-pitch": _PITCH} if "table-pitch" in causes else {},
        "location": {"weak-joint": {"joint": ["slab", "block-1"]}} if "weak-joint" in causes else {},
        "candidates": (),
    }
    return Decision.model_validate(values | changed)
