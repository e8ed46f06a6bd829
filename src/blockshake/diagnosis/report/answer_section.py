"""First section of a diagnosis: the answer in its box, and the forces that it rests on."""

import numpy as np

from blockshake.diagnosis.report.statement import changed, not_told, statement, until_then
from blockshake.diagnosis.wording import NO_ERROR, chance_words, estimate_words, name_of, percent_words
from blockshake.pages.blocks import Box, Figure, Items, Section, Table, Text
from blockshake.pages.drawing import BLACK, BLUE, LIGHT_GREY, new_figure, svg_of
from blockshake.pages.units import printed
from blockshake.pages.wording import listed, sentence_case

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
    """The answer in two sentences, what holds it back, and the forces measured and explained."""
    sentences = [*not_told(diagnosed), *changed(diagnosed)]
    blocks = [Box(statement(diagnosed), _facts(diagnosed)), *map(Text, sentences)]
    if diagnosed.synthetic:
        blocks.append(
            Text(
                "The tests are SYNTHETIC: virtual tests, computed and seen through made-up sensors. Nothing was "
                "measured; 'measured' below means read off the virtual test.",
                strong=True,
            )
        )
    items = _items(diagnosed)
    now = Text(until_then(diagnosed))
    further = [*([Items(items)] if items else []), *next_tests_table(diagnosed.verdict), now]
    return Section("Answer", "answer", (*blocks, *further, *_figures(diagnosed)))


def _facts(diagnosed):
    """The three numbers of the box: chance without a cause, size, gain, each with its label and a note."""
    chance = chance_words(diagnosed.verdict.misfit.p)
    seen = "Chance of such readings without a cause", chance, "upper bound, over all that was tried"
    return seen, _size_fact(diagnosed.decision), _gain_fact(diagnosed.verdict)


def _size_fact(decision):
    for first in (part.causes[0] for part in decision.parts):
        for name, estimate in first.parameters.items():
            return f"{name} of {first.title}", estimate_words(name, estimate), "90 % interval"
    count = str(len(decision.excluded_above))
    return "Effects excluded from some size on", count, "wherever they act; sizes in the table of limits"


def _gain_fact(verdict):
    """Gain on the responses, or where these were not measured on forces; a gain that may be nothing is none."""
    label, gain = "Error on sealed tests that the cause removes", verdict.gain or verdict.row_gain
    if gain is None:
        reasons = [one for one in verdict.caveats if "gain was measured" in one]
        return label, "not measured", (reasons or ["nothing acts that could explain any"])[0]
    of = "responses" if verdict.gain else "forces alone"
    removed, of_nominal = map(percent_words, (gain.recalibrated, gain.nominal))
    words = f"on {of}, of the recalibrated model's error; 90 % interval"
    if removed == NO_ERROR:
        words = f"the recalibrated model's error on {of} is within the noise; of the nominal model's: {of_nominal}"
    elif gain.recalibrated.lower <= 0.0:
        removed, words = "none shown", f"{words}: {removed}"
    if verdict.gain and verdict.row_gain:
        words += f"; on forces {percent_words(verdict.row_gain.recalibrated)}"
    return label, removed, words


def _items(diagnosed):
    verdict, items = diagnosed.verdict, []
    if verdict.missing:
        items.append(f"Not called established because {'; '.join(verdict.missing)}.")
    if verdict.next_test and not verdict.next_tests:
        items.append(f"Measurement that would decide: {verdict.next_test}.")
    return tuple(items)


def next_tests_table(verdict):
    """Table of the measurements that would split the sets; an empty list without any."""
    rows = [
        (
            sentence_case(one.test)[:-1],
            listed([name_of(name) for name in one.between], "or"),
            f"{100.0 * one.share:.0f} %",
        )
        for one in verdict.next_tests
    ]
    words = (
        "Measurements that would split what the tests do not tell apart, and the share of such cases in which they "
        "are expected to leave the true cause alone: from the odds, the sizes and the forces of these tests."
    )
    return (
        [Table(words, ("Measurement", "Between", "Splits"), tuple(rows), "llr", (0.4, 0.45, 0.15))]
        if rows
        else []
    )


def _figures(diagnosed):
    """Figures of measured and explained forces on blocks and motion of the slab."""
    parts = diagnosed.decision.parts
    moves = [part for part in parts if part.readings in _OF_SLAB]
    joints = [part.causes[0] for part in parts if part not in moves]
    return [
        *([_forces(diagnosed, joints)] if joints or not moves else []),
        *(_slab(diagnosed, part) for part in moves),
    ]


def _forces(diagnosed, causes):
    """Measured and explained forces; without any a sentence."""
    shown, when = diagnosed.departures, [one.when for one in causes]
    bodies = shown_bodies(shown, [one.place.get("body") for one in causes])
    if not bodies:
        return Text(
            "No joint turned, slipped or lifted in any test, so that no force can be read off the motion."
        )
    blows = {test: one["time"] for own in when for test, one in own.get("blows", {}).items()}
    if blows:
        at = np.array([blows.get(test, np.inf) for test in shown["test"].values.tolist()])
        shown = shown.isel(instant=np.flatnonzero(np.abs(shown["time"].to_numpy() - at) <= _ABOUT))
    tests = shown_tests(shown)
    left_out = [name for name in diagnosed.decision.tests if name not in tests]
    titles = " and ".join(one.title for one in causes if shown["explained"].any())
    words = (
        "Forces that undamaged blocks do not make, where a joint turns, slips or lifts: the horizontal force that "
        f"would have to act at the middle of {' or of '.join(bodies)}, if all of it acted there. Black: "
        f"{diagnosed.measured_word}. {f'Blue: {titles} at the most probable size. ' if titles else ''}Without a cause "
        "there is none: the line at 0. Grey: two standard deviations of the sensors' noise."
        + (f" Drawn is what lies within {_ABOUT:g} s of a blow." if blows else "")
        + (f" Not drawn: {', '.join(left_out)}." if left_out else "")
    )
    return Figure(words, svg_of(plot_forces, shown, tests, bodies, titles, diagnosed.measured_word))


def _slab(diagnosed, part):
    name, title = _OF_SLAB[part.readings], part.causes[0].title
    share = ", as far as it follows the horizontal motion" if name == "lift" else ""
    words = (
        f"{sentence_case(part.readings)[:-1]}, from rest. Black: {diagnosed.measured_word}. Blue: {title} at the "
        f"most probable size{share}. An undamaged table makes none: the line at 0."
    )
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
