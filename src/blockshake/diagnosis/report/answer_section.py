"""First section of a diagnosis: the answer in its box, and the forces that it rests on."""

import numpy as np

from blockshake.diagnosis.gain.section import drift_figure
from blockshake.diagnosis.report.size_section import meaning_words
from blockshake.diagnosis.report.statement import (
    changed,
    not_distinguished,
    sensor_faults,
    statement,
    until_then,
)
from blockshake.diagnosis.wording import NO_ERROR, chance_words, estimate_words, name_of, percent_words
from blockshake.effects.registry import EFFECTS, title_of
from blockshake.pages.blocks import Box, Figure, Items, Section, Table, Text
from blockshake.pages.drawing import BLACK, BLUE, LIGHT_GREY, new_figure, svg_of
from blockshake.pages.units import printed
from blockshake.pages.wording import listed, sentence_case
from blockshake.pages.words import Words

_ANSWER = Words(__name__)
_OF_SLAB = {"rotation of the slab": "turn", "vertical motion of the slab": "lift"}
_ABOUT = 0.5  # s, of a blow, that are drawn before and after it
_MOST_TESTS, _MOST_BODIES = 5, 2
_FEWEST_INSTANTS = 10  # instants of a test that is drawn
_GAP = 0.05  # s, between instants of one curve
_SPREADS = 2.0  # standard deviations of the sensors, to either side
_TO_KILO = 1e-3
_FITTING = 99.5  # percent of all instants that an axis has room for
_MARGIN = 1.15
_ALIKE = 0.98  # of two curves' product over their lengths, from which they are one but for a factor
_POINTS = {"color": BLACK, "linestyle": "none", "marker": "o", "markeredgewidth": 0.0}
_EXPLAINED = {"color": BLUE, "linewidth": 1.0, "marker": "o", "markersize": 1.2}
_SIZES = 1.3, 3.0  # of points, smallest and largest
_MANY = 200  # points, from which on they are small


def answer_section(diagnosed):
    """The answer in two sentences, its numbers, what to do next and until then; the forces measured and explained."""
    verdict, sentences = diagnosed.verdict, [*not_distinguished(diagnosed), *changed(diagnosed)]
    blocks = [Box(statement(diagnosed), _facts(diagnosed)), *map(Text, sentences)]
    if diagnosed.synthetic:
        blocks.append(Text(_ANSWER.synthetic(), strong=True))
    items = [_ANSWER.missing(verdict.missing)] if verdict.missing else []
    if verdict.next_test and not verdict.next_tests:
        items.append(_ANSWER.decides(verdict.next_test))
    blocks += [Items(tuple(items))] if items else []
    blocks += [Text(until_then(diagnosed)), *next_tests_table(verdict), *_figures(diagnosed)]
    return Section("Answer", "answer", tuple(blocks))


def _facts(diagnosed):
    """The three numbers of the box: chance without a cause, size, skill score, each with its label and a note."""
    chance = chance_words(diagnosed.verdict.misfit.p)
    seen = "Chance of such readings without a cause", chance, "upper bound, over all that was tried"
    return seen, _size_fact(diagnosed), _gain_fact(diagnosed)


def _size_fact(diagnosed):
    """Size of the most probable cause, or of a sensor's fault; without any how many effects have a limit everywhere."""
    decision, known = diagnosed.decision, diagnosed.verdict.parameters
    causes = [(one.name, one.title, one.parameters) for one in (part.causes[0] for part in decision.parts)]
    causes += [(name, title_of(name), known.get(name, {})) for name in sensor_faults(diagnosed)]
    for effect, title, parameters in causes:
        for name, estimate in parameters.items():
            of_effect = EFFECTS[effect].parameters if effect in EFFECTS else ()
            meanings = {one.name: meaning_words(one) for one in of_effect}
            label = sentence_case(meanings.get(name, f"{name}, {title}"))[:-1]
            return label, estimate_words(name, estimate), "90 % interval"
    count = f"{len(decision.excluded_above)} of {len(decision.probabilities)}"
    return "Effects excluded from some size on", count, "wherever they act; sizes in the table of limits"


