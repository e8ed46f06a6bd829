"""Tables of what the definition of arrival, the damping and free rotations do to the contact stiffness."""

import numpy as np

from blockshake.report.blocks import Heading, Table, Text
from blockshake.report.wording import CUBED, given, millimetres, number, printed_unit


def definition_blocks(definitions):
    """The part of the stiffness section on its definition.

    Parameters
    ----------
    definitions : xarray.Dataset
        From `compare_definitions`.

    Returns
    -------
    list
        Blocks of the report.
    """
    return [
        Heading("What the definition of arrival and the damping decide", "stiffness-definitions"),
        Text(_words(definitions)),
        _definition_table(definitions),
        _free_table(definitions),
    ]


def _words(definitions):
    own = {
        "definition": definitions.attrs["definition"],
        "restitution": definitions.attrs["study_restitution"],
    }
    normal = definitions["stiffness"].sel(direction="normal")
    at_own_damping = normal.sel(restitution=own["restitution"]) / float(normal.sel(own))
    levels = [str(name) for name in definitions["definition"].values if str(name).endswith("%")]
    among_levels = normal.sel(definition=levels) / float(normal.sel(own))
    peaks = definitions["top_peak"].values
    return (
        "Zhou et al. (2023) read the waves once the blocks have reached a similar velocity, which is no stated "
        "instant. The "
        f"normal stiffness that meets the same material's wave speed is {_range(at_own_damping)} times the study's "
        f"over the "
        f"definitions at the study's damping, and {_range(among_levels)} times over levels of velocity and dampings. "
        f"The largest displacement of the highest block of {definitions.attrs['structure']} in the first "
        f"{given(definitions.attrs['duration'])} s then lies between {millimetres(np.nanmin(peaks))} and "
        f"{millimetres(np.nanmax(peaks))} mm in nominal runs that differ in stiffness and damping only, without a "
        "trend: in strong rocking any small change moves a single run so far."
    )


def _range(ratios):
    return f"{float(ratios.min()):.2f} to {float(ratios.max()):.2f}"


def _definition_table(definitions):
    factor, _ = printed_unit("N/m3")
    rows = []
    for restitution in definitions["restitution"].values:
        for definition in definitions["definition"].values:
            at = definitions.sel(restitution=restitution, definition=definition)
            rows.append(
                (
                    given(restitution),
                    str(definition),
                    *(number(at["stiffness"].sel(direction=one) / factor) for one in ("normal", "shear")),
                    *(number(at["wave_speed"].sel(direction=one), 4) for one in ("normal", "shear")),
                    millimetres(at["top_peak"]),
                    millimetres(at["top_peak_same_damping"]),
                )
            )
    attributes = definitions.attrs
    return Table(
        "Contact stiffness per area that meets the material's wave speed, by restitution C_res of the dashpot and "
        "by definition "
        "of arrival: a share of the step's velocity, the first peak of velocity, or the lag at which the "
        "accelerations of the "
        "lowest and the highest block agree best; the speed that each definition reads in one and the same tower, "
        "at the "
        f"study's stiffness; and the peak of the highest block of {attributes['structure']} relative to the slab "
        f"({attributes['motion']}, scale {given(attributes['motion_scale'])}, first {given(attributes['duration'])} "
        f"s, nominal "
        f"parameters) with that stiffness, at that C_res and at {given(attributes['study_restitution'])}. The "
        f"study's own: "
        f"{attributes['definition']} at {given(attributes['study_restitution'])}. None: no such instant, or no "
        f"completed run.",
        (
            "C_res", "Arrival", f"k_n [GN/m{CUBED}]", f"k_s [GN/m{CUBED}]", "Speed read, vertical [m/s]",
            "Speed read, horizontal [m/s]", "Peak, this C_res [mm]", "Peak, study's C_res [mm]",
        ),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def _free_table(definitions):
    target = float(definitions["target_wave_speed"].sel(direction="shear"))
    rows = [
        (
            given(factor),
            number(definitions["blocked_speed"].sel(factor=factor), 4),
            number(definitions["free_speed"].sel(factor=factor), 4),
        )
        for factor in definitions["factor"].values
    ]
    return Table(
        f"Why rotations are blocked under the horizontal step: with blocks free to turn the step bends the tower "
        f"instead of "
        f"shearing it, and no shear stiffness brings its speed near the shear wave's {target:.0f} m/s.",
        ("Shear stiffness over the study's [1]", "Speed, rotations blocked [m/s]", "Speed, rotations free [m/s]"),
        tuple(rows), "rrr",
    )  # fmt: skip
