"""One run over time: drift of its blocks, forces and uplift of its joints, energy and the audit's residual."""

import textwrap
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.figure import Figure

from blockshake.dynamics.system import ENERGY_TERMS
from blockshake.files import AnyPath, check_output
from blockshake.pages.drawing import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT_GREY,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    check_picture,
    drawn,
    new_figure,
    save_picture,
)
from blockshake.pages.wording import MICRO, given, model_label, number
from blockshake.simulation.load_run import RunSource, load_run
from blockshake.simulation.run_histories import run_histories

_ROW, _MAP_ROW, _TITLE = 0.031, 0.042, 0.018  # m of paper
_TITLE_LETTERS = 105
_COLORS = (BLUE, ORANGE, GREEN, RED, SKY, PURPLE, BLACK)
_MOST_NAMES = 12  # next to a map
_EITHER_SIGN, _ONE_SIGN = "PuOr_r", "cividis"
_SIDEWAYS = 0.1  # of the largest drift along x, from which on a drift along y has a panel
# a normal force that peaks at so many times this quantile, in impacts, is shown up to so many times it
_MOSTLY, _PEAK, _HEADROOM = 0.99, 3.0, 1.5
_MILLI, _KILO = 1e3, 1e-3


class _Panel(NamedTuple):
    """A quantity over time: ``values(time)``, or ``values(time, kind)`` of lines that have names.

    ``limits``: of the values, or none to take them from the values; ``line``: a value to be marked, or none.
    """

    label: str
    values: xr.DataArray
    limits: tuple | None = None
    line: float | None = None

    @property
    def kind(self):
        return next((name for name in self.values.dims if name != "time"), None)

    @property
    def is_map(self):
        """Too many lines to tell apart."""
        return self.kind is not None and self.values.sizes[self.kind] > len(_COLORS)


def plot(run: RunSource, output: AnyPath | None = None, meshes: AnyPath | None = None) -> Figure:
    """Draw a run: one panel a quantity over the same time.

    Drift of every block that is not driven, along y only where it is a tenth of that along x; displacement transducers,
    where there are any; joints that had a face at the start, without the peaks of their impacts; energy, the potential
    one since the start. More than seven blocks, transducers or joints are a map: one row each, the value a colour.

    Parameters
    ----------
    run : str, path or xarray.Dataset
        A run file, or what `simulate` returns.
    output : str or path, optional
        PNG, PDF or SVG to write, by the suffix.
    meshes : str or path, optional
        Folder of the structure's meshes; by default that of the run file, or the current one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        No run, a mesh that is not found, another suffix, a file that cannot be written.

    Examples
    --------
    >>> import blockshake
    >>> run = blockshake.simulate("my.yaml", "alkion", "nscd-rigid", duration=0.2)
    >>> figure = blockshake.plot(run, "run.png")
    >>> [axes.get_ylabel().splitlines()[0] for axes in figure.axes if axes.get_ylabel()]
    ['drift along x', 'normal force', 'friction ratio', 'energy', "audit's residual"]
    """
    if output is not None:
        check_picture(check_output(output))
    loaded, structure = load_run(run, meshes)
    content = plot_run, loaded, run_histories(loaded, structure)
    return drawn(*content) if output is None else save_picture(output, *content)


def plot_run(run, histories):
    """Figure of a run from `load_run` and its `run_histories`, see `plot`."""
    panels = [
        *_drift_panels(histories),
        *_transducer_panels(run),
        *_joint_panels(histories),
        *_energy_panels(run, histories),
    ]
    heights = [_MAP_ROW if panel.is_map else _ROW for panel in panels]
    figure = new_figure(_TITLE + sum(heights))
    rows = figure.subplots(
        len(panels), 2, sharex="col", width_ratios=(5.0, 1.15), height_ratios=heights, squeeze=False
    )
    named = set()
    for (axes, key), panel in zip(rows, panels, strict=True):
        key.set_axis_off()
        if panel.is_map:
            _draw_map(figure, axes, key, panel)
        else:
            _draw_lines(axes, panel)
            if panel.kind not in named:
                key.legend(*axes.get_legend_handles_labels(), loc="upper left", borderaxespad=0.0)
        named.add(panel.kind)
    _say_residual(rows[-1, 1], run)
    rows[-1, 0].set(xlabel="time [s]", xlim=(0.0, max(float(run["time"][-1]), 1e-3)))
    figure.align_ylabels(rows[:, 0])
    figure.suptitle(run_title(run, _TITLE_LETTERS), fontsize=8.0)
    return figure


