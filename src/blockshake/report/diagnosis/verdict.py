"""The verdict in words: its sentence, its three numbers, and what the extension changes."""

import numpy as np

from blockshake.diagnosis.inference.decision import FALSE_ALARM
from blockshake.diagnosis.verdict.ladder import ONE_OF
from blockshake.effects.registry import EFFECTS
from blockshake.report.diagnosis.forces_section import FORCE_LAWS, force_words
from blockshake.report.diagnosis.wording import beyond, estimate_words, size_in_unit, title_of, with_place
from blockshake.report.document.units import interval, quantity
from blockshake.report.document.wording import number

_SMALLEST_CHANCE = 1e-6  # that is told as a number


def statement(found):
    """The verdict in one sentence."""
    verdict = found.verdict
    word = verdict.word[0].upper() + verdict.word[1:]
    tests = f"in {len(found.tests)} tests"
    if verdict.decision == "none":
        return (
            f"{word}: {tests} nothing departs farther than one in {round(1 / FALSE_ALARM)} nominal draws does by "
            f"itself (p = {number(verdict.misfit.p, 2)})."
        )
    if verdict.decision == "unknown":
        return (
            f"{word}: {tests} more differs from the nominal model than by chance ({chance_words(verdict.misfit.p)}), "
            f"and no effect of the registry explains it. {_first_sign(found)}"
        )
    physical = [_named(found, name) for name in verdict.causes if name in found.decision.causes]
    sensors = "sensor fault: " + ", ".join(_named(found, name) for name in found.sensor_causes)
    beside = f", beside a {sensors}" if found.sensor_causes else ""
    if verdict.word == ONE_OF:
        return f"{word} {{{'; '.join(physical)}}}{beside}: the measurements do not tell them apart."
    if not physical:
        return f"{word}: {sensors}; beside it {tests} no misfit larger than chance."
    return f"{word}: {' together with '.join(physical)}{beside}."


def _first_sign(found):
    """Where an unknown cause shows: its force if one is described, else the first misfit of a joint."""
    outside = found.verdict.outside
    if outside is None:
        return f"First misfit: {found.verdict.misfit.where}."
    return (
        f"A force along x on {' or '.join(outside.bodies)} would explain it: {FORCE_LAWS[outside.law]}, "
        f"{force_words(outside)}."
    )


def _named(found, name):
    """A cause with its place and its first parameter."""
    words = with_place(name, found.verdict.location.get(name, {}))
    if name not in EFFECTS:
        return words
    first = EFFECTS[name].parameters[0]
    own = found.verdict.parameters.get(name, {}).get(first.name)
    if own:
        words += f", {first.name} {estimate_words(own)}"
    elif name in found.decision.sizes:
        words += f", {first.name} about {single_size(found, name)}"
    return words


def single_size(found, name):
    """Size of a cause that has no interval: a single estimate beside another effect."""
    size = size_in_unit(name, found.decision.sizes[name])
    return quantity(size, EFFECTS[name].parameters[0].unit)


def excluded(found):
    """Sizes that the tests exclude, in one sentence."""
    sizes = [f"{title_of(name)} {beyond(name, size)}" for name, size in found.verdict.excluded_above.items()]
    if not sizes:
        return "No size of any effect is excluded."
    words = f"Excluded, by simulated tests of which nine in ten showed such a size: {', '.join(sizes)}."
    held = found.track_record and found.track_record.shares.get("bound_holds")
    if held:
        words += f" In the track record such a limit held in {held.hits} of {held.n} campaigns."
    return words


def facts(found):
    """The three numbers of the box: chance without a missing effect, size, gain.

    Returns
    -------
    tuple of (label, value, note)
    """
    return (
        (
            "Chance of such a misfit without a missing effect",
            chance_words(found.verdict.misfit.p),
            f"by {_judged_by(found)}; called a misfit at {FALSE_ALARM:g} or less",
        ),
        _size_fact(found),
        _gain_fact(found),
    )


def _judged_by(found):
    """Source of the smallest chance of a verdict, in words."""
    laws, p = found.decision.laws, found.verdict.misfit.p
    if p < found.decision.p_none:
        return "the sensors' checks"
    if laws is None:
        return "features alone"
    return "the laws of the joints" if p == laws.p else "laws and features"


def chance_words(p):
    """A chance, as a number where it is not too small for one."""
    return f"p = {number(p, 2)}" if p > _SMALLEST_CHANCE else f"p below {_SMALLEST_CHANCE:g}"


def _size_fact(found):
    verdict = found.verdict
    for name in verdict.causes:
        if name in EFFECTS and verdict.parameters.get(name):
            first = EFFECTS[name].parameters[0]
            estimate = verdict.parameters[name][first.name]
            return (
                f"{first.name} of {title_of(name)}",
                estimate_words(estimate),
                f"{first.meaning}; 90 % interval",
            )
    if verdict.decision == "none":
        considered = len(found.decision.probabilities)
        return (
            "Effects excluded from some size on",
            f"{len(verdict.excluded_above)} of {considered}",
            "sizes in the table of candidates",
        )
    outside = verdict.outside
    if outside is not None:
        return (
            f"Force along x, {FORCE_LAWS[outside.law]}",
            force_words(outside),
            f"if all of it acts on {outside.bodies[0]}; 90 % interval",
        )
    residual = np.abs(found.misfit["residual"]).max(("joint", "phase", "quantity", "side"))
    if not residual.notnull().any():
        return "Largest residual of any joint", "not known", "the markers tell the motion of no joint"
    test = int(residual.fillna(0.0).to_numpy().argmax())
    return (
        "Largest residual of any joint",
        f"{number(residual[test])} standard deviations",
        f"limit {number(found.misfit['limit'][test])}, in {found.misfit['test'].values[test]}",
    )


def _gain_fact(found):
    label = "Gain on sealed tests, of all that could be gained"
    gain = found.verdict.gain
    if gain is None:
        why = found.gain_caveats or ["the model was not extended: no physical cause was named"]
        return label, "not measured", why[0]
    if found.gain is not None and np.isnan(found.gain["gain"].sel(rival="recalibrated")):
        return label, "nothing to gain", "the recalibrated model errs no more than chance lets it"
    own = gain.recalibrated
    return (
        label,
        f"{100.0 * own.estimate:.0f} % ({100.0 * own.lower:.0f} to {100.0 * own.upper:.0f} %)",
        "against the recalibrated model; 90 % interval"
        if found.gain is not None
        else "of the readings against the other sensors'; span of the sealed tests",
    )


def drift_change(found, test):
    """Sentence on the change that the extension makes to a sealed test, in the user's unit."""
    own = found.consequences.sel(test=test)
    before, after = (
        f"{quantity(float(one['drift']), 'm')} ({interval(one['drift_lower'], one['drift_upper'], 'm')})"
        for one in (own.sel(kind=kind) for kind in ("recalibrated", "extended"))
    )
    return (
        f"On {test}, which was sealed, the median drift of the top block goes from {before} by the recalibrated model "
        f"to {after} by the extended one; the {'virtual test' if found.synthetic else 'test'} had "
        f"{quantity(float(own['measured']), 'm')}."
    )
