"""Readings that the laws of the joints and of the table rest on, and how far each law departs."""

import numpy as np

from blockshake.report.diagnosis.figures.forces import COLOURS, DASHED, KILO, coloured
from blockshake.report.document.drawing import BLACK, DARK_GREY, LIGHT_GREY, RED, new_figure

_BEYOND = 1.6  # half widths, at the ends of the axis of levers
_SLIP_RATES = 0.01, 1.0  # m/s, ends of the axis
_MOST_POINTS = 1500
_POINTS = {"linestyle": "none", "marker": ".", "markersize": 1.5}
_MARKERS = ("o", "s", "^", "v", "D", "P", "X", "*")
_LINEAR = 7.0  # standard deviations, below which the axis of departures is linear
_TICKS = (-1000, -100, -20, -7, -3, 0, 3, 7, 20, 100, 1000)


def plot_laws(forces):
    """Figure of the readings that the laws of the joints rest on, in every test of `measured_forces`.

    Lever against rotation while a joint is turned, with the edges of the lowest face; shear over normal force against
    the slip rate while a joint slips, with the coefficient of friction, if one slips in any test; rotation against
    moment while it is closed, with the line of least squares.
    """
    tests, joints = [str(name) for name in forces["test"].values], coloured(forces["joint"].values)
    draw = {"lever": _lever, "friction": _friction, "closed": _closed}
    shown = [name for name in draw if name != "friction" or slips(forces)]
    figure = new_figure(0.02 + 0.042 * len(tests))
    panels = figure.subplots(len(tests), len(shown), sharex="col", squeeze=False)
    for row, test in zip(panels, tests, strict=True):
        for axes, law in zip(row, shown, strict=True):
            for joint, colour in joints:
                one = forces.sel(test=test, joint=joint)
                told = one.isel(time=one["told"].sel(law=law).to_numpy() == 1)
                draw[law](axes, told, {"color": colour, "label": joint, **_POINTS})
            if not forces["told"].sel(test=test, law=law).any():
                axes.text(0.5, 0.5, "none", transform=axes.transAxes, ha="center", color=DARK_GREY)
            _frame(axes, law, forces)
        row[0].set_ylabel(f"{test}\nlever [mm]")
        row[-1].set_ylabel("rotation [mrad]")
        if len(shown) > 2:
            row[1].set_ylabel("shear / normal [1]")
    words = {"lever": "rotation [mrad]", "friction": "slip rate [m/s]", "closed": "moment [kN m]"}
    for axes, law in zip(panels[-1], shown, strict=True):
        axes.set_xlabel(words[law])
    figure.align_ylabels(panels)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(joints), markerscale=4)
    return figure


def slips(forces):
    """Whether any joint slips in any test."""
    return bool(forces["told"].sel(law="friction").any())


def _lever(axes, one, look):
    axes.plot(1e3 * one["rotation"], 1e3 * one["lever"], **look)


def _friction(axes, one, look):
    axes.plot(np.abs(one["slip_rate"]), np.abs(one["shear"] / one["normal"]), **look)


def _closed(axes, one, look):
    moment, turn = (KILO * one["lever"] * one["normal"]).to_numpy(), 1e3 * one["rotation"].to_numpy()
    axes.plot(moment, turn, **look)
    if len(moment) > 2 and np.ptp(moment) > 0.0:
        line = np.polynomial.Polynomial.fit(moment, turn, 1)
        ends = np.array([moment.min(), moment.max()])
        axes.plot(ends, line(ends), color=look["color"], linewidth=0.9)


def _frame(axes, law, forces):
    """Ends of the axes, and the lines that the law of the lowest joint draws."""
    half, coefficient = (float(forces[name].isel(joint=0).max()) for name in ("half_width", "coefficient"))
    levels = {"lever": (-1e3 * half, 1e3 * half), "friction": (coefficient,), "closed": ()}[law]
    for level in levels:
        axes.axhline(level, **DASHED)
    if law == "lever":
        axes.set_ylim(-1e3 * _BEYOND * half, 1e3 * _BEYOND * half)
    if law == "friction":
        axes.set_xscale("log")
        axes.set(xlim=_SLIP_RATES, ylim=(0.0, 1.5 * coefficient))