def _gain_fact(diagnosed):
    """Skill score on the responses, or on a sensor's readings; that on forces alone is no prediction."""
    label, verdict = "Error on sealed tests that the cause removes", diagnosed.verdict
    gain, forces = verdict.gain, verdict.row_gain and percent_words(verdict.row_gain.recalibrated)
    if gain is None and forces:
        return label, "not simulated", _ANSWER.gain("forces", "", "", forces, diagnosed.effort == "quick")
    if gain is None:
        reasons = [one for one in verdict.caveats if "gain was measured" in one]
        return label, "not measured", (reasons or ["nothing acts that could explain any"])[0]
    removed, of_nominal = map(percent_words, (gain.recalibrated, gain.nominal))
    of = "responses" if diagnosed.decision.parts else "sensors"
    within, nothing = removed == NO_ERROR, gain.recalibrated.lower <= 0.0
    note = _ANSWER.gain(
        of, of_nominal if within else "", removed if nothing and not within else "", forces, False
    )
    return label, "none shown" if nothing and not within else removed, note


def next_tests_table(verdict):
    """Table of the measurements that would split the sets; an empty list without any."""
    rows = [
        (
            sentence_case(one.test)[:-1], listed([name_of(name) for name in one.between], "or"),
            f"{100.0 * one.share:.0f} %",
        )
        for one in verdict.next_tests
    ]  # fmt: skip
    head = ("Measurement", "Between", "Separates")
    return [Table(_ANSWER.next_tests(), head, tuple(rows), "llr", (0.4, 0.45, 0.15))] if rows else []


def _figures(diagnosed):
    """Figures of the sealed tests before and after, of forces on blocks, and of the motion of the slab."""
    parts = diagnosed.decision.parts
    moves = [part for part in parts if part.readings in _OF_SLAB]
    joints = [part.causes[0] for part in parts if part not in moves]
    drift = drift_figure(diagnosed)
    return [
        *([drift] if drift else []),
        *([_forces(diagnosed, joints)] if joints or not moves else []),
        *(_slab(diagnosed, part) for part in moves),
    ]


def _forces(diagnosed, causes):
    """Measured and explained forces; without any a sentence."""
    shown, when = diagnosed.departures, [one.when for one in causes]
    bodies = shown_bodies(shown, [one.place.get("body") for one in causes])
    if not bodies:
        return Text(_ANSWER.still())
    blows = {test: one["time"] for own in when for test, one in own.get("blows", {}).items()}
    if blows:
        at = np.array([blows.get(test, np.inf) for test in shown["test"].values.tolist()])
        shown = shown.isel(instant=np.flatnonzero(np.abs(shown["time"].to_numpy() - at) <= _ABOUT))
    tests = shown_tests(shown)
    left_out = [name for name in diagnosed.decision.tests if name not in tests]
    titles = " and ".join(one.title for one in causes if shown["explained"].any())
    words = _ANSWER.forces(bodies, diagnosed.measured_word, titles, _ABOUT if blows else 0, left_out)
    return Figure(words, svg_of(plot_forces, shown, tests, bodies, titles, diagnosed.measured_word))


def _slab(diagnosed, part):
    name, title = _OF_SLAB[part.readings], part.causes[0].title
    words = _ANSWER.slab(part.readings, diagnosed.measured_word, title, name == "lift")
    return Figure(words, svg_of(plot_slab, diagnosed.departures, name, title, diagnosed.measured_word))


def shown_tests(departures):
    """Names of the tests of `departures` with the largest forces, by name."""
    names, counts = np.unique(departures["test"], return_counts=True)
    names = [str(name) for name in names[counts >= min(_FEWEST_INSTANTS, counts.max())]]
    square = [float((_of(departures, name)["measured"] ** 2).sum()) for name in names]
    chosen = np.sort(np.argsort(square)[::-1][:_MOST_TESTS])
    return [names[index] for index in chosen]


