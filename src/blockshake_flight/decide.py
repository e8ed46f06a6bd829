"""The decision on tests of a body over a ground at rest: free flight first, then what impacts keep."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.answer.answer import Alternative, find_causes, share_of
from blockshake.diagnosis.answer.decide import chance, kind_of, probabilities
from blockshake.diagnosis.answer.decision import Cause, Decision, Estimate, Part
from blockshake.diagnosis.answer.size import FORM
from blockshake.diagnosis.answer.thresholds import by_odds
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.wording import estimate_in_si
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake_flight.arcs import find_arcs
from blockshake_flight.causes import CAUSES
from blockshake_flight.evidence import explain, explained_share, flight_rows, widened
from blockshake_flight.impacts import find_impacts, summary
from blockshake_flight.inertia import seen_ratios
from blockshake_flight.paths import fallen
from blockshake_flight.tracked_test import load_tracked

_NINETY = 1.645  # standard deviations
_READINGS = "free flight"


class DecidedFlights(NamedTuple):
    """A decision; and along ``flight`` and ``impact`` what was measured and explained."""

    decision: Decision
    evidence: xr.Dataset


def decide(campaign, files, without):
    """`DecidedFlights` of a campaign, see `CampaignKind`; of ``files`` none is read."""
    return decide_flights(load_tracked(campaign, list(campaign.open)), without)


def decide_flights(tracked, without=()):
    """Decide what the flights of some tests support.

    Parameters
    ----------
    tracked : TrackedCampaign
        Open tests.
    without : sequence of str
        Effects that are left out.

    Returns
    -------
    DecidedFlights

    Raises
    ------
    InputError
        No flight.
    """
    arcs, broken = find_arcs(tracked)
    if not arcs:
        raise InputError(
            tracked.structure.source, "tests",
            f"expected tests in which {tracked.name} flies for some readings; found {len(broken)} flights, none of "
            "them smooth",
        )  # fmt: skip
    impacts = find_impacts(tracked, arcs)
    rows = flight_rows(tracked, arcs)
    conditional, nominal, stages = rows, [], []  # fits of every stage, by falling gain

    def needed(cause, known):
        return by_odds(cause) + share_of(known)

    def ranked(known):
        nonlocal conditional
        if known:
            first = stages[-1][0]
            conditional = conditional.given(first, FORM if first.cause.name in FORMS else 0.0)
        taken = {*without, *(one.cause for one in known), *(fit.cause.name for fit in nominal)}
        while fits := sorted(
            (explain(conditional, cause) for cause in CAUSES if cause.name not in taken),
            key=lambda fit: -fit.gain,
        ):
            first = fits[0]
            if first.gain < needed(first.cause.name, known) or first.size >= first.cause.nominal_size(
                tracked
            ):
                break
            nominal.append(first)
            taken.add(first.cause.name)
            conditional = conditional.given(first, 0.0)
        stages.append(fits)
        return [
            Alternative(fit.cause.name, tracked.name, fit.gain, fit.gain, (tracked.name,)) for fit in fits
        ]

    groups = find_causes(ranked, needed)
    firsts = [fits[0] for fits in stages[: len(groups)]]
    hidden = [fit for fits in stages[len(groups) :] for fit in fits if fit.gain > by_odds(fit.cause.name)]
    alike = []
    for group, fits, own in zip(groups, stages, firsts, strict=False):
        others = [*nominal, *(first for first in firsts if first is not own)]
        again = [rows.refitted(fit, others) for fit in fits[: len(group.rivals)]]
        alike.append([widened(rows, fit, others) for fit in again])
    parts = tuple(_part(tracked, group, fits) for group, fits in zip(groups, alike, strict=True))
    causes = [fits[0] for fits in alike]
    share = explained_share(rows, causes) if causes else 0.0
    names = [test.name for test in tracked.tests]
    mirrored = _gain_of_mirrored(tracked, arcs, causes)
    decision = Decision(
        decision=kind_of(parts),
        parts=parts,
        probabilities=probabilities(parts, without),
        limits=_limits(tracked, rows, share_of([group.rivals[0] for group in groups])),
        excluded_above={},
        p=min(1.0, sum(map(chance, parts))) if parts else 1.0,
        where=f"free flight of {tracked.name}" if groups else "no departure larger than chance",
        tests=names,
        silent=(),
        n_rows=sum(map(len, rows.values)),
        impacts=impact_words(summary(impacts)),
        cannot_see=_not_seen(tracked, broken, alike, share, rows, hidden[:1], mirrored),
    )
    return DecidedFlights(decision, _evidence(tracked, rows, causes, impacts, broken, share))


def _gain_of_mirrored(tracked, arcs, causes):
    """How much better flights with rotations of the other hand are explained, by the first cause and a mass centre.

    A point that is tracked next to the mass centre shows the hand: it circles with the rotations.
    """
    conditional = next(cause for cause in CAUSES if cause.name == "eccentricity")
    taken = dict.fromkeys([*(fit.cause for fit in causes[:1]), conditional])

    def gain(sign):
        turned = [replace(arc, rotation=sign[:, None] * arc.rotation * sign) for arc in arcs]
        rows, found = flight_rows(tracked, turned), 0.0
        for cause in taken:
            fit = explain(rows, cause)
            rows, found = rows.given(fit, 0.0), found + fit.gain
        return found

    mirrors = [np.where(np.arange(3) == axis, -1.0, 1.0) for axis in arcs[0].axes if axis < 2]
    return max(map(gain, mirrors)) - gain(np.ones(3))


def _part(tracked, group, fits):
    causes = tuple(
        Cause(
            name=fit.cause.name,
            place={"body": tracked.name},
            places=(tracked.name,),
            gain=fit.gain,
            odds=group.odds[fit.cause.name],
            parameters=_sizes(tracked, fit),
            members=(
                {name: float(size) for (name, _), size in zip(fit.cause.sizes, fit.sizes, strict=True)},
            ),
            amplitudes=fit.sizes.tolist(),
        )
        for fit in fits
    )
    return Part(readings=_READINGS, causes=causes, odds=group.odds, gains=group.gains)


def _sizes(tracked, fit):
    """Sizes with intervals of 90 %; those of a form, which may be another one's, a tenth wider to either side."""
    found, outside = {}, fit.cause.name in FORMS
    for (name, unit), size, deviation in zip(
        fit.cause.sizes, fit.sizes, np.sqrt(np.diag(fit.covariance)), strict=True
    ):
        half = _NINETY * deviation + (FORM * abs(size) if outside else 0.0)
        found[name] = Estimate(
            estimate=float(size), lower=float(size - half), upper=float(size + half), unit=unit
        )
    if fit.cause.name == "drag":
        mass, one = float(tracked.structure.mass[tracked.body]), found["damping"]
        found["rate"] = Estimate(
            estimate=one.estimate / mass, lower=one.lower / mass, upper=one.upper / mass, unit="1/s"
        )
    return found


