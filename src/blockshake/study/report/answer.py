"""First section of a study: whether blocks stand, move or fall, how sure that is, why models differ, what is next."""

import numpy as np

from blockshake.pages.blocks import Box, Figure, Heading, Items, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import (
    MISSING,
    SQUARED,
    count_words,
    given,
    listed,
    model_label,
    number,
    parameter_label,
    sentence_case,
    share_words,
)
from blockshake.study.ensembles.coverage import is_likely
from blockshake.study.ensembles.envelope import STILL
from blockshake.study.report.answer_figure import plot_answer
from blockshake.study.report.case_outcomes import models_apart, most_telling, outcomes, shares_at_impacts
from blockshake.study.report.open_questions import ALIKE, MOST, next_steps, unknown


def answer(content):
    """Verdict, three numbers, structure and displacement, a line a case, differences, gaps and next steps: a page."""
    found = {case.name: ended for case in content.cases.values() if (ended := outcomes(case))}
    if not found:
        return Section(
            "Answer", "answer", (*_synthetic(content), Text("No sample of any case has a result."))
        )
    shown = content.cases[most_telling(found)]
    blocks = [
        Text(_asked(content)),
        Box(_verdict(found), _facts(content, found, shown)),
        *_synthetic(content),
        _figure(content, found, shown),
        _lines(content, found),
    ]
    compared = _measured(content, found)
    said = [*_why(content, found), *compared]
    halves = [
        f"{number(float(one['median']), 2)} times the motion ({name})"
        for name, one in content.fragility.items()
        if np.isfinite(one["median"])
    ]
    said += [f"Half of the samples fall below {listed(halves)}." for _ in halves[:1]]
    for title, key, sentences in (
        ("Blows between blocks that stand apart", "blows", _blows(found)),
        ("Why the models differ" if not compared else "Models and tests beside each other", "beside", said),
        ("Not known", "not-known", unknown(content)[:MOST]),
        ("Next", "next", next_steps(content, found)[:MOST]),
    ):
        blocks += [Heading(title, key), Items(tuple(sentences))] if sentences else []
    return Section("Answer", "answer", tuple(blocks))


def _asked(content):
    """The cases, models and samples in a sentence."""
    under = dict.fromkeys(_under(content, case) for case in content.cases.values())
    seconds = dict.fromkeys(f"{given(case.settings['duration'])} s" for case in content.cases.values())
    cases = f"{listed(list(content.cases))} under {listed(list(under))}, {' or '.join(seconds)}"
    sizes = [
        one.samples.sizes["sample"] for case in content.cases.values() for one in case.responses.values()
    ]
    few, many = min(sizes), max(sizes)
    samples = count_words(many, "sample") if few == many else f"{few} to {many} samples"
    used = [name for name in content.distributions if content.users(name)]
    kinds = dict.fromkeys(parameter_label(name).split(" of ")[0].split(",")[0] for name in used)
    if any("records" in content.motions[case.motion].attrs for case in content.cases.values()):
        kinds |= {"ground motion": None}
    uncertain = f"Uncertain: {listed(list(kinds))}." if kinds else ""
    return f"Asked: {cases}, by {_models(content.study['models'])}, {samples} each. {uncertain}".rstrip()


def _under(content, case):
    """Motion of a case with its scale and peak."""
    peak = f"{number(content.peak_acceleration(case))} m/s{SQUARED}"
    if count := content.motions[case.motion].attrs.get("records"):
        return f"{count_words(count, 'record')} of {case.motion} x {given(case.settings['scale'])} (median {peak})"
    return f"{case.motion} x {given(case.settings['scale'])} ({peak})"


