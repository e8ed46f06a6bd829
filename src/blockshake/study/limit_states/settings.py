"""Limit states as a configuration states them: a measure of a body or of a joint, and the value that it may reach."""

import re
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from blockshake.errors import InputError
from blockshake.tables.units import unit_size
from blockshake.validation import Positive, Strict

_WITH_UNIT = re.compile(r"\s*([-+.\deE]*\d\.?)\s*([^\d\s].*?)\s*")


class Measure(NamedTuple):
    """A response of a run that has a limit."""

    kind: str  # of `blockshake.tables.units.UNITS`
    unit: str  # SI
    meaning: str


MEASURES = {
    "tilt": Measure("rotation", "rad", "largest tilt of a body from upright, against the base"),
    "drift": Measure(
        "displacement", "m", "largest horizontal displacement of a mass centre against the base"
    ),
    "residual": Measure("displacement", "m", "horizontal displacement of a mass centre in the last 0.5 s"),
    "uplift": Measure("displacement", "m", "largest opening at the middle of a joint"),
    "opening": Measure("displacement", "m", "largest opening of a joint, at any of its corners"),
    "slip": Measure("displacement", "m", "largest slip at the middle of a joint"),
    "impact_velocity": Measure("velocity", "m/s", "closing velocity of the fastest blow between two blocks"),
}
"""What a limit may be set on, by its key."""
_STEEPEST = 40  # deg
OF_BODIES = ("tilt", "drift", "residual")


def _in_si(measure):
    def read(given):
        if not isinstance(given, str):
            return given
        found = _WITH_UNIT.fullmatch(given)
        if not found:
            raise ValueError(f"expected a number in {MEASURES[measure].unit}, or with its unit")
        key = f"limit.{measure}"
        return float(found[1]) * float(unit_size(MEASURES[measure].kind, found[2], "", key))

    return BeforeValidator(read)


def _limit(measure):
    described = MEASURES[measure]
    return Annotated[
        Positive | None, _in_si(measure), Field(description=f"{described.meaning} [{described.unit}]")
    ]


class LimitState(Strict):
    """One measure of one body or joint with its limit."""

    body: str | None = Field(
        None,
        description="body; of uplift, opening and slip its joints with bodies below, of impacts all its blows",
    )
    joint: tuple[str, str] | None = Field(
        None,
        description="two bodies, in either order, that touch or, of an impact velocity, stand next to each other",
    )
    cases: tuple[str, ...] = Field(
        (), description="names of cases; by default all whose structure has the bodies"
    )
    tilt: _limit("tilt") = None
    drift: _limit("drift") = None
    residual: _limit("residual") = None
    uplift: _limit("uplift") = None
    opening: _limit("opening") = None
    slip: _limit("slip") = None
    impact_velocity: _limit("impact_velocity") = None

    @model_validator(mode="before")
    @classmethod
    def _with_words(cls, given: Any):
        """A key of two words is written with a blank too."""
        if isinstance(given, dict):
            return {key.replace(" ", "_") if isinstance(key, str) else key: one for key, one in given.items()}
        return given

    @model_validator(mode="after")
    def _is_one(self):
        if len(self._stated) != 1:
            raise ValueError(f"expected one of {', '.join(MEASURES)} with its limit")
        if (self.body is None) == (self.joint is None):
            raise ValueError("expected either body or joint")
        if self.tilt is not None and self.tilt > np.radians(_STEEPEST):
            expected = (
                f"expected at most {_STEEPEST} deg; a run ends where a block leans by 45, which overturns"
            )
            raise InputError("", "limit.tilt", expected)
        if self.joint is not None and self.measure in OF_BODIES:
            raise InputError("", "limit.joint", f"expected a body, which {self.measure} is of")
        return self

    @property
    def _stated(self):
        return [name for name in MEASURES if getattr(self, name) is not None]

    @property
    def measure(self):
        """Key of `MEASURES`."""
        return self._stated[0]

    @property
    def limit(self):
        """Value that counts as exceeded beyond, SI."""
        return getattr(self, self.measure)

    @property
    def bodies(self):
        """Names of the bodies that the limit state needs."""
        return (self.body,) if self.joint is None else self.joint


def has_limit(state, case, structure):
    """Whether a limit state is one of a case, by its name and structure."""
    return (not state.cases or case in state.cases) and set(state.bodies) <= set(structure.body_names)