def shown_bodies(departures, first):
    """Names of the bodies whose forces are known best, ``first`` ones before all others.

    Of bodies whose forces are the same but for a factor, as where one joint turns, the first alone.
    """
    sure = np.nan_to_num((departures["measured"] / departures["deviation"]).to_numpy())
    length = np.linalg.norm(sure, axis=0)
    names = departures["body"].values.tolist()
    ranked = sorted(
        np.flatnonzero(length > 0.0), key=lambda index: (names[index] not in first, -length[index])
    )
    chosen = []
    for index in ranked:
        alike = (abs(sure[:, index] @ sure[:, other]) / (length[index] * length[other]) for other in chosen)
        if not any(product > _ALIKE for product in alike):
            chosen.append(index)
    return [names[index] for index in chosen[:_MOST_BODIES]]


def plot_forces(departures, tests, bodies, explained, measured_word):
    """Figure of forces [kN] over time, a row a body, a column a test; ``explained``: titles of the causes, or empty."""
    figure, panels = _panels(tests, len(bodies))
    for row, body in zip(panels, bodies, strict=True):
        for axes, test in zip(row, tests, strict=True):
            forces = _with_gaps(_of(departures, test).sel(body=body))
            noise = _SPREADS * forces["deviation"]
            axes.fill_between(
                forces["time"], -noise, noise, color=LIGHT_GREY, linewidth=0.0, label="noise of the sensors"
            )
            _draw_points(axes, forces["time"], forces["measured"], measured_word)
            if explained:
                axes.plot(forces["time"], forces["explained"], **_EXPLAINED, label=explained)
        _limit(
            row,
            *(_TO_KILO * departures[name].sel(body=body).to_numpy() for name in ("measured", "explained")),
        )
        row[0].set_ylabel(f"{body}\nforce [kN]")
    return _finished(figure, panels)


def plot_slab(departures, name, explained, measured_word):
    """Figure of the ``turn`` or ``lift`` of the slab over time, a column a test."""
    of_test = departures["slab_test"].to_numpy()
    tests = list(dict.fromkeys(of_test))[:_MOST_TESTS]
    figure, (row,) = _panels(tests, 1)
    factor, unit = printed(departures[name].attrs["units"])
    for axes, test in zip(row, tests, strict=True):
        readings = departures.isel(reading=np.flatnonzero(of_test == test))
        _draw_points(axes, readings["slab_time"], factor * readings[name], measured_word)
        axes.plot(
            readings["slab_time"],
            factor * readings[f"{name}_explained"],
            color=BLUE,
            linewidth=0.9,
            label=explained,
        )
    _limit(row, *(factor * departures[curve].to_numpy() for curve in (name, f"{name}_explained")))
    row[0].set_ylabel(f"{'rotation' if name == 'turn' else 'displacement'} [{unit}]")
    return _finished(figure, [row])


def _panels(tests, rows):
    """Empty figure with a column a test."""
    figure = new_figure(0.017 + (0.032 if rows == 1 else 0.024 * rows))
    panels = figure.subplots(rows, len(tests), sharex="col", sharey="row", squeeze=False)
    for axes, test in zip(panels[0], tests, strict=True):
        axes.set_title(test)
    return figure, panels


def _draw_points(axes, time, values, label):
    size = float(np.clip(_MANY / len(time), *_SIZES))
    axes.plot(time, values, **_POINTS, markersize=size, label=label)


def _limit(row, measured, explained):
    """Room for all that is explained, and for nearly all that was measured."""
    end = _MARGIN * max(np.nanpercentile(np.abs(measured), _FITTING), np.nanmax(np.abs(explained)))
    row[0].set_ylim(-end, end)
    for axes in row:
        axes.axhline(0.0, color=BLACK, linewidth=0.6)


def _finished(figure, panels):
    """The figure with its axes of time, and a legend."""
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    figure.align_ylabels([row[0] for row in panels])
    handles = panels[0][0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside upper center", ncols=len(handles[0]), markerscale=2.0)
    return figure


def _of(departures, test):
    return departures.isel(instant=np.flatnonzero(departures["test"].to_numpy() == test))


def _with_gaps(shown):
    """Forces in kN by name, NaN between instants that are far apart, so that no line is drawn there."""
    time = shown["time"].to_numpy()
    gaps = np.flatnonzero(np.diff(time) > _GAP) + 1
    names = ("measured", "deviation", "explained")
    forces = {name: np.insert(_TO_KILO * shown[name].to_numpy(), gaps, np.nan) for name in names}
    return {"time": np.insert(time, gaps, time[gaps - 1]), **forces}
