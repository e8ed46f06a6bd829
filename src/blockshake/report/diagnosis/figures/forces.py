"""Forces on blocks that sound blocks do not make, measured and explained, test by test."""

import numpy as np

from blockshake.report.document.drawing import BLACK, BLUE, GREY, new_figure

_MOST_TESTS, _MOST_BODIES = 5, 3
_GAP = 0.05  # s, between instants of one curve
_SPREADS = 2.0  # standard deviations of the sensors, to either side
_KILO = 1e-3
_FITTING = 99.5  # percent of all instants that an axis has room for
_MARGIN = 1.15


def shown_tests(departures):
    """Names of the tests of `departures` with the largest forces, in the order of the file."""
    names = list(dict.fromkeys(departures["test"].values.tolist()))
    square = [float((_of(departures, name)["measured"] ** 2).sum()) for name in names]
    chosen = np.sort(np.argsort(square)[::-1][:_MOST_TESTS])
    return [names[place] for place in chosen]


def shown_bodies(departures, first):
    """Names of the bodies whose forces are told best, ``first`` ones before all others."""
    sure = ((departures["measured"] / departures["deviation"]) ** 2).sum("instant").to_numpy()
    ranked = [str(departures["body"].values[place]) for place in np.argsort(-sure, kind="stable") if sure[place] > 0.0]
    return [name for name in dict.fromkeys([*first, *ranked]) if name in ranked][:_MOST_BODIES]


def plot_forces(departures, tests, bodies, causes, measured_word):
    """Figure of forces [kN] over time, a row a body, a column a test; ``causes``: those that explain, by title."""
    figure = new_figure(0.017 + 0.033 * len(bodies))
    panels = figure.subplots(len(bodies), len(tests), sharex="col", sharey="row", squeeze=False)
    for row, body in zip(panels, bodies, strict=True):
        for axes, test in zip(row, tests, strict=True):
            one = _with_gaps(_of(departures, test).sel(body=body))
            noise = _SPREADS * one["deviation"]
            axes.fill_between(one["time"], -noise, noise, color=GREY, linewidth=0.0, label="noise of the sensors")
            axes.plot(one["time"], one["measured"], color=BLACK, linewidth=0.7, label=measured_word)
            if causes:
                axes.plot(one["time"], one["explained"], color=BLUE, linewidth=0.9, label=" and ".join(causes))
        reach = np.abs(departures[["measured", "explained"]].sel(body=body).to_array().to_numpy())
        end = _MARGIN * _KILO * float(np.nanpercentile(reach, _FITTING))
        row[0].set_ylim(-end, end)
        row[0].set_ylabel(f"{body}\nforce [kN]")
    for axes, test in zip(panels[0], tests, strict=True):
        axes.set_title(test)
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    figure.align_ylabels(panels[:, 0])
    handles = panels[0, 0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside upper center", ncols=len(handles[0]))
    return figure


def _of(departures, test):
    return departures.isel(instant=np.flatnonzero(departures["test"].to_numpy() == test))


def _with_gaps(one):
    """Forces in kN by name, NaN between instants that are far apart, so that no line is drawn there."""
    time = one["time"].to_numpy()
    gaps = np.flatnonzero(np.diff(time) > _GAP) + 1
    found = {name: np.insert(_KILO * one[name].to_numpy(), gaps, np.nan) for name in one.data_vars}
    return {"time": np.insert(time, gaps, time[gaps - 1]), **found}
