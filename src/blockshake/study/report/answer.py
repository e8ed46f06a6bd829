"""First section of a study: what stands, how sure that is, which model to use, what is open, and what to do next."""

from itertools import permutations

import numpy as np

from blockshake.dynamics.system import FALLEN
from blockshake.pages.blocks import Box, Drawing, Figure, Heading, Items, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import (
    MISSING,
    SQUARED,
    given,
    model_label,
    number,
    parameter_label,
)
from blockshake.pages.words import Words, length, span, whole_percent
from blockshake.simulation.models import solver_of
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.comparison.paired import models_apart, theory_of
from blockshake.study.ensembles.coverage import is_likely
from blockshake.study.ensembles.envelope import STILL
from blockshake.study.limit_states.section import worst_of_each
from blockshake.study.report.answer_figure import (
    CURVES,
    is_off_scale,
    plot_answer,
    plot_structures,
    structures_width,
)
from blockshake.study.report.case_outcomes import evidence, most_telling, outcomes
from blockshake.study.report.open_questions import MOST, next_steps, unknown
from blockshake.study.sensitivity.findings import motion_sentences

_WORDS = Words(__name__)
_WIDER = 2.0  # ratio of the ranges of two models' runs, from which on it is said


def answer(content):
    """Verdict, two numbers, structure and displacement, a row a case, differences, gaps and next steps: a page."""
    stripes = content.stripes
    named = {one.name: one for one in stripes}
    found = {one.name: ended for one in stripes if (ended := outcomes(one))}
    if not found:
        return Section("Answer", "answer", (*_synthetic(content), Text(_WORDS.nothing())))
    apart, tried = models_apart(stripes, found)
    theory = {one.stripe: theory_of(named[one.stripe], one) for one in reversed(apart)}
    shown = named[most_telling(found)]
    blocks = [
        Text(_question(content)),
        Box(_verdict(content, found), _facts(stripes, found, shown, theory)),
        *_synthetic(content),
    ]
    best = {name: evidence(ended) for name, ended in found.items()}
    own_limits = worst_of_each(stripes, best, MOST)
    # before the figure: the terminal shows what stands there
    blocks += [Heading("Your limit states", "own-limits"), Items(tuple(own_limits))] if own_limits else []
    blocks += [_figure(content, found, shown), _table(stripes, found)]
    for title, key, sentences in (
        ("Which model to use", "models-apart", _differences(content, apart, tried, theory, found)),
        ("Tests and intensities", "beside", (*_measured(content, found), *_intensities(content))),
        ("Blows between blocks that stand apart", "blows", _blows(found)),
        ("Not known", "not-known", unknown(content)[:MOST]),
        ("Next", "next", next_steps(content, named, found, apart, theory)[:MOST]),
    ):
        blocks += [Heading(title, key), Items(tuple(sentences))] if sentences else []
    return Section("Answer", "answer", tuple(blocks))


def _question(content):
    """The cases, models and samples in a sentence."""
    cases = content.cases.values()
    sizes = [one.samples.sizes["sample"] for case in cases for one in case.responses.values()]
    used = [name for name in content.distributions if content.users(name)]
    kinds = dict.fromkeys(parameter_label(name).split(" of ")[0].split(",")[0] for name in used)
    if any("records" in content.motions[case.motion].attrs for case in cases):
        kinds |= {"ground motion": None}
    return _WORDS.question(
        cases=list(content.cases),
        motions=list(dict.fromkeys(_under(content, case) for case in cases)),
        seconds=list(dict.fromkeys(given(case.settings["duration"]) for case in cases)),
        models=list(content.study["models"]),
        sizes=sorted({min(sizes), max(sizes)}),
        kinds=list(kinds),
        growth=content.growth,
    )


def _under(content, case):
    """Motion of a case with its scale and peak."""
    return _WORDS.motion(
        name=case.motion,
        records=content.motions[case.motion].attrs.get("records", 0),
        levels=[given(one.level) for one in case.stripes if one.level is not None],
        intensity=case.settings.get("intensity") or {},
        scale=given(case.settings["scale"]),
        peak=f"{number(content.peak_acceleration(case))} m/s{SQUARED}",
    )


