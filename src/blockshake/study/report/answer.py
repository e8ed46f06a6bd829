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
from blockshake.study.report.case_outcomes import (
    models_apart,
    most_telling,
    outcomes,
    shares_at_impacts,
)
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
        Box(_verdict(content, found), _facts(content, found, shown)),
        *_synthetic(content),
        _figure(content, found, shown),
        _lines(content, found),
    ]
    compared = _measured(content, found)
    said = [*_why(content, found), *compared]
    said += [
        f"Half of the samples of {name} fall below {number(float(one['median']), 2)} times its motion (fragility)."
        for name, one in content.fragility.items()
        if np.isfinite(one["median"])
    ]
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
    cases = "; ".join(
        f"{listed(names)} under {listed(motions)}" for names, motions in _grouped(content, content.cases)
    )
    seconds = dict.fromkeys(f"{given(case.settings['duration'])} s" for case in content.cases.values())
    cases += f", {' or '.join(seconds)}"
    labels = [model_label(model) for model in content.study["models"]]
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
    return f"Asked: {cases}, by {listed(labels)}, {samples} each. {uncertain}".rstrip()


def _grouped(content, names):
    """Structures of some cases with their motions, those of the same motions together: pairs of lists of words."""
    motions, alike = {}, {}
    for case in map(content.cases.get, names):
        motions.setdefault(case.structure.file.name, []).append(_under(content, case))
    for structure, under in motions.items():
        alike.setdefault(tuple(under), []).append(structure)
    return [(structures, list(under)) for under, structures in alike.items()]


def _under(content, case):
    """Motion of a case with its scale and peak."""
    peak = f"{number(content.peak_acceleration(case))} m/s{SQUARED}"
    if count := content.motions[case.motion].attrs.get("records"):
        return f"{count_words(count, 'record')} of {case.motion} x {given(case.settings['scale'])} (median {peak})"
    return f"{case.motion} x {given(case.settings['scale'])} ({peak})"


def _verdict(content, found):
    """Which cases stand, which may collapse and which do, in a sentence."""
    sides = {"stand": [], "may": [], "fall": []}
    for name, ended in found.items():
        shares = [one.share for one in ended.values()]
        sides["stand" if not any(shares) else "fall" if min(shares) == 1.0 else "may"].append(name)

    def named(names, verb):
        groups = _grouped(content, names)
        return "; ".join(
            f"{listed(structures)} {verb}{'s' if len(structures) == 1 and verb != 'may collapse' else ''} under "
            f"{listed(motions)}"
            for structures, motions in groups
        )

    def runs(names):
        return sum(one.counted for name in names for one in found[name].values())

    words = []
    if names := sides["stand"]:
        every = [one for name in names for one in found[name].values()]
        upper, fewest = max(one.limits[1] for one in every), min(one.counted for one in every)
        words.append(
            f"{named(names, 'stand')}: none of {count_words(runs(names), 'run')} by {_by(found, names)} collapses; "
            f"from {count_words(fewest, 'run')} of a case by a model, a collapse may still be as likely as "
            f"{_whole(upper)} % (limit of 95 %)"
        )
    for name in sides["may"]:
        by = [
            f"{share_words(one.collapsed, one.counted)} by {model_label(model)}"
            for model, one in found[name].items()
            if one.collapsed
        ]
        others = "" if len(by) == len(found[name]) else ", and none by the others"
        words.append(f"{named([name], 'may collapse')}: of the runs, {listed(by)} do{others}")
    if names := sides["fall"]:
        words.append(f"{named(names, 'collapse')}: so do all {runs(names)} runs by {_by(found, names)}")
    return ". ".join(words) + "."


def _by(found, names):
    """Models of cases in words."""
    models = list(dict.fromkeys(model for name in names for model in found[name]))
    return (
        model_label(models[0])
        if len(models) == 1
        else "both models"
        if len(models) == 2
        else f"{len(models)} models"
    )


