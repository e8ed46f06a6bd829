"""The decision on a campaign's open tests: what acts, where, how large, and how the rivals stand."""

from typing import Literal

import numpy as np
from pydantic import Field, JsonValue, model_validator

from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import title_of
from blockshake.errors import InputError
from blockshake.files import file_digest, load_json, load_made_json, write_json
from blockshake.validation import Count, Finite, Fraction, Strict, validated

HELD_OUT_LEVEL = 0.05  # of the test of a cause on the tests to select by
MEMBERS = 40  # sets of parameters by which a model is extended


class Estimate(Strict):
    """A parameter with its 90 % interval."""

    estimate: Finite
    lower: Finite
    upper: Finite
    unit: str

    @model_validator(mode="after")
    def _ordered(self):
        if not self.lower <= self.estimate <= self.upper:
            raise ValueError("expected lower <= estimate <= upper")
        return self


class Measurement(Strict):
    """A measurement that would split a set: what it is between, its kind, in words, and the share of split cases."""

    between: tuple[str, ...]
    kind: str
    test: str
    share: Fraction


class Cause(Strict):
    """A cause that the readings support, at its most probable place."""

    name: str  # effect of the registry, or form from outside
    # ``{"joint": [lower, upper]}``, ``{"body": name}`` and what else states where, empty of a cause that is
    # everywhere
    place: dict[str, JsonValue]
    places: tuple[str, ...]  # in words, all that cannot be distinguished from it
    gain: Finite  # logarithm of its evidence over that of none
    odds: Finite  # of the most probable cause over this one, as a logarithm, coarsened
    parameters: dict[str, Estimate]
    members: tuple[dict[str, Finite], ...]  # parameters drawn from their posterior, in a fixed random order
    # the most probable variant: parameters that are no amplitudes; of a form from outside starts, sides and tests
    when: dict[str, JsonValue] = Field(default_factory=dict)
    # of the variant, at their best: what its rows on further tests are multiplied with
    amplitudes: tuple[Finite, ...] = ()

    @property
    def outside(self):
        """Whether it is no effect of the registry."""
        return self.name in FORMS

    @property
    def title(self):
        """In words."""
        return FORMS[self.name].title if self.outside else title_of(self.name)


class HeldOut(Strict):
    """The most probable cause of a part on the tests to select by alone."""

    tests: tuple[str, ...]
    gain: Finite  # logarithm of its evidence over none by these tests
    tried: Count  # causes and places among which it was chosen
    p: Fraction  # largest chance of as much without any cause
    # gain that a cause of its size gives; None of one that moves the slab in every test
    expected: Finite | None = None

    @property
    def holds(self):
        """Whether the tests bear the cause out, at the level `HELD_OUT_LEVEL`."""
        return self.p <= HELD_OUT_LEVEL

    @property
    def tells(self):
        """Whether the tests would bear out a cause of this size: what it does in them suffices for the level."""
        return self.expected is None or self.expected > np.log(self.tried / HELD_OUT_LEVEL)


class Part(Strict):
    """One part of the readings that something acts on: the causes that cannot be distinguished, the most probable
    first."""

    # ``joints``, ``joints, beside the first``, ``impacts``, ``free flight``, ``rotation of the slab`` or
    # ``vertical motion of the slab``
    readings: str
    causes: tuple[Cause, ...]
    odds: dict[str, Finite]  # of the most probable over every rival, as a logarithm, coarsened
    gains: dict[str, Finite]  # logarithm of the evidence over none, by rival
    # that would split the causes, by falling share; empty of a single one
    next_tests: tuple[Measurement, ...] = ()
    held_out: HeldOut | None = None  # none without tests to select by, or where they show nothing

    @property
    def effects(self):
        """Causes of the registry."""
        return tuple(one for one in self.causes if not one.outside)

    @property
    def forms(self):
        """Causes from outside."""
        return tuple(one for one in self.causes if one.outside)


class History(Strict):
    """A size by test, in the order of the campaign: of a cause, or of undamaged joints."""

    quantity: str  # name of the cause, or ``edges``, ``middle`` or ``friction``
    parameter: str  # name of the size
    place: dict[str, JsonValue]  # as of `Cause`; empty of all joints together
    tests: tuple[str, ...]
    sizes: tuple[Estimate, ...]  # of each test alone, under one prior
    # logarithm of the evidence of sizes that walk from test to test over that of one size for all
    gain: Finite
    changes: bool  # it is more than a chance
    # by name, what follows from the sizes: period and damping ratio of the body's mass on a spring with a damper
    derived: dict[str, tuple[Estimate, ...]] = Field(default_factory=dict)
    beats: str = ""  # name of a cause of which these sizes, without it, explain more than it does; else empty


class Decision(Strict):
    """The whole file."""

    decision: Literal["none", "named", "ambiguous", "combination", "unknown"]  # kind of the answer
    parts: tuple[Part, ...]  # by falling strength; empty where nothing acts
    # of every effect of the registry: in its part, among all rivals and none, coarsened
    probabilities: dict[str, Fraction]
    # by effect and place: the size from which it would have been seen; places where the tests do not tell are
    # left out
    limits: dict[str, dict[str, Finite]]
    # the same of effects that would have been seen wherever they may be: the largest of the places
    excluded_above: dict[str, Finite]
    p: Fraction  # largest chance of as much evidence against none, by Markov's inequality
    where: str  # the largest departure in words
    # tests, silent: tests that were judged by, and those among them of which no joint turned, slipped or
    # lifted
    tests: tuple[str, ...]
    silent: tuple[str, ...]
    n_rows: Count
    impacts: str = ""  # statement on the share of spin that impacts kept
    cannot_see: tuple[str, ...] = ()  # what the sensors do not show
    histories: tuple[History, ...] = ()  # sizes from test to test
    clean_runs: Count = 0  # simulated campaigns without a cause, by which the thresholds were set
    # evidence from which a cause is asserted, by name
    thresholds: dict[str, Finite] = Field(default_factory=dict)

    @property
    def moved(self):
        """Tests of which a joint turned, slipped or lifted: the equations of motion are theirs."""
        return tuple(name for name in self.tests if name not in self.silent)

    @property
    def causes(self):
        """Effects of the registry that are not excluded, the most probable `Cause` of each name."""
        most_probable = {}
        for one in (one for part in self.parts for one in part.effects):
            most_probable.setdefault(one.name, one)
        return tuple(most_probable.values())

    @property
    def forms(self):
        """Forms from outside that are not excluded."""
        return tuple(one for part in self.parts for one in part.forms)

    @property
    def extending(self):
        """The most probable cause of every part: together they extend the model."""
        return tuple(part.causes[0] for part in self.parts)


def write_decision(path, decision):
    """Write a decision as JSON."""
    write_json(path, decision.model_dump(mode="json"))


def load_decision(path):
    """`Decision` of a file."""
    return validated(Decision, load_json(path), path)


def freeze(path, decided, tests):
    """Write the digest of a file that was decided, a decision or a size, and the tests that it rests on."""
    write_json(path, {"digest": file_digest(decided), "tests": list(tests)})


def check_frozen(path, decided):
    """Refuse a file that is another than the frozen one, with `InputError`."""
    frozen = load_made_json(path, lambda value: str(value["digest"]))
    digest = file_digest(decided)
    if digest != frozen:
        raise InputError(decided, "", f"expected the file that was frozen as {frozen}, found {digest}")