def _verdict(content, found):
    """Cases that stand, that may collapse and that do, in sentences that follow the best evidence."""
    sides = {"stand": [], "may": [], "fall": [], "open": []}
    for name, ended in found.items():
        shares = [one.share for one in ended.values()]
        down = any(one.collapsed > one.falling for one in ended.values())
        side = "stand" if not any(shares) else "may" if min(shares) < 1.0 else "fall" if down else "open"
        sides[side].append(name)
    best = {name: evidence(ended) for name, ended in found.items()}
    stand = [(model, one) for name in sides["stand"] for model, one in best[name].items()]
    reported = {
        name: best[name] | {m: one for m, one in found[name].items() if one.collapsed} for name in found
    }
    reported = {
        name: dict(sorted(one.items(), key=lambda item: -item[1].share)) for name, one in reported.items()
    }
    sentences = _WORDS.items(
        "verdict",
        sides={side: content.places(names) for side, names in sides.items()},
        may=sides["may"],
        every=[names for names in sides.values() if names] == [list(found)] and len(content.cases),
        levels=any(case.levels for case in content.cases.values()),
        stand={
            "models": list(dict.fromkeys(model for model, _ in stand)),
            "fewest": min((one.counted for _, one in stand), default=0),
            "sure": all(one.is_sure for _, one in stand),
            "upper": max((one.limits[1] for _, one in stand), default=0.0),
        },
        reported=reported,
        lower=min((one.limits[0] for name in sides["fall"] for one in best[name].values()), default=0.0),
    )
    return "\n".join(sentences)


def _facts(stripes, found, shown, theory):
    """The two numbers of the box: displacement and margin of the median run."""
    levels = [one.name for one in stripes if one.case is shown.case and one.name in found]
    used = {name: _used(found[name], theory.get(name)) for name in levels}
    of_case = [one for ended in used.values() for one in ended.values()]
    far = max(of_case, key=lambda one: one.most)
    near = min(of_case, key=lambda one: np.nan_to_num(one.least_margin, nan=np.inf))
    case = {
        "name": shown.case.name,
        "models": list(dict.fromkeys(model for ended in used.values() for model in ended)),
        "theory": all(name in theory and theory[name].borne_out for name in levels),
    }

    def by_level(name, show, unit):
        ends = levels if len(levels) < MOST else [levels[0], levels[-1]]
        figures = [span([getattr(one, name) for one in used[at].values()], show) for at in ends]
        return _WORDS.by_level(
            [(at.partition(" ")[2], one) for at, one in zip(ends, figures, strict=True)], unit
        )

    return (
        (
            "Largest displacement on the slab, median run by model",
            by_level("peak", length, "mm"),
            _WORDS.displacement(
                case=case, one=far, farther=_farther(found, shown, max(one.peak for one in of_case))
            ),
        ),
        (
            "Margin against overturning, median run by model",
            by_level("margin", whole_percent, "%") if near.over else MISSING,
            _WORDS.margin(case=case, one=near, worst=_margin(near.least_margin), leaves=_leaves(of_case)),
        ),
    )


def _used(ended, theory):
    """Outcome of the model that theory bears out; of the best evidence where it decides for none."""
    return {theory.borne_out: ended[theory.borne_out]} if theory and theory.borne_out else evidence(ended)


def _farther(found, shown, reached):
    """Another case whose best evidence moves a block farther than a displacement [m]: name and `Outcome`, or None."""
    of_others = [
        (one.peak, name, one)
        for name, ended in found.items()
        for one in evidence(ended).values()
        if not name.startswith(shown.case.name)
    ]
    peak, name, one = max(of_others, default=(0.0, "", None), key=lambda item: item[0])
    return {"name": name, "one": one} if peak > reached else None


def _leaves(of_case):
    """Margins of the leaves of a wall in percent, by name."""
    margins = {name: [one.leaves[name] for one in of_case] for name in of_case[0].leaves}
    return {name: span(ends, whole_percent) for name, ends in margins.items() if np.isfinite(ends).all()}


def _table(stripes, found):
    """A row a stripe and a model that bears limits or collapses: how its runs ended, and how far a block went."""
    rows = [
        (
            name, model_label(model), f"{one.collapsed} of {one.counted}",
            f"{whole_percent(one.limits[0])} to {whole_percent(one.limits[1])}" if one.is_sure else "too few runs",
            length(one.peak), span((one.least, one.most)) if one.counted > 1 else "one run",
            _margin(one.margin), _margin(one.least_margin),
            "" if one.collapsed else length(one.end) if np.isfinite(one.end) else "moves", one.block,
        )
        for name, ended in found.items()
        for model, one in ended.items()
        if one.is_sure or one.collapsed or not any(other.is_sure for other in ended.values())
    ]  # fmt: skip
    return Table(
        _WORDS.caption(
            levels=any(one.level is not None for one in stripes),
            few=SURE_FROM if len(rows) < sum(map(len, found.values())) else 0,
        ),
        (
            "Case", "Model", "Collapsed", "Probability [%]", "Median [mm]", "All runs [mm]", "Margin [%]", "Worst [%]",
            "Left [mm]", "Block",
        ),
        tuple(rows), "llrrrrrrrl", (2.5, 1.4, 1.0, 1.2, 0.8, 1.2, 0.8, 0.7, 0.7, 0.9),
    )  # fmt: skip


