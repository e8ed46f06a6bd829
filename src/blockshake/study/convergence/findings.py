"""Findings of a convergence study: observed orders, and errors at the default settings beside the floor."""

from typing import NamedTuple

import numpy as np

from blockshake.study.convergence.table import EXACT

SENSITIVE = 2.0  # floors; a difference that is smaller is held to be sensitivity


class Departure(NamedTuple):
    """Observable that the default of a numerical parameter moves farthest from that at the finest setting.

    Attributes
    ----------
    parameter, observable : str
    setting : float
        Default of the parameter [SI].
    share : float
        Difference over the scale of the observable [1], see `value_scales`.
    beyond_floor : int
        Observables that differ by more than `SENSITIVE` floors.
    compared : int
        Observables with a known difference.
    """

    parameter: str
    observable: str
    setting: float
    share: float
    beyond_floor: int
    compared: int


def value_scales(table):
    """Scales that differences of `study_convergence` are divided by, by observable.

    Magnitude at the smallest time step; for the drift at the end that of the peak drift, since the former passes zero;
    1 for the energy residual, which is a share itself.
    """
    finest = (
        table[table["parameter"] == "time_step"]
        .drop_duplicates("observable")
        .set_index("observable")["value"]
    )
    scales = finest.abs().to_dict()
    return scales | {"end_drift": scales["peak_drift"], "energy_residual": 1.0}


def observed_order(table, parameter, observable):
    """Observed order [1] of a value of `study_convergence` that vanishes with a parameter: a slope in logarithms.

    By least squares; NaN where fewer than two settings have a value other than zero.
    """
    rows = table[(table["parameter"] == parameter) & (table["observable"] == observable)]
    setting, value = rows["setting"].to_numpy(), np.abs(rows["value"].to_numpy())
    used = (setting != EXACT) & np.isfinite(value) & (value > 0.0)
    if used.sum() < 2:
        return np.nan
    return float(np.polyfit(np.log(setting[used]), np.log(value[used]), 1)[0])


def default_departures(table):
    """List of `Departure`, the largest of the default settings from the finest, by parameter of `study_convergence`.

    Parameters whose default is the finest setting, or was not run, are left out.
    """
    scales, found = value_scales(table), []
    for parameter, group in table.groupby("parameter", sort=False):
        rows = group[group["usual"] & (group["setting"] != group["setting"].iloc[0])]
        rows = rows[np.isfinite(rows["difference"])]
        if not len(rows):
            continue
        difference = rows["difference"].abs()
        share = difference / rows["observable"].map(scales)
        place = int(np.argmax(share.to_numpy()))
        beyond = int((difference > SENSITIVE * rows["floor"]).sum())
        found.append(
            Departure(
                str(parameter), str(rows["observable"].iloc[place]), float(rows["setting"].iloc[0]),
                float(share.iloc[place]), beyond, len(rows),
            )
        )  # fmt: skip
    return found


def floor_shares(table):
    """Floor of each observable over its scale [1], by observable."""
    scales = value_scales(table)
    floors = table.drop_duplicates("observable").set_index("observable")["floor"]
    return {str(name): float(floor / scales[name]) for name, floor in floors.items()}
