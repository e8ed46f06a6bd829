"""One verdict next to its truth: named, asserted, placed and sized, and whether the tests could show it."""

from dataclasses import dataclass
from functools import cached_property

from answer_file import Answer
from oracle_gain import ResponseGains
from outside_forces import OUTSIDE

from blockshake.effects.registry import EFFECTS

SENSORS = {name for name, effect in EFFECTS.items() if effect.acts == "observation"}
# forms from outside that make the forces of an effect of the registry, or nearly: said as one class, they are right
ALIKE = {
    "stopper-contact": {"rope", "spring-once"},
    "eccentricity": {"push"},
    "reduced-bearing": {"changed-edge"},
    "weak-joint": {"dry-drag"},
    "block-mass": {"loose-weight"},
}
LEAST_MOVED = 5.0  # standard deviations of a marker's reading
_ROPE, _STOP = "outside-rope", "stopper-contact"  # a rope is a stop on the other side


@dataclass(frozen=True)
class Scored:
    """One case: its truth as the maker wrote it, the verdict, and the gains where they were measured."""

    name: str
    truth: dict  # ``causes``, ``size``, ``seed``, ``structure``, ``sealed``, ``tests``, and more
    verdict: Answer
    gains: ResponseGains | None = None

    @property
    def laboratory(self):
        """Key of `make_case.LABORATORIES`."""
        return self.truth.get("laboratory", "home")

    @property
    def unseen(self):
        """Whether a cause from outside moves no marker by five standard deviations next to a twin without it."""
        moved = self.truth.get("moved")
        return moved is not None and moved < LEAST_MOVED

    @cached_property
    def causes(self):
        """The hidden causes by name."""
        return {cause["name"]: cause for cause in self.truth["causes"]}

    @property
    def kind(self):
        """``clean``, ``effect``, ``outside`` or ``pair``."""
        if len(self.causes) != 1:
            return "pair" if self.causes else "clean"
        return "outside" if self.truth["size"] is None else "effect"

    @property
    def cause(self):
        """The only cause of a single case."""
        (cause,) = self.truth["causes"]
        return cause

    def holds(self, name):
        """Whether a cause is among those of the verdict, or its form is the one that is said."""
        if name in OUTSIDE:
            return self.form == OUTSIDE[name].form
        return name in self.verdict.causes

    @property
    def form(self):
        """Form from outside that the verdict states, or None."""
        return self.verdict.outside.form if self.verdict.outside else None

    @property
    def held(self):
        """Number of hidden causes that the verdict holds."""
        return sum(self.holds(name) for name in self.causes)

    @property
    def answer(self):
        """Column of the confusion matrix."""
        decision = self.verdict.decision
        if decision == "named":
            return "right" if self.verdict.causes[0] in self.causes else "wrong"
        if decision == "ambiguous":
            return "set_with" if self.held else "set_without"
        return decision

    @property
    def asserted(self):
        """Number of causes that the verdict states act at once: the leaders of its parts, and faults of sensors."""
        odds = self.verdict.odds
        if self.verdict.decision == "none":
            return 0
        if not odds:
            parts = len(self.verdict.causes) + (self.verdict.outside is not None)
            return max(parts, 1) if self.verdict.decision == "combination" else 1
        leaders = sum(value == 0.0 for value in odds.values()) + sum(
            name not in odds for name in self.verdict.causes
        )
        return max(leaders, 1)

    @property
    def within_class(self):
        """Whether a set holds the truth, and nothing but what is mistaken for it by the registry or by `ALIKE`."""
        if self.answer != "set_with":
            return False
        group = {self.cause["name"], *EFFECTS[self.cause["name"]].confused_with}
        group |= {name for name, effect in EFFECTS.items() if self.cause["name"] in effect.confused_with}
        return set(self.verdict.causes) <= group and (
            self.form is None or self.form in ALIKE.get(self.cause["name"], ())
        )

    @property
    def called_unknown(self):
        """Whether a cause from outside is called unknown; a rope also where it is said next to a stop."""
        said = self.cause["name"] == _ROPE and self.holds(_ROPE) and set(self.verdict.causes) == {_STOP}
        return self.answer == "unknown" or (said and self.verdict.decision == "ambiguous")

    @property
    def can_be_seen(self):
        """Whether an effect is larger than what the verdict states these tests would have shown.

        The limit is of the smallest at the true place, from the rows before any cause was looked for; a verdict states
        none of faults of sensors, which count as seen. A stop must be reached in an open test as well.
        """
        name = self.cause["name"]
        if name in SENSORS:
            return True
        null = EFFECTS[name].parameters[0].null
        limits = [
            abs(limit - null)
            for place, limit in self.verdict.limits.get(name, {}).items()
            if _is_there(place, self.cause["place"])
        ]
        return bool(limits) and self.size >= min(limits) and (name != _STOP or self._reached)

    @property
    def size(self):
        """Distance of an effect's first parameter from its null value."""
        first = EFFECTS[self.cause["name"]].parameters[0]
        return abs(self.cause["values"][first.name] - first.null)

    @property
    def _reached(self):
        place, gap = self.cause["place"], self.cause["values"]["gap"]
        side = 1.0 if place["axis"] == "+x" else -1.0
        open_tests = [test for test in self.truth["tests"].values() if test["role"] != "sealed"]
        return max(side * end for test in open_tests for end in test["drift"][place["body"]]) > gap

    @property
    def placed(self):
        """Whether the true place is the one that is said, or among those that cannot be distinguished from it."""
        place, name = self.cause["place"], self.cause["name"]
        if name in OUTSIDE:
            return any(_is_there(said, place) for said in self.verdict.outside.places)
        said = self.verdict.location.get(name, {})
        exact = bool(said) and all(_names(place.get(kind)) == _names(where) for kind, where in said.items())
        return exact or any(_is_there(one, place) for one in self.verdict.places.get(name, ()))

    @property
    def lateness(self):
        """How far the starts that are said lie from the true ones, of tests in which the cause acts [s].

        A start that is said as ``then or earlier`` is missed by what the true one is later.
        """
        true, said = dict(zip(self.truth["tests"], self.cause["start"], strict=True)), self.verdict.outside
        return [
            float("inf") if true[test] is None
            else max(true[test] - at, 0.0) if test in said.before
            else abs(at - true[test])
            for test, at in said.starts.items()
        ]  # fmt: skip

    @property
    def covered(self):
        """Whether each interval that is said of the truth's parameters holds it, by parameter."""
        true = self.cause["values"]
        return {
            name: said.lower <= true[name] <= said.upper
            for name, said in self.verdict.parameters.get(self.cause["name"], {}).items()
            if name in true
        }


def _names(where):
    return (where,) if isinstance(where, str) else tuple(sorted(where or ()))


def _is_there(words, place):
    """Whether a place in the words of a verdict is one of the truth: ``all``, a joint, or a body and a height."""
    if "joint" in place:
        return words in ("-".join(place["joint"]), "-".join(place["joint"][::-1]))
    if "body" in place:
        said, body = words.partition("@")[0], place["body"]
        return said == body or said.startswith(f"{body}-") or said.endswith(f"-{body}")
    return not place