def _verdict(found):
    """Which cases stand, which may collapse and which do, in a sentence."""
    sides = {"stand": [], "may": [], "fall": [], "open": []}
    for name, ended in found.items():
        shares, down = (
            [one.share for one in ended.values()],
            any(one.collapsed > one.falling for one in ended.values()),
        )
        side = "stand" if not any(shares) else "may" if min(shares) < 1.0 else "fall" if down else "open"
        sides[side].append(name)

    def named(names, verb):
        if len(names) == 1:
            return f"{names[0]} {verb}s"
        every = {2: "Both"}.get(len(names), f"All {len(names)}")
        return f"{f'{every} cases' if len(names) == len(found) else listed(names)} {verb}"

    def runs(names):
        count = sum(one.counted for name in names for one in found[name].values())
        models = dict.fromkeys(model for name in names for model in found[name])
        return f"{count_words(count, 'run')} by {_models(models)}"

    words = []
    if names := sides["stand"]:
        every = [one for name in names for one in found[name].values()]
        upper, fewest = max(one.limits[1] for one in every), min(one.counted for one in every)
        words.append(
            f"{named(names, 'stand')}: none of {runs(names)} collapses; as few as {count_words(fewest, 'run')} of a "
            f"case by a model leave a probability of a collapse of up to {_whole(upper)} %"
        )
    for name in sides["may"]:
        by = [
            f"{share_words(one.collapsed, one.counted)} runs by {model_label(model)}{_falling(one)}"
            for model, one in found[name].items()
            if one.collapsed
        ]
        others = "" if len(by) == len(found[name]) else ", in none by the others"
        words.append(f"{name} may collapse: in {listed(by)}{others}")
    if names := sides["fall"]:
        words.append(f"{named(names, 'collapse')}: so do all {runs(names)}")
    if names := sides["open"]:
        words.append(
            f"Whether {named(names, 'stand')} is not told: all {runs(names)} still fall as the window ends"
        )
    return ". ".join(words) + "."


def _models(models):
    """Names of one model or two, or how many there are: the table of the cases names them."""
    return listed([*map(model_label, models)]) if len(models) < MOST else f"{len(models)} models"


def _facts(content, found, shown):
    """The three numbers of the box: farthest block, least margin, collapses."""
    ended, under = found[shown.name], shown.name
    if any(one.collapsed for one in ended.values()):
        under += ", until a fall"
    far = max(ended.values(), key=lambda one: one.peak)
    near = min(ended.values(), key=lambda one: one.margin if np.isfinite(one.margin) else np.inf)
    marked, blocks = len(face_markers(shown.structure)), int((~shown.structure.driven).sum())
    every = {(name, model): one for name in found for model, one in found[name].items()}
    (worst, by), fell = max(every.items(), key=lambda item: item[1].share)
    of, where = f"{fell.collapsed} of {fell.counted}", f"{worst} by {model_label(by)}"
    if not fell.collapsed:
        fell = min(every.values(), key=lambda one: one.counted)
        of, where = f"none of {sum(one.counted for one in every.values())}", "in each case by each model"
    return (
        (
            "Farthest from its place on the slab",
            f"{_range(ended, 'peak', _length)} mm",
            f"{far.block}; {under}; medians{_ends(ended, 'peak')}; {share_words(marked, blocks)} blocks have markers",
        ),
        (
            "Least margin against overturning",
            f"{_range(ended, 'margin', _whole)} %" if near.over else MISSING,
            f"above {near.over}; {_by_leaf(ended)}{under}; medians{_ends(ended, 'margin')}; at rest 100 %, weight "
            "over the edge 0 %",
        ),
        ("Samples that collapse", of, f"{where}: probability {_limits(fell)}, 95 % limits{_falling(fell)}"),
    )


def _range(ended, name, show):
    return _from_to([value for one in ended.values() if np.isfinite(value := getattr(one, name))], show)


def _from_to(values, show):
    """Smallest and largest of some values, one where they print alike."""
    return " to ".join(dict.fromkeys(show(end) for end in (min(values), max(values))))


def _by_leaf(ended):
    """Margins of the leaves of a wall that has several, in words."""
    told = []
    for name in next(iter(ended.values())).leaves:
        ends = [one.leaves[name] for one in ended.values() if np.isfinite(one.leaves[name])]
        told += [f"{name} {_from_to(ends, _whole)} %"] if ends else []
    return f"{', '.join(told)}; " if 1 < len(told) <= MOST else ""


