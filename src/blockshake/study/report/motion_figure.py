"""Ground motions as drawn in the paper's Fig. 5, and their response spectra."""

from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from blockshake.pages.drawing import BLACK, BLUE, LIGHT_GREY, RED, new_figure
from blockshake.pages.wording import SQUARED

_ROWS = (
    ("acceleration", f"acceleration [m/s{SQUARED}]", 1.0),
    ("velocity", "velocity [m/s]", 1.0),
    ("displacement", "displacement [mm]", 1e3),
)


def plot_motions(motions, windows):
    """Figure of histories along x at 100 %, one column a motion.

    ``motions`` from `describe_motion`; ``windows``: durations simulated of each, by name [s].
    """
    figure = new_figure(0.125)
    panels = figure.subplots(3, len(motions), sharex="col", sharey="row", squeeze=False)
    for column, motion in zip(panels.T, motions, strict=True):
        for axes, (name, _, factor) in zip(column, _ROWS, strict=True):
            axes.plot(motion["time"], factor * motion[name], color=BLACK, linewidth=0.6)
            for window in windows.get(motion.attrs["name"], []):
                axes.axvline(window, color=RED, linestyle="--", linewidth=0.9)
        column[0].set_title(_title(motion))
        column[-1].set(xlabel="time [s]", xlim=(0.0, float(motion["time"][-1])))
    for axes, (_, label, _) in zip(panels[:, 0], _ROWS, strict=True):
        axes.set_ylabel(label)
    figure.align_ylabels(panels[:, 0])
    return figure


def plot_spectra(motions):
    """Figure of response spectra at 5 % damping and 100 %, with the ordinates that a synthetic motion aims at.

    ``motions`` from `describe_motion`.
    """
    figure = new_figure(0.075)
    panels = figure.subplots(1, len(motions), sharey=True, squeeze=False)[0]
    entries = {}
    for axes, motion in zip(panels, motions, strict=True):
        for spectrum in motion["spectra"].to_numpy() if "spectra" in motion else ():
            axes.plot(motion["period"], spectrum, color=LIGHT_GREY, linewidth=0.6)
        axes.plot(
            motion["period"], motion["pseudo_acceleration"], color=BLUE, linewidth=1.1, label="motion used"
        )
        if "target" in motion:
            published = motion["published"].astype(bool)
            for which, face, label in (
                (published, RED, "target, published ordinate"),
                (~published, "white", "target, inferred ordinate"),
            ):
                if which.any():
                    axes.plot(
                        motion["target_period"][which], motion["target"][which], "o", markersize=4.0,
                        markerfacecolor=face, markeredgecolor=RED, label=label,
                    )  # fmt: skip
        if "aim" in motion:
            for name, colour, whose in (("aim", RED, "target"), ("chosen", BLACK, "records chosen")):
                for bound, line in zip(motion[name].to_numpy(), ("--", "-", "--"), strict=True):
                    label = {"label": f"{whose}, median and scatter"} if line == "-" else {}
                    axes.plot(motion["aimed_period"], bound, line, color=colour, linewidth=1.0, **label)
        axes.set(xscale="log", yscale="log", xlabel="period [s]", title=_title(motion))
        axes.set_xticks([0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0], ["0.05", "0.1", "0.2", "0.5", "1", "2", "4"])
        axes.set_xticks([], minor=True)
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_minor_locator(NullLocator())
        entries |= {label: handle for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    panels[0].set_ylabel(f"pseudo-acceleration [m/s{SQUARED}]")
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=len(entries))
    return figure


def _title(motion):
    return motion.attrs["name"] + (" (synthetic)" if motion.attrs.get("synthetic") else "")
