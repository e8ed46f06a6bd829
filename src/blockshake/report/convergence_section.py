"""The report's annex on LS-DEM's numerical parameters: what they change, as a figure and as numbers."""

from blockshake.report.blocks import Figure, Section, Table, Text
from blockshake.report.convergence_figure import plot_convergence
from blockshake.report.drawing import PAGE_WIDTH, svg_of
from blockshake.report.wording import given, model_label, number
from blockshake.study.convergence_table import EXACT

# observable: head of its column, factor from SI, how it is printed
_COLUMNS = {
    "sink": ("Sink [\N{MICRO SIGN}m]", 1e6, ".2f"),
    "swing_time": ("Swing time [ms]", 1e3, ".2f"),
    "impact_ratio": ("Impact ratio [1]", 1.0, ".4f"),
    "peak_drift": ("Peak drift [mm]", 1e3, ".2f"),
    "peak_rotation": ("Peak rotation [mrad]", 1e3, ".2f"),
    "upright_time": ("Upright again [ms]", 1e3, ".1f"),
    "end_drift": ("End drift [mm]", 1e3, ".1f"),
    "energy_residual": ("Energy residual [1]", 1.0, ".1e"),
}
_PARAMETERS = {
    "time_step": ("time step", 1e6, "\N{MICRO SIGN}s"),
    "node_spacing": ("node spacing", 1e3, "mm"),
    "perimeter_inset": ("inset", 1e3, "mm"),
    "grid_spacing": ("grid spacing", 1e3, "mm"),
}


def convergence(content):
    """Figure and table of the convergence study; None where the study has none."""
    if content.convergence is None:
        return None
    table, settings = content.convergence, content.study["convergence"]
    used = content.study["models"].get("ls-dem", {}).get("time_step")
    blocks = [
        Text(
            f"{settings['structure']} under one cycle of sine, and its lowest block alone, which rocks freely after a "
            "kick, both by LS-DEM with one numerical parameter varied at a time. Sink: of the highest block in the "
            "equilibrium at the start. Swing time: from the kick until the block is upright again. Impact ratio: "
            "angular velocity after its first impact over that before. Drift: displacement of the highest block's "
            "mass centre relative to the slab; it is read at its peak, when it is zero again after that, and at the "
            "end of the window. Rotation: of the lowest block. A residual drift is not read: the stack rocks on for "
            "longer than its motion can be predicted."
        ),
        Text(
            "How to read it: dotted lines are the floor, the difference that a ground acceleration and a kick larger "
            "by one part in a million make. Rocking multiplies small differences: what lies near its floor, or does "
            "not fall as the setting gets finer, is this sensitivity and no error of the parameter, and no slope is to "
            "be read from it. In the time step the scheme is of second order while contacts last, as the energy "
            "residual shows; a joint that opens within a step, and dashpots that set in at the first step after a "
            "touch, shift the swing time by about a step and scatter the impact. Node spacing and inset do not "
            "converge as a time step does: the nodes are where an impact acts, and the inset is where the blocks "
            "pivot. They belong to the uncertainty of the model. A level set on a grid as coarse as the chamfer rounds "
            "the edges off."
            + (
                f" The study's runs were made at a time step of {given(1e6 * used)} \N{MICRO SIGN}s."
                if used
                else ""
            )
        ),
        Figure(
            f"{model_label('ls-dem')}: size of the difference from the finest setting, and the energy residual itself, "
            "against the numerical parameters. Dotted: the floor of each curve, in its colour. Grey: the default; that "
            "of the distance is the exact one. The drift at the end is divided by the peak drift. What agrees to eight "
            "digits is not drawn, such as the sink at every time step. Peak drift and peak rotation lie on each other "
            "where the stack leans as one.",
            svg_of(plot_convergence, table),
            PAGE_WIDTH,
        ),
        _numbers(table),
    ]
    return Section(f"Annex: numerical parameters of {model_label('ls-dem')}", "convergence", tuple(blocks))


def _numbers(table):
    rows = []
    for (parameter, setting), group in table.groupby(["parameter", "setting"], sort=False):
        word, factor, unit = _PARAMETERS[parameter]
        shown = "exact" if setting == EXACT else f"{factor * setting:g} {unit}"
        rows.append((word, shown + (" *" if group["usual"].all() else ""), *_row(group, "value")))
    rows.append(("floor", "", *_row(group, "floor")))
    return Table(
        "Values behind the figure; inset: of the perimeter. * default. Last row: the floor.",
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
    return f"{value:{form}}" if value == value else number(value)