def plot_table(forces):
    """Figure of the table's rotation against its acceleration and against the moment on it, a row a test.

    Each less what the other explains, by one regression: the slopes of the laws ``table.pitch`` and
    ``table.compliance``.
    """
    tests = [str(name) for name in forces["test"].values]
    figure = new_figure(0.014 + 0.036 * len(tests))
    panels = figure.subplots(len(tests), 2, sharex="col", squeeze=False)
    for row, test in zip(panels, tests, strict=True):
        one = forces.sel(test=test)
        turn = 1e3 * one["table_rotation"].to_numpy()
        causes = np.column_stack([one["table_acceleration"], KILO * one["table_moment"]])
        told = np.flatnonzero(np.isfinite(turn) & np.isfinite(causes).all(axis=1))
        if len(told) > 3:
            _added_variables(row, turn[told], causes[told])
        row[0].set_ylabel(f"{test}\nrotation [mrad]")
    panels[-1, 0].set_xlabel("table's acceleration [m/s\N{SUPERSCRIPT TWO}]")
    panels[-1, 1].set_xlabel("moment on the table [kN m]")
    figure.align_ylabels(panels)
    return figure


def _added_variables(row, turn, causes):
    """Rotation by each of two causes, less what the other one and the mean explain."""
    design = np.column_stack([causes, np.ones(len(turn))])
    slope = np.linalg.lstsq(design, turn, rcond=None)[0]
    every = max(1, len(turn) // _MOST_POINTS)
    for place, axes in enumerate(row):
        others = slope.copy()
        others[place] = 0.0
        left, cause = turn - design @ others, causes[:, place]
        axes.plot(cause[::every], left[::every], color=COLOURS[0], **_POINTS)
        ends = np.array([cause.min(), cause.max()])
        axes.plot(ends, slope[place] * ends, color=BLACK, linewidth=0.9)


def plot_departures(laws, tests):
    """Figure of how far each law, a `LawFinding`, departs from the nominal model, a marker a test; broken ones in red.

    The longer line: the departure of all tests together.
    """
    figure = new_figure(0.02 + 0.0048 * len(laws))
    axes = figure.subplots()
    places = np.arange(len(laws))[::-1]
    axes.axvspan(-3.0, 3.0, color=LIGHT_GREY, linewidth=0.0, label="within 3 standard deviations")
    axes.axvline(0.0, color=BLACK, linewidth=0.6)
    for test, marker in zip(tests, np.resize(_MARKERS, len(tests)), strict=True):
        told = [
            (one.departures[test], place)
            for one, place in zip(laws, places, strict=True)
            if test in one.departures
        ]
        if told:
            axes.plot(
                *np.array(told).T, str(marker), color=COLOURS[0], markersize=4.0, label=test, alpha=0.85
            )
    axes.plot(
        [one.together for one in laws],
        places,
        "|",
        color=BLACK,
        markersize=9.0,
        markeredgewidth=1.4,
        label="together",
    )
    axes.set_xscale("symlog", linthresh=_LINEAR)
    low, high = axes.get_xlim()
    low, high = min(low, -_LINEAR) * 1.2, max(high, _LINEAR) * 1.2
    axes.set_xlim(low, high)
    ticks = [tick for tick in _TICKS if low <= tick <= high]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    axes.set_yticks(places, [one.name for one in laws])
    for label, one in zip(axes.get_yticklabels(), laws, strict=True):
        if one.broken:
            label.set(color=RED, fontweight="bold")
    axes.set_ylim(-0.7, len(laws) - 0.3)
    axes.set_xlabel(
        f"departure from the nominal model [standard deviations], linear within {_LINEAR:.0f}, logarithmic beyond"
    )
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure
