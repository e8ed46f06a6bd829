"""Section on the contact stiffness: waves, their speed, and the stiffness of every sample."""

import numpy as np

from blockshake.pages.blocks import Figure, Section, Text
from blockshake.pages.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, RED, new_figure, svg_of
from blockshake.pages.units import MICROMETRES, printed, quantity
from blockshake.pages.wording import given, number, parameter_label
from blockshake.study.sampling.distributions import parameter_unit

_LINES = (BLUE, GREEN, ORANGE, RED, BLACK, GREY)
_STEP = {"normal": "vertical step: normal stiffness", "shear": "horizontal step: shear stiffness"}


def stiffness(content):
    """Waves, their speed, and the stiffness of every sample, for each kind of blocks; None where the study has none."""
    if not content.calibrated:
        return None
    waves = content.calibrated[0].waves
    blocks = [
        Text(
            "The contact stiffness of LS-DEM follows for every sample from the speed of waves in a tower of "
            f"{waves.sizes['block']} of the structure's blocks, matched to that of the material of the sample (Zhou et "
            f"al. 2023, Eqs. 7 and 8). Definition: {waves.attrs['definition']}."
        )
    ]
    for calibrated in content.calibrated:
        of = f"; {', '.join(calibrated.cases)}" if len(content.calibrated) > 1 else ""
        blocks += [
            Figure(
                "Displacement of the blocks of the tower after a step of velocity of "
                f"{given(1e3 * calibrated.waves.attrs['step_velocity'])} mm/s at its base, nominal parameters{of}; "
                "dots: arrivals.",
                svg_of(plot_waves, calibrated.waves),
            ),
            Text(f"{_speeds(calibrated.waves)} {_stiffness_of_samples(calibrated.stiffness, of)}"),
        ]
    blocks.append(
        Text("The stiffness by other definitions of arrival and dampings: docs/guide/uncertainty.md.")
    )
    return Section("Contact stiffness", "stiffness", tuple(blocks))


def _speeds(waves):
    """Stiffness at nominal parameters, and the wave speed that it gives against its target, in a sentence."""
    words = [
        f"{direction} {quantity(float(one['stiffness']), 'N/m3', 4)}, which gives {number(one['wave_speed'], 5)} of "
        f"{number(one['target_wave_speed'], 5)} m/s"
        for direction in waves["direction"].values
        for one in [waves.sel(direction=direction)]
    ]
    return f"Stiffness at nominal parameters: {'; '.join(words)}."


def _stiffness_of_samples(stiffness, of):
    """Smallest, mean and largest stiffness of the samples, in a sentence."""
    values = []
    for name, column in stiffness.items():
        factor, unit = printed(parameter_unit(name))
        low, mean, high = (number(factor * value) for value in (column.min(), column.mean(), column.max()))
        values.append(f"{parameter_label(name)} {low} to {high} {unit}, mean {mean}")
    return f"Stiffness per area of the {len(stiffness)} samples{of}: {'; '.join(values)}."


def plot_waves(waves):
    """Displacement of a tower's blocks after a step of velocity, with the arrivals; the paper's Fig. 9."""
    figure = new_figure(0.075)
    panels = figure.subplots(1, waves.sizes["direction"], squeeze=False)[0]
    for axes, direction in zip(panels, waves["direction"].values, strict=True):
        test = waves.sel(direction=direction).dropna("time", how="all", subset=["displacement"])
        for block, color in zip(waves["block"].values, _LINES, strict=False):
            one = test.sel(block=block)
            history, arrival = MICROMETRES.factor * one["displacement"], float(one["arrival"])
            axes.plot(1e3 * one["time"], history, color=color, label=str(block))
            axes.plot(
                1e3 * arrival, np.interp(arrival, one["time"], history), "o", color=color, markersize=3.5
            )
        axes.set(title=_STEP[str(direction)], xlabel="time [ms]", xlim=(0.0, 1e3 * float(test["time"][-1])))
    panels[0].set_ylabel(f"displacement [{MICROMETRES.name}]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(handles))
    return figure