def _limits(tracked, rows, more):
    """Sizes of effects of the registry along the filmed directions from which on they would have been named."""
    found = {}
    for cause in CAUSES:
        if cause.name not in EFFECTS:
            continue
        deviations = np.sqrt(np.diag(explain(rows, cause).covariance))
        scale = cause.scale(tracked)
        seen = deviations[deviations < 0.9 * scale]  # the others are not filmed
        if len(seen):
            # the gain of a size m: m^2 / (2 d^2) - ln(scale / d)
            needed = by_odds(cause.name) + more + np.log(scale / seen).sum()
            found[cause.name] = {
                tracked.name: max(float(np.sqrt(2.0 * needed) * seen.max()), cause.nominal_size(tracked))
            }
    return found


def _not_seen(tracked, broken, alike, share, rows, hidden, mirrored):
    """Lines on what the poses do not show.

    ``alike``: by cause, the fits that are not distinguished; ``hidden``: the one that the share of the named ones
    hides, or none; ``mirrored``: see `_gain_of_mirrored`.
    """
    lines = [
        f"{len(rows.arcs)} free flights lie {1e3 * rows.noise:.3g} mm about cubics, in the root mean square"
    ]
    if broken:
        lines.append(
            f"{len(broken)} flights were left out: something other than the ground was hit, or the tracking slipped"
        )
    silent = [test.name for test in tracked.tests if test.name not in {arc.test for arc in rows.arcs}]
    if silent:
        lines.append(f"no free flight was read in {', '.join(silent)}")
    if alike:
        lines.append(f"the causes explain {100.0 * share:.0f} % of what the flights have beyond noise")
    lines += [
        f"with them {fit.cause.title} gains {fit.gain:.0f} nats, less than a tenth of what they gain, and is not "
        "named"
        for fit in hidden
    ]
    lines.append(_inertia_words(seen_ratios(tracked, rows.arcs)))
    if mirrored > by_odds("eccentricity"):
        lines.append(
            f"rotations of the other hand would explain the flights better, by {mirrored:.0f} nats: the signs of the "
            "angles, or of a horizontal axis, are to be checked"
        )
    for fits in alike:
        if len(fits) > 1:
            lines.append(
                "free flight does not tell these apart: "
                + "; ".join(f"{fit.cause.title} ({_size_words(tracked, fit)})" for fit in fits)
            )
        lines += [fit.cause.alias for fit in fits if fit.cause.alias]
    if any(test.planar for test in tracked.tests):
        lines.append("the motion was filmed in one plane: nothing across it is known")
    return tuple(lines)