def _blows(found):
    """How often blocks that stand apart strike each other and how fast, a sentence a case, and what is not told."""
    said = []
    for name, ended in found.items():
        if not any(one.struck for one in ended.values()):
            continue
        words = [
            f"in {share_words(one.struck, one.counted)} samples by {model_label(model)}, at most "
            f"{count_words(one.blows, 'blow')} in one, the fastest at {one.blow:.2f} m/s ({one.pair})"
            for model, one in ended.items()
            if one.struck
        ]
        words += ["none by the others"] if len(words) < len(ended) else []
        said.append(f"{name}: {'; '.join(words)}.")
    if not said:
        apart = any(len(one.leaves) > 1 for ended in found.values() for one in ended.values())
        return ["None in any run that counts."] if apart else []
    said[MOST:] = []
    said[-1] += " The force of a blow is not told: it depends on how edges crush, which no model has."
    return said


def _ends(ended, name):
    """Models of the least and of the largest figure, where they differ."""
    known = {model: value for model, one in ended.items() if np.isfinite(value := getattr(one, name))}
    ends = [model_label(pick(known, key=known.get)) for pick in (min, max)] if len(known) > 1 else []
    return f" by {' to '.join(ends)}" if ends else ""


def _length(value):
    """A length [m] in mm, whole from 10 mm on."""
    return f"{1e3 * value:.0f}" if value >= 0.00995 else f"{1e3 * value:.1f}"


def _whole(share):
    return f"{100.0 * share:.0f}"


def _lines(content, found):
    """A row a case: what its blocks do by every model, and how sure that is."""
    models = [model for model in content.study["models"] if any(model in ended for ended in found.values())]
    under, rows = {name: _under(content, content.cases[name]) for name in found}, []
    for name, ended in found.items():
        blocks = {one.block for one in ended.values()}
        case = [name, *(blocks if len(blocks) == 1 else ())]
        case += [under[name]] if len(set(under.values())) > 1 else []
        rows.append((
            ", ".join(case),
            *(_done(ended[model], len(blocks) > 1) if model in ended else MISSING for model in models),
        ))  # fmt: skip
    return Table(
        "Every case and the block that moves farthest: its largest displacement along x from its place on the slab, "
        "median of the samples, smallest and largest in brackets, and what is left where it rests at the end; limits "
        "of 95 % of the probability of a collapse.",
        ("Case, block", *map(model_label, models)), tuple(rows), "l" * (len(models) + 1), (2.4, *[4] * len(models)),
    )  # fmt: skip


def _done(one, named):
    """Words on the block of an `Outcome`, with its name where it is ``named``."""
    sure = _limits(one)
    if one.collapsed:
        return f"{share_words(one.collapsed, one.counted)} samples collapse{_falling(one)}: {sure}"
    if one.most < STILL:
        return f"stands, unmoved; collapse {sure}"
    left = f", {_length(one.end)} left" if np.isfinite(one.end) else ""
    spread = f"{_length(one.least)} to {_length(one.most)}" if one.counted > 1 else "1 sample"
    block = f"{one.block} " if named else ""
    return f"stands; {block}{_length(one.peak)} mm ({spread}){left}; collapse {sure}"


def _limits(one):
    """Limits of the probability of a collapse, in words."""
    lower, upper = map(_whole, one.limits)
    return f"{lower} to {upper} %" if one.collapsed else f"below {upper} %"


def _falling(one):
    """Samples among the collapsed ones that were not down when the window ended, in words."""
    return f" ({one.falling} still falling)" if one.falling else ""


def _figure(content, found, shown):
    one = max(found[shown.name].values(), key=lambda ended: ended.peak)
    structures = {case.settings["structure"]: case.structure for case in content.cases.values()}
    curve = f"; dashed: {shown.curve_word}" if shown.measured is not None else ""
    return Figure(
        f"The structures, and {one.block} (red) of {shown.name}: displacement along x from its place on the slab, "
        f"medians of the samples, and bands from the smallest to the largest{curve}.",
        svg_of(plot_answer, list(structures.values()), shown, one.marker),
    )


