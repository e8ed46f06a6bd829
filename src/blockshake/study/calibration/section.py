"""Section on the calibration of friction, restitution and contact stiffness by all open tests."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.pages.blocks import Figure, Items, Section, Table, Text
from blockshake.pages.drawing import BLACK, BLUE, LIGHT_GREY, ORANGE, RED, new_figure, svg_of
from blockshake.pages.wording import (
    MISSING,
    count_words,
    given,
    listed,
    model_label,
    number,
    parameter_label,
    share_words,
)
from blockshake.study.calibration.answers import LEVEL
from blockshake.study.calibration.calibration import ALL, models_of

_UNLIKE = 0.05  # chance of a test, below which no sample resembles it
_NOT_CONSTRAINED = "unknown"
_PANELS_ABREAST = 3
_ROW = 0.052  # m of paper
_COLORS = (BLUE, ORANGE)
_THICK, _THIN = 1.8, 0.8


def calibration(content):
    """Answers of all open tests on friction, restitution and stiffness; None where the study asks for none."""
    found = content.calibration
    if found is None:
        return None
    tests = content.study["calibration"].get("tests")
    which = f"The open tests {listed(tests)} of the cases" if tests else "All open tests of the cases"
    text = (
        f"{which}, each simulated with {found['size']} samples of the measured motion. "
        f"{_drawn(found['parameters'])} The samples near a value are scored by the continuous ranked probability score "
        "of two readings: the markers' displacement relative to the slab, and the spectrum of the blocks' "
        "accelerations. "
        "A parameter is constrained where the scores of its values differ by more than those of shuffled samples, at "
        f"{100 * LEVEL:.0f} % over all parameters and models together. The range holds every value whose score exceeds "
        "the lowest by no more than the score of the true value does where samples stand for the tests, in "
        f"{100 * LEVEL:.0f} % of them."
    )
    synthetic = [one for one in found["tests"] if one["synthetic"]]
    sentences = [answer_words(name, one) for name, one in found["parameters"].items()]
    if synthetic:
        count = len({(one["case"], one["test"]) for one in synthetic})
        sentences.append(
            f"{count_words(count, 'test')} of {len({(one['case'], one['test']) for one in found['tests']})} are "
            "synthetic: the answers on these tell of the program that made them, not of concrete."
        )
    if found["left_out"]:
        sentences.append(f"Left out, as too many samples have no reading: {'; '.join(found['left_out'])}.")
    blocks = [Text(text), Items(tuple(sentences))]
    if not found["parameters"]:
        return Section("Calibration by all open tests", "calibration", tuple(blocks))
    blocks += [
        Figure(
            "Scores of values, mean over the tests, above the lowest of the same line. Grey: values that all tests "
            "together do not refuse, where they tell of the parameter at all. Dotted: the value that the study takes.",
            svg_of(plot_calibration, found),
        ),
        answers_table(found),
        tests_table(found),
    ]
    return Section("Calibration by all open tests", "calibration", tuple(blocks))


def _drawn(parameters):
    """Parameters that are drawn, in sentences; one friction of concrete alone is the search of the paper."""
    named = "; ".join(map(parameter_label, parameters)) or "none"
    words = f"Calibrated, with values drawn evenly over a range: {named}. Other variables are drawn as in the study."
    if list(parameters) == ["friction.concrete.concrete"]:
        words += (
            " This is the search of Zhou et al. (2023) for the mean friction whose envelope holds the tests."
        )
    return words


def answer_words(name, one):
    """Answer of all tests on one parameter against the value that the study takes, as a sentence."""
    answer, assumed = one["answers"][ALL], given(one["assumed"])
    if not answer["told"]:
        return f"{parameter_label(name)}: the tests tell nothing about it; {assumed} is neither borne out nor refused."
    verdict = "is refused" if answer["assumed_is_refused"] else "lies in that range"
    found = f"{span(answer)}, best {number(answer['best'], 2)}"
    return f"{parameter_label(name)}: {found}; {assumed}, which the study takes, {verdict}."


def span(answer):
    """Range of an answer in words."""
    lower, upper = answer["lower"], answer["upper"]
    if not answer["told"]:
        return _NOT_CONSTRAINED
    if lower is None and upper is None:
        return "no value is refused"
    if upper is None:
        return f"above {number(lower, 2)}"
    if lower is None:
        return f"below {number(upper, 2)}"
    return f"between {number(lower, 2)} and {number(upper, 2)}"


def answers_table(found):
    """Table of the answers of all open tests, by model and together."""
    models = models_of(found)
    groups = [*models, ALL]

    def cell(one, group):
        answer = one["answers"].get(group)
        return f"{span(answer)} (p {number(answer['chance'], 2)})" if answer else "in none of its tests"

    rows = tuple(
        (
            parameter_label(name),
            f"{given(one['lowest'])} to {given(one['highest'])}",
            given(one["assumed"]),
            *(cell(one, group) for group in groups),
        )
        for name, one in found["parameters"].items()
    )
    header = ("Parameter", "Range", "Study", *map(model_label, models), "All")
    return Table(
        "Answers of all open tests by model and together. p: chance that scores differ as much where no test depends "
        "on any parameter. The factor of contact stiffness is over that of the wave speed. Restitution, stiffness and "
        "flatness belong to the contact springs of LS-DEM.",
        header, rows, "lrr" + "l" * len(groups), (0.22, 0.12, 0.08, *(0.58 / len(groups) for _ in groups)),
    )  # fmt: skip


def tests_table(found):
    """Table of the answers of each test by each model."""
    by_test = {}
    for one in found["tests"]:
        by_test.setdefault((one["case"], one["test"], one["model"]), {})[one["reading"]] = one
    readings = list(dict.fromkeys(one["reading"] for one in found["tests"]))
    rows = []
    for (case, test, model), read in by_test.items():
        chances = (number(read[one]["chance"], 2) if one in read else MISSING for one in readings)
        constrained = [
            f"{one['reading']}: {parameter_label(name)}, {span(answer)}"
            for one in read.values()
            for name, answer in one["answers"].items()
            if answer["told"]
        ]
        rows.append((case, test, model_label(model), *chances, "; ".join(constrained) or "nothing by itself"))
    unlike = sum(one["chance"] < _UNLIKE for one in found["tests"])
    unsolved = sum(next(iter(read.values()))["unsolved"] for read in by_test.values())
    tail = (
        f" {count_words(unsolved, 'run')} ended for a numerical reason and count nowhere." if unsolved else ""
    )
    return Table(
        "Every test by itself. Chance, by the two readings: rank of the test's distance from the samples among those "
        f"of the samples from each other; {share_words(unlike, len(found['tests']))} are below {_UNLIKE:g}, readings "
        f"that no sample resembles. Tells: at the level of all tests together.{tail}",
        ("Case", "Test", "Model", *(f"Chance, {one}" for one in readings), "Tells"),
        tuple(rows), "lll" + "r" * len(readings) + "l",
        (0.17, 0.16, 0.12, *(0.24 / len(readings) for _ in readings), 0.31),
    )  # fmt: skip


def plot_calibration(found):
    """Figure of the scores of `calibrate` above the lowest of each line; in grey the range that all tests leave."""
    parameters, models = found["parameters"], models_of(found)
    columns = min(len(parameters), _PANELS_ABREAST)
    rows = -(-len(parameters) // columns)
    figure = new_figure(rows * _ROW + 0.008)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    lines = {ALL: BLACK} | dict(zip(models, _COLORS, strict=False))
    for axes, (name, one) in zip(panels, parameters.items(), strict=False):
        _draw_scores(axes, one, lines)
        axes.set(title=parameter_label(name), xlabel="value [1]", ylabel="score above the lowest [1]")
        axes.title.set_fontsize(6.5)
    for axes in panels[len(parameters) :]:
        axes.set_axis_off()
    entries = {model_label(model): Line2D([], [], color=lines[model]) for model in models}
    entries["all tests"] = Line2D([], [], color=BLACK, linewidth=_THICK)
    entries["range, where constrained"] = Patch(facecolor=LIGHT_GREY, edgecolor="none")
    entries["the study's value"] = Line2D([], [], color=RED, linestyle=":")
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=len(entries))
    return figure


def _draw_scores(axes, one, lines):
    values = np.array(one["values"])
    axes.set(xscale=one["scale"], xlim=(values[0], values[-1]))
    whole = one["answers"][ALL]
    if whole["told"]:
        ends = (whole["lower"] or one["lowest"], whole["upper"] or one["highest"])
        axes.axvspan(*ends, color=LIGHT_GREY, linewidth=0.0)
    for group, color in lines.items():
        if group in one["answers"]:
            score = np.array(one["answers"][group]["score"])
            width = _THICK if group == ALL else _THIN
            axes.plot(values, score - score.min(), color=color, linewidth=width)
    axes.axvline(np.clip(one["assumed"], *values[[0, -1]]), color=RED, linestyle=":", linewidth=1.0)
    axes.set_ylim(bottom=0.0)