def _margin(least):
    """A margin against overturning in percent; beyond the edge it has no size that tells anything."""
    return MISSING if np.isnan(least) else whole_percent(least) if least >= 0.0 else "over"


def _figure(content, found, shown):
    one = max(found[shown.name].values(), key=lambda ended: ended.peak)
    structures = list(
        {case.settings["structure"]: case.structure for case in content.cases.values()}.values()
    )
    return Figure(
        _WORDS.figure(case=shown.case, one=one, off_scale=is_off_scale(shown.case, one.marker)),
        svg_of(plot_answer, shown.case, one.marker),
        CURVES,
        left=Drawing(
            svg_of(plot_structures, structures, shown.case, one.marker), structures_width(structures)
        ),
    )


def _differences(content, apart, tried, theory, found):
    """Where models differ by more than chance, and which of them theory bears out."""
    if not any(len(ended) > 1 for ended in found.values()):
        return ()
    of_stripe = {one.stripe: one for one in reversed(apart)}
    first = next((one for one in apart if theory[one.stripe].borne_out), apart[0] if apart else None)
    return _WORDS.items(
        "differences",
        still=all(one.most <= STILL for ended in found.values() for one in ended.values()),
        levels=any(case.levels for case in content.cases.values()),
        apart=list(of_stripe.values())[::-1],
        found=found,
        alike=content.places([name for name in tried if name not in of_stripe]),
        wider=_wider(found),
        tried=tried,
        first=first,
        theory=theory[first.stripe] if first else None,
        rigid=[one for one in (first.near, first.far) if _is_rigid_contact(one)] if first else [],
        most=MOST,
    )


def _wider(found):
    """Two models of a case of which the runs of one scatter most beyond those of the other; None without."""
    most, chosen = _WIDER, None
    for name, ended in found.items():
        for (wide, of), (narrow, other) in permutations(ended.items(), 2):
            times = (of.most - of.least) / max(other.most - other.least, STILL)
            if of.counted == other.counted and of.is_sure and times >= most:
                most = times
                chosen = {"name": name, "wide": wide, "of": of, "narrow": narrow, "other": other}
    return chosen


def _is_rigid_contact(model):
    """Whether a model has rigid blocks that meet without springs."""
    return solver_of(model).rigid and not solver_of(model).calibrated


def _measured(content, found):
    """Measured displacement of each case, and the models whose samples it may be one more of."""
    rows = []
    for name, case in content.cases.items():
        if case.measured is None or name not in found:
            continue
        one = max(found[name].values(), key=lambda end: end.peak)
        if one.marker not in case.measured["marker"].values:
            continue
        fits = {}
        for model in found[name]:
            comparison = case.responses[model].comparison
            chance = float(comparison["curve_probability"].sel(marker=one.marker))
            if np.isfinite(chance):
                fits[model] = is_likely(chance, int(comparison.attrs["counted"]))
        peak = float(case.measured["peak"].sel(frame="slab", marker=one.marker))
        rows.append({"case": case, "one": one, "peak": peak, "fits": fits})
    return _WORDS.items("measured", rows[:MOST])


def _intensities(content):
    """Intensities at which half of the samples reach a potential collapse, and what the motion explains."""
    ladders = [
        {
            "name": name,
            "drift": span([float(limit) for limit in one["largest_drift"].values.flat if np.isfinite(limit)]),
            "fell": bool(np.isin(one["status"].values, FALLEN).any()),
            "median": float(one["median"]),
            "dispersion": float(one["dispersion"]),
            "bracket": (float(one["capacity_lower"].max()), float(one["capacity_upper"].min())),
        }
        for name, one in content.fragility.items()
        if np.isfinite(one["median"])
    ]
    return (*_WORDS.items("intensities", ladders=ladders, study=content.study), *motion_sentences(content))


def _blows(found):
    """How often blocks that stand apart strike each other and how fast, a sentence a case, and what is unknown."""
    struck = {name: ended for name, ended in found.items() if any(one.struck for one in ended.values())}
    apart = any(len(one.leaves) > 1 for ended in found.values() for one in ended.values())
    return _WORDS.items("blows", struck=dict(list(struck.items())[:MOST]), apart=apart)


def _synthetic(content):
    """Remark on curves and motions that nobody measured."""
    cases = content.cases.values()
    motions = sorted({case.motion for case in cases if content.motions[case.motion].attrs.get("synthetic")})
    tests = [case.name for case in cases if case.synthetic]
    words = _WORDS.synthetic(motions=motions, tests=tests, every=len(tests) == len(cases))
    return [Text(words, strong=True)] if words else []