def run_title(run, width):
    """Structure, motion and model of a run, and how it ended where that was early, in lines of so many letters."""
    scale, synthetic = float(run.attrs["motion_scale"]), int(run.attrs["motion_synthetic"])
    motion = run.attrs["motion"] + (" (synthetic)" if synthetic else "")
    factor = "" if scale == 1.0 else f" at {given(100.0 * scale)} %"
    title = f"{run.attrs['structure']} under {motion}{factor}, {model_label(run.attrs['model'])}"
    reason = run.attrs.get("reason")
    lines = [title, f"{run.attrs['status']}: {reason}"] if reason else [title]
    return "\n".join(textwrap.fill(line, width) for line in lines)


def _drift_panels(histories):
    blocks = np.flatnonzero(~histories["driven"])
    drift = _MILLI * histories["drift"].isel(body=blocks)
    along, aside = (drift.sel(axis=axis, drop=True) for axis in ("x", "y"))
    yield _Panel("drift along x\n[mm]", along)
    if np.abs(aside).max() > _SIDEWAYS * np.abs(along).max():
        yield _Panel("drift along y\n[mm]", aside)


def _transducer_panels(run):
    if "transducer_displacement" in run:
        reached = run["transducer_displacement"].dropna("time_acc", how="all")
        yield _Panel("transducers\n[mm]", _MILLI * reached.rename(time_acc="time"))


def _joint_panels(histories):
    known = np.isfinite(histories["normal_force"]).any("time")
    joints = histories.isel(joint=np.flatnonzero(known))
    if not joints.sizes["joint"]:
        return
    normal, uplift = _KILO * joints["normal_force"], _MILLI * joints["uplift"]
    largest = float(normal.max())
    usual = float(normal.quantile(_MOSTLY))
    shown = _HEADROOM * usual if largest > _PEAK * usual else largest
    cut = f"; up to {number(largest, 2)}" if shown < largest else ""
    yield _Panel(f"normal force\n[kN]{cut}", normal, (0.0, shown))
    yield _Panel(f"friction ratio\nT / ({MICRO} N) [1]", joints["friction_ratio"], (0.0, 1.0), line=1.0)
    if uplift.max() > 0.0:
        yield _Panel("uplift\n[mm]", uplift, (0.0, float(uplift.max())))


def _energy_panels(run, histories):
    energy = run["energy"].sel(term=list(ENERGY_TERMS))
    # the zero of the potential energy is arbitrary
    since = energy - energy.isel(time=0, drop=True).where(energy["term"] == "potential", 0.0)
    yield _Panel("energy\n[kJ]", _KILO * since)
    yield _Panel("audit's residual\n[J]", histories["residual"])


def _draw_lines(axes, panel):
    values = panel.values if panel.kind else panel.values.expand_dims("term")
    lines = values.transpose(..., "time")
    colors = _COLORS if panel.kind else (BLACK,)
    for line, color in zip(lines, colors, strict=False):
        name = str(line[panel.kind].item()).replace("_", " ") if panel.kind else None
        axes.plot(values["time"], line, color=color, label=name)
    if panel.line is not None:
        axes.axhline(panel.line, color=GREY, linestyle="--", linewidth=0.8, zorder=0)
    if panel.limits is not None:
        axes.set_ylim(-0.04 * panel.limits[1], 1.08 * max(panel.limits[1], 1e-9))
    axes.set_ylabel(panel.label)


def _draw_map(figure, axes, key, panel):
    """A row for each line from below, in the order of the file; the value is a colour, grey where it is unknown."""
    values = panel.values.transpose(panel.kind, "time")
    names = values[panel.kind].values.tolist()
    largest = float(np.abs(values).max())
    low, high = panel.limits or (-largest, largest)
    colors = colormaps[_EITHER_SIGN if low < 0.0 else _ONE_SIGN].with_extremes(bad=LIGHT_GREY)
    image = axes.imshow(
        values, origin="lower", aspect="auto", vmin=low, vmax=high if high > low else low + 1.0,
        cmap=colors, interpolation="nearest",
        extent=(float(values["time"][0]), float(values["time"][-1]), 0.0, len(names)),
    )  # fmt: skip
    axes.grid(visible=False)
    places = np.arange(0, len(names), -(-len(names) // _MOST_NAMES))
    axes.set_yticks(places + 0.5, labels=[names[row] for row in places], fontsize=5.0)
    bar = figure.colorbar(image, cax=key.inset_axes([0.0, 0.0, 0.1, 1.0]))
    bar.set_label(panel.label.replace("\n", " "))


def _say_residual(key, run):
    """The residual as the run file states it."""
    share = run.attrs.get("energy_residual")
    if share is not None:
        words = f"largest {float(share):.1e}\nof the energy in play"
        key.text(0.0, 1.0, words, transform=key.transAxes, va="top", fontsize=7.0)