def _why(content, found):
    """Why the models differ in the case in which they differ most, by what their runs did."""
    apart = [one for name in found for one in models_apart(content.cases[name], found[name])]
    if not apart:
        several = any(len(ended) > 1 for ended in found.values())
        return ["The models do not differ beyond the limits of their samples."] if several else []
    falls, _, name, *models = max(apart)
    case, (near, far) = content.cases[name], map(model_label, models)
    how = "collapses more often" if falls else "moves the blocks farther"
    words = [f"in {name} {far} {how} than {near}"]
    if impacts := shares_at_impacts(case, models):
        joint, (less, more, plastic) = impacts
        words.append(
            f"at {joint}, the joint that opens most, impacts keep {less:.2f} of the spin by {near} and {more:.2f} by "
            f"{far}; all above it, as one body struck at the other edge alone, keeps {plastic:.2f} (Housner)"
        )
        words.append(
            "impacts do not tell the models apart"
            if abs(more - less) < ALIKE
            else f"impacts explain a larger motion by {far}, which loses less"
            if more > less
            else f"impacts do not explain it: {far} loses more"
        )
    for figure, noun in (("joint_uplift", "opening"), ("joint_slip", "slip")):
        largest = [
            case.responses[model].envelope[figure].sel(quantile=0.5).dropna("joint") for model in models
        ]
        if all(values.size for values in largest):
            joints = [str(values["joint"].values[values.argmax("joint")]) for values in largest]
            sizes = [
                f"{_length(float(values.max()))} mm by {label}{f' ({joint})' * (joint != joints[-1])}"
                for values, label, joint in zip(largest, (near, far), joints, strict=True)
            ]
            words.append(
                f"the largest {noun}, median of the samples, is {' and '.join(sizes)} ({joints[-1]})"
            )
    return [" ".join(map(sentence_case, words))]


def _measured(content, found):
    """Measured peaks, and of which samples the measured curve may be one more: a sentence, or none."""
    said, words = [], {}
    for name, ended in found.items():
        case = content.cases[name]
        one = max(ended.values(), key=lambda end: end.peak)
        if case.measured is None or one.marker not in case.measured["marker"].values:
            continue
        peak = float(case.measured["peak"].sel(frame="slab", marker=one.marker))
        fits = {}
        for model in ended:
            comparison = case.responses[model].comparison
            chance = float(comparison["curve_probability"].sel(marker=one.marker))
            if np.isfinite(chance):
                fits[model_label(model)] = is_likely(chance, int(comparison.attrs["counted"]))
        like = [label for label, fit in fits.items() if fit]
        if len(fits) > 1 and len(like) in (0, len(fits)):
            like = [f"all {len(fits)} models"]
        word = "like" if any(fits.values()) else "unlike"
        words[case.curve_word] = None
        told = f", {word} {listed(like or [*fits])}" if fits else ""
        said.append(f"{name}, {one.block} moves by {_length(peak)} mm{told}")
    return [f"{sentence_case(' and '.join(words))[:-1]}: {'; '.join(said)}."] if said else []


def _synthetic(content):
    """Remark on curves and motions that nobody measured."""
    cases, words = content.cases.values(), []
    tests = [case.name for case in cases if case.synthetic]
    of = "" if len(tests) == len(cases) else f" of {', '.join(tests)}"
    motions = sorted({case.motion for case in cases if content.motions[case.motion].attrs.get("synthetic")})
    if motions:
        words.append(f"The ground motions are synthetic, not recorded: {', '.join(motions)}.")
    if tests:
        words.append(
            f"The measured curves{of} are SYNTHETIC: runs of this program seen through noisy markers, with an "
            "effect that the models may lack. They tell nothing about reality."
        )
    return [Text(" ".join(words), strong=True)] if words else []
