"""Table of the parameters of the nominal model that the open tests inform."""

import numpy as np

from blockshake.report.document.blocks import Table
from blockshake.report.document.units import printed
from blockshake.report.document.wording import model_label, number
from blockshake.simulation.models import MODELS
from blockshake.study.sampling.distributions import parameter_unit

# units of the parameters that no design holds
_OTHERS = {"amplitude": "1", "restitution": "1"} | {
    name: unit for model in MODELS.values() for name, (_, unit, *_) in model.numerical_parameters().items()
}


def nominal_parameters(gain):
    """`Table` of the recalibrated rival's parameters before and after the open tests, from `campaign_gain`."""
    rows, unmoved = [], []
    for model in gain["model"].values:
        own = gain.sel(model=model)
        for name in own["parameter"].values[np.isfinite(own["skill"])]:
            one = own.sel(parameter=name)
            if not one["informed"]:
                unmoved.append(f"{name} ({model_label(model)})")
                continue
            factor, unit = printed(_OTHERS.get(name) or parameter_unit(name))
            rows.append((
                str(name), model_label(model), unit, _words(factor * one["prior"]), _words(factor * one["posterior"]),
                number(one["narrowing"], 2),
            ))  # fmt: skip
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
