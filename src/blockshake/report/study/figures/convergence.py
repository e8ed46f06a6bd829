"""How LS-DEM's answers change with its numerical parameters: one column a parameter, one row a kind of answer."""

import numpy as np
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from blockshake.report.document.drawing import BLACK, BLUE, GREEN, LIGHT_GREY, ORANGE, RED, new_figure
from blockshake.report.document.units import MICROSECONDS, printed
from blockshake.study.convergence.findings import value_scales
from blockshake.study.convergence.table import EXACT

_ROUNDING = 1e-8  # relative; what is below it is the same number
PARAMETERS = {
    "time_step": ("time step", MICROSECONDS),
    "node_spacing": ("node spacing", printed("m")),
    "perimeter_inset": ("perimeter inset", printed("1")),
    "grid_spacing": ("grid spacing", printed("m")),
}
"""Numerical parameters in the order of the columns: name in words and printed unit."""
_ROWS = {
    "at rest, and one block\ndifference over value [1]": {
        "sink": (BLACK, "s", "sink"),
        "swing_time": (BLUE, "o", "swing time"),
        "impact_ratio": (RED, "^", "impact ratio"),
    },
    "stack under a sine\ndifference over value [1]": {
        "peak_drift": (BLACK, "D", "peak drift"),
        "peak_rotation": (ORANGE, "v", "peak rotation"),
        "upright_time": (GREEN, "P", "upright again"),
        "end_drift": (RED, "X", "drift at the end"),
    },
    "stack under a sine\nenergy residual [1]": {"energy_residual": (BLUE, "o", "energy residual")},
}


def plot_convergence(table):
    """Figure of a `study_convergence`: differences to the finest setting by parameter, and the energy residual."""
    figure = new_figure(0.15)
    panels = figure.subplots(len(_ROWS), len(PARAMETERS), sharex="col", sharey="row")
    scales = value_scales(table)
    for row, (label, observables) in zip(panels, _ROWS.items(), strict=True):
        for axes, parameter in zip(row, PARAMETERS, strict=True):
            for name, style in observables.items():
                _draw(axes, table, parameter, name, scales[name], style)
        row[0].set_ylabel(label)
        row[-1].legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), borderaxespad=0.0, handlelength=1.2)
    for axes, (parameter, (word, unit)) in zip(panels[-1], PARAMETERS.items(), strict=True):
        _mark_settings(axes, table, parameter, unit.factor)
        axes.set_xlabel(f"{word} [{unit.name}]")
    for axes, parameter in zip(panels[0], PARAMETERS, strict=True):
        axes.set_title(_against(table, parameter))
    for axes in panels.flat:
        _shade_default(axes, table, axes.get_subplotspec().colspan.start)
    return figure


def _draw(axes, table, parameter, name, scale, style):
    color, marker, label = style
    rows = table[
        (table["parameter"] == parameter) & (table["observable"] == name) & (table["setting"] != EXACT)
    ]
    itself = name == "energy_residual"
    sizes = np.abs(rows["value" if itself else "difference"]) / scale
    shown = sizes > _ROUNDING
    axes.loglog(
        PARAMETERS[parameter][1].factor * rows["setting"][shown], sizes[shown], color=color, marker=marker,
        markersize=3.5, label=label,
    )  # fmt: skip
    floor = rows["floor"].iloc[0] / scale
    if not itself and floor > _ROUNDING:
        axes.axhline(floor, color=color, linewidth=0.6, linestyle=(0, (1, 2)))


def _mark_settings(axes, table, parameter, factor):
    """A tick at every setting, with its number."""
    settings = np.unique(table["setting"][table["parameter"] == parameter])
    settings = factor * settings[settings != EXACT]
    axes.xaxis.set_major_locator(FixedLocator(settings))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xticklabels([f"{setting:g}" for setting in settings])
    reach = (settings[-1] / settings[0]) ** 0.08 if len(settings) > 1 else 1.5
    axes.set_xlim(settings[0] / reach, settings[-1] * reach)


def _shade_default(axes, table, column):
    """A grey band behind the default, where it is one of the settings drawn."""
    parameter, (_, unit) = list(PARAMETERS.items())[column]
    usual = table["setting"][(table["parameter"] == parameter) & table["usual"] & (table["setting"] != EXACT)]
    for setting in unit.factor * np.unique(usual):
        axes.axvspan(setting / 1.08, setting * 1.08, color=LIGHT_GREY, zorder=0, linewidth=0.0)


def _against(table, parameter):
    """The finest setting, which the differences of a column are taken from."""
    _, unit = PARAMETERS[parameter]
    finest = table["setting"][table["parameter"] == parameter].min()
    return "finest: exact distance" if finest == EXACT else f"finest: {unit.factor * finest:g} {unit.name}"