def _inertia_words(ratios):
    """The moments of inertia as free flight tells them, from `seen_ratios`."""
    if ratios is None:
        return "free flight does not tell the moments of inertia"
    found = np.exp(ratios[0] + _NINETY * np.array([[0.0], [-1.0], [1.0]]) * ratios[1])
    y, z = ("{:.3f} ({:.3f} to {:.3f})".format(*own) for own in found.T)
    return (
        f"moments of inertia over that about x, against the structure file's ratios: y {y}, z {z}; free flight tells "
        "ratios alone"
    )


def _size_words(tracked, fit):
    return ", ".join(f"{name} {estimate_in_si(one)}" for name, one in _sizes(tracked, fit).items())


def impact_words(found):
    """One sentence by kind of impact on what it keeps; empty without any."""
    words = []
    for kind, own in found.items():
        if "restitution" in own:
            one, ratio = own["restitution"], own["ratio"]
            words.append(
                f"impacts of {'an' if kind == 'edge' else 'a'} {kind} ({one['count']}) keep {one['median']:.2f} "
                f"({one['lower']:.2f} to {one['upper']:.2f}, quartiles) of the normal velocity; tangential over normal "
                f"impulse {ratio['median']:.2f} ({ratio['lower']:.2f} to {ratio['upper']:.2f})"
            )
        if "returned" in own:
            one, kept = own["returned"], own["kept"]
            words.append(
                f"faces that come down in rocking ({one['count']}): {100.0 * one['share']:.0f} % return to the edge "
                f"that they came from, spin kept {kept['median']:.2f} ({kept['lower']:.2f} to {kept['upper']:.2f})"
            )
    return "; ".join(words)


def _evidence(tracked, rows, causes, impacts, broken, share):
    """Mean acceleration and velocity of every flight, measured and explained, and all impacts."""
    arcs, gravity = rows.arcs, tracked.structure.file.gravity
    taken = [_mean_acceleration(arc, arc.position - fallen(arc, gravity)) for arc in arcs]
    explained = [
        sum(
            (
                _mean_acceleration(arc, np.einsum("nkx,k->nx", fit.cause.paths(arc, tracked), fit.sizes))
                for fit in causes
            ),
            np.zeros(3),
        )
        for arc in arcs
    ]
    shape = ("flight", "axis")
    return xr.Dataset(
        {
            "velocity": (shape, [arc.smooth()[1].mean(axis=0) for arc in arcs], {"units": "m s-1"}),
            "acceleration": (shape, taken, {"units": "m s-2"}),
            "explained": (shape, explained, {"units": "m s-2"}),
            "length": ("flight", [arc.time[-1] for arc in arcs], {"units": "s"}),
            **{
                name: ("impact", [getattr(impact, name) for impact in impacts])
                for name in ("time", "restitution", "ratio", "kept")
            },
        },
        {
            "test": ("flight", [arc.test for arc in arcs]),
            "axis": list("xyz"),
            "impact_test": ("impact", [impact.test for impact in impacts]),
            "kind": ("impact", [impact.kind for impact in impacts]),
        },
        {"left_out": len(broken), "explained_share": share, "noise": rows.noise},
    )


def _mean_acceleration(arc, path):
    """For a path, by the parabola through it, (3,) [m/s2]."""
    return 2.0 * np.polyfit(arc.time, path, 2)[0]
