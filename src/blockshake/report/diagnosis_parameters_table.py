"""What the open tests tell of the nominal model's own parameters."""

import numpy as np

from blockshake.report.blocks import Table
from blockshake.report.wording import model_label, number, printed_unit
from blockshake.study.distributions import parameter_unit

# unit of what is no parameter of a design
_OTHERS = {
    "amplitude": "1",
    "restitution": "1",
    "ls_dem.node_spacing": "m",
    "ls_dem.perimeter_inset": "m",
    "nscd.shrink": "1",
}


def nominal_parameters(gain):
    """Parameters of the recalibrated rival before and after the open tests, by solver.

    Parameters
    ----------
    gain : xarray.Dataset
        From `campaign_gain`.

    Returns
    -------
    Table
    """
    rows, unmoved = [], []
    for model in gain["model"].values:
        own = gain.sel(model=model)
        for name in own["parameter"].values[np.isfinite(own["skill"])]:
            one = own.sel(parameter=name)
            if not one["informed"]:
                unmoved.append(f"{name} ({model_label(model)})")
                continue
            divisor, unit = printed_unit(_OTHERS.get(name) or parameter_unit(name))
            rows.append(
                (
                    str(name),
                    model_label(model),
                    unit,
                    _words(one["prior"] / divisor),
                    _words(one["posterior"] / divisor),
                    number(one["narrowing"], 2),
                )
            )
    rest = (
        f" Not informed by the data, so that they keep their prior: {', '.join(unmoved)}." if unmoved else ""
    )
    return Table(
        "Parameters of the nominal model that the open tests inform, recalibrated without the cause: median with the "
        "interval of 90 %, before and after, and the standard deviation after over that before. A parameter is "
        f"informed if left-out draws are predicted better than in 99 of 100 shufflings.{rest}",
        ("Parameter", "Solver", "Unit", "Before", "After", "After / before"),
        tuple(rows),
        "lllrrr",
    )


def _words(quantiles):
    lower, median, upper = quantiles.to_numpy()
    return f"{number(median)} ({number(lower)} to {number(upper)})"
