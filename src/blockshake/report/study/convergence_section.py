"""Annex on the numerical parameters of LS-DEM: their influence as a figure, in words and as numbers."""

import numpy as np

from blockshake.report.document.blocks import Figure, Items, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.units import MICROMETRES, MICROSECONDS
from blockshake.report.document.wording import given, model_label, number, percent, share_words
from blockshake.report.study.figures.convergence import PARAMETERS, plot_convergence
from blockshake.study.convergence.convergence import NUDGE
from blockshake.study.convergence.findings import SENSITIVE, default_departures, floor_shares, observed_order
from blockshake.study.convergence.table import EXACT

# observable: head of its column, factor from SI, format of its number
_COLUMNS = {
    "sink": (f"Sink [{MICROMETRES.name}]", MICROMETRES.factor, ".2f"),
    "swing_time": ("Swing time [ms]", 1e3, ".2f"),
    "impact_ratio": ("Impact ratio [1]", 1.0, ".4f"),
    "peak_drift": ("Peak drift [mm]", 1e3, ".2f"),
    "peak_rotation": ("Peak rotation [mrad]", 1e3, ".2f"),
    "upright_time": ("Upright again [ms]", 1e3, ".1f"),
    "end_drift": ("End drift [mm]", 1e3, ".1f"),
    "energy_residual": ("Energy residual [1]", 1.0, ".1e"),
}


def convergence(content):
    """Figure and table of the convergence study; None where the study has none."""
    if content.convergence is None:
        return None
    table, settings = content.convergence, content.study["convergence"]
    blocks = [
        Text(
            f"{settings['structure']} under one cycle of sine, and its lowest block alone, which rocks freely after a "
            "kick, both by LS-DEM with one numerical parameter varied at a time. Sink: of the highest block in the "
            "equilibrium at the start. Swing time: from the kick until the block is upright again. Impact ratio: "
            "angular velocity after the first impact over that before. Drift: displacement of the mass centre of the "
            "highest block relative to the slab, read at its peak, at its next zero and at the end of the window. "
            "Rotation: of the lowest block. The floor is the difference that a ground acceleration and a kick larger "
            f"by {NUDGE:g} make. A difference near the floor is sensitivity of the motion and no error of the "
            "parameter."
        ),
        Items(tuple(_findings(content, table))),
        Figure(
            f"{model_label('ls-dem')}: magnitude of the difference from the finest setting, and the energy residual "
            "itself, against the numerical parameters. Dotted: the floor of each curve, in its colour. Grey: the "
            "default; that of the distance is the exact one. The drift at the end is divided by the peak drift. "
            "Differences below one part in 1e8 are not drawn.",
            svg_of(plot_convergence, table),
        ),
        numbers_table(table),
    ]
    return Section(f"Annex: numerical parameters of {model_label('ls-dem')}", "convergence", tuple(blocks))


def _findings(content, table):
    """Sentences on the floor, the order in time and the default settings."""
    shares = {name: share for name, share in floor_shares(table).items() if np.isfinite(share)}
    if shares:
        largest = max(shares, key=shares.get)
        yield f"The floor is largest for the {_word(largest)}: {number(100.0 * shares[largest], 2)} % of its scale."
    order = observed_order(table, "time_step", "energy_residual")
    if np.isfinite(order):
        yield f"The energy residual goes with the time step to the power {order:.1f} (least squares in logarithms)."
    for one in default_departures(table):
        name, unit = PARAMETERS[one.parameter]
        yield (
            f"The default {name} of {given(unit.factor * one.setting)} {unit.name} differs from the finest setting by "
            f"more than {given(SENSITIVE)} floors in {share_words(one.beyond_floor, one.compared)} observables, most "
            f"in the {_word(one.observable)}: {percent(one.share)} %."
        )
    used = content.study["models"].get("ls-dem", {}).get("time_step")
    if used:
        yield f"The runs of this study have a time step of {given(MICROSECONDS.factor * used)} {MICROSECONDS.name}."


def _word(observable):
    return _COLUMNS[observable][0].partition(" [")[0].lower()


def numbers_table(table):
    """Values of every setting, and the floor."""
    rows = []
    for (parameter, setting), group in table.groupby(["parameter", "setting"], sort=False):
        word, unit = PARAMETERS[parameter]
        shown = "exact" if setting == EXACT else f"{unit.factor * setting:g} {unit.name}"
        rows.append((word, shown + (" *" if group["usual"].all() else ""), *_row(group, "value")))
    rows.append(("floor", "", *_row(group, "floor")))
    return Table(
        "Values behind the figure. * default. Last row: the floor.",
        ("Parameter", "Setting", *(head for head, _, _ in _COLUMNS.values())),
        tuple(rows),
        "lr" + "r" * len(_COLUMNS),
    )


def _row(group, column):
    values = group.set_index("observable")[column]
    return tuple(
        number(factor * values[name], 2) if column == "floor" else _printed(factor * values[name], form)
        for name, (_, factor, form) in _COLUMNS.items()
    )


def _printed(value, form):
    return f"{value:{form}}" if np.isfinite(value) else number(value)