def _facts(content, found, shown):
    """The three numbers of the box: farthest block, least margin, collapses."""
    ended, under = (
        found[shown.name],
        f"{shown.name}, until a fall"
        if any(one.collapsed for one in found[shown.name].values())
        else shown.name,
    )
    far = max(ended.values(), key=lambda one: one.peak)
    near = min(ended.values(), key=lambda one: one.margin if np.isfinite(one.margin) else np.inf)
    marked, blocks = len(face_markers(shown.structure)), int((~shown.structure.driven).sum())
    every = [(name, model) for name in found for model in found[name]]
    worst, by = max(every, key=lambda one: found[one[0]][one[1]].share)
    fell = found[worst][by]
    if fell.collapsed:
        of, where = f"{fell.collapsed} of {fell.counted}", f"{worst} by {model_label(by)}"
    else:
        fell = min((found[name][model] for name, model in every), key=lambda one: one.counted)
        of = f"none of {sum(found[name][model].counted for name, model in every)}"
        where = "in each case by each model"
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
        (
            "Samples that collapse",
            of,
            f"{where}: probability {_limits(fell)}, 95 % limits{_falling(fell)}",
        ),
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
            if one.struck
            else f"none by {model_label(model)}"
            for model, one in ended.items()
        ]
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
    rows = [
        (
            f"{name}: {_under(content, content.cases[name])}",
            *(_done(ended[model]) if model in ended else MISSING for model in models),
        )
        for name, ended in found.items()
    ]
    return Table(
        "Verdict of every case. Moves by: largest displacement along x from its place on the slab, of the block that "
        "moves farthest; median of the samples, smallest and largest in brackets. Collapse: limits of 95 % of its "
        "probability.",
        ("Case", *map(model_label, models)), tuple(rows), "l" * (len(models) + 1), (3, *[4] * len(models)),
    )  # fmt: skip


def _done(one):
    sure = _limits(one)
    if one.collapsed:
        return f"{share_words(one.collapsed, one.counted)} samples collapse{_falling(one)}: {sure}"
    if one.most < STILL:
        return f"stands, unmoved; collapse {sure}"
    left = f", {_length(one.end)} mm left" if np.isfinite(one.end) else ", still moving at the end"
    spread = f"{_length(one.least)} to {_length(one.most)}" if one.counted > 1 else "1 sample"
    return f"stands; {one.block} moves by {_length(one.peak)} mm ({spread}){left}; collapse {sure}"


def _limits(one):
    """Limits of the probability of a collapse, in words."""
    lower, upper = map(_whole, one.limits)
    return f"{lower} to {upper} %" if one.collapsed else f"below {upper} %"


def _falling(one):
    """Samples among the collapsed ones that were not down when the window ended, in words."""
    return f" ({one.falling} of them still fall as the window ends)" if one.falling else ""


def _figure(content, found, shown):
    one = max(found[shown.name].values(), key=lambda ended: ended.peak)
    structures = {case.settings["structure"]: case.structure for case in content.cases.values()}
    curve = f"; dashed: {shown.curve_word}" if shown.measured is not None else ""
    return Figure(
        f"Left: {listed([structure.file.name for structure in structures.values()])}. Right: {one.block} (red) under "
        f"{_under(content, shown)}, displacement along x from its place on the slab: medians of the samples, and bands "
        f"from the smallest to the largest{curve}.",
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
    words = [f"under {name} {far} {how} than {near}"]
    if impacts := shares_at_impacts(case, models):
        joint, (less, more, plastic) = impacts
        words.append(
            f"at {joint}, the joint that opens most, impacts keep {less:.2f} of the spin by {near} and {more:.2f} by "
            f"{far}; all above it, turning as one and struck at the other edge alone, keeps {plastic:.2f} (Housner)"
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
            sizes = [
                f"{_length(float(values.max()))} mm by {label} ({values['joint'].values[values.to_numpy().argmax()]})"
                for values, label in zip(largest, (near, far), strict=True)
            ]
            words.append(f"the largest {noun} is {' and '.join(sizes)}")
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
        fits = {True: [], False: []}
        for model in ended:
            comparison = case.responses[model].comparison
            chance = float(comparison["curve_probability"].sel(marker=one.marker))
            if np.isfinite(chance):
                fits[is_likely(chance, int(comparison.attrs["counted"]))].append(model_label(model))
        like = [f"{word} {listed(fits[at])}" for word, at in (("like", True), ("unlike", False)) if fits[at]]
        words[case.curve_word] = None
        said.append(f"{name}, {one.block} moves by {', '.join([f'{_length(peak)} mm', *like])}")
    return [f"{sentence_case(' and '.join(words))[:-1]}: {'; '.join(said)}."] if said else []


def _synthetic(content):
    """Remark on curves and motions that nobody measured."""
    cases, words = content.cases.values(), []
    tests = [case.name for case in cases if case.synthetic]
    motions = sorted({case.motion for case in cases if content.motions[case.motion].attrs.get("synthetic")})
    if motions:
        words.append(f"The ground motions are synthetic, not recorded: {', '.join(motions)}.")
    if tests:
        words.append(
            f"The measured curves of {', '.join(tests)} are SYNTHETIC: runs of a solver of this program seen through "
            "noisy markers, with an effect that the models may lack. They tell nothing about reality."
        )
    return [Text(" ".join(words), strong=True)] if words else []
