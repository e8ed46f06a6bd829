"""Tables of the contact stiffness by definition of arrival, by damping, and with rotations free."""

from blockshake.report.document.blocks import Heading, Table, Text
from blockshake.report.document.units import printed
from blockshake.report.document.wording import given, millimetres, number, percent
from blockshake.study.stiffness.definition_range import definition_range

_STIFFNESS = printed("N/m3")


def definition_blocks(definitions):
    """Blocks of the stiffness section on the definition of arrival, from `compare_definitions`."""
    return [
        Heading("Influence of the definition of arrival and of the damping", "stiffness-definitions"),
        Text(definition_words(definitions)),
        definition_table(definitions),
        _free_table(definitions, definition_range(definitions)),
    ]


def definition_words(definitions):
    """How far the stiffness and the peak hang on the definition and on the damping, in sentences."""
    attributes, found = definitions.attrs, definition_range(definitions)
    tau = f"(Kendall's tau {found.trend.tau:.2f}, p = {number(found.trend.p, 2)})"
    follows = "rises" if found.trend.tau > 0.0 else "falls"
    trend = (
        f"The peak {follows} with the stiffness {tau}."
        if found.trend.shown
        else f"No trend of the peak with the stiffness is shown {tau}."
    )
    return (
        "Zhou et al. (2023) read the waves once the blocks have reached a similar velocity and state no instant. "
        "The normal stiffness that meets the wave speed of the same material is "
        f"{_ratios(found.at_own_damping)} times that of the study over the definitions at the damping of the study, "
        f"and {_ratios(found.over_levels)} times over the levels of velocity and all dampings. Nominal runs that "
        f"differ in stiffness and damping only, of {attributes['structure']} over the first "
        f"{given(attributes['duration'])} s, give its highest block a peak between "
        f"{millimetres(found.top_peak.lowest)} and {millimetres(found.top_peak.highest)} mm. {trend}"
    )


def _ratios(found):
    return f"{found.lowest:.2f} to {found.highest:.2f}"


def definition_table(definitions):
    """`Table` of the stiffness, the speed read and the peak, by restitution and definition."""
    rows = []
    for restitution in definitions["restitution"].values:
        for definition in definitions["definition"].values:
            at = definitions.sel(restitution=restitution, definition=definition)
            rows.append((
                given(restitution), str(definition),
                *(number(_STIFFNESS.factor * at["stiffness"].sel(direction=one)) for one in ("normal", "shear")),
                *(number(at["wave_speed"].sel(direction=one), 4) for one in ("normal", "shear")),
                millimetres(at["top_peak"]), millimetres(at["top_peak_same_damping"]),
            ))  # fmt: skip
    own = definitions.attrs
    return Table(
        "Contact stiffness per area that meets the wave speed of the material, by restitution C_res of the dashpot and "
        "by definition of arrival: a share of the velocity of the step, the first peak of velocity, or the lag of best "
        "agreement between the accelerations of the lowest and the highest block. Speed read: by each definition in "
        "one tower at the stiffness of the study. Peak: of the highest block relative to the slab "
        f"({own['structure']}, {own['motion']}, scale {given(own['motion_scale'])}, first {given(own['duration'])} s, "
        f"nominal parameters) with that stiffness, at that C_res and at {given(own['study_restitution'])}. The study "
        f"uses {own['definition']} at {given(own['study_restitution'])}. None: no such instant, or no completed run.",
        (
            "C_res", "Arrival", f"k_n [{_STIFFNESS.name}]", f"k_s [{_STIFFNESS.name}]", "Speed read, vertical [m/s]",
            "Speed read, horizontal [m/s]", "Peak, this C_res [mm]", "Peak, C_res of the study [mm]",
        ),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def _free_table(definitions, found):
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
        "Speed of a horizontal step with the rotations of the blocks blocked and free. With free rotations the "
        f"largest speed up to {given(found.free_factor)} times the shear stiffness of the study is "
        f"{percent(found.free_share)} % of the shear wave speed of the material, {target:.0f} m/s.",
        ("Shear stiffness over the study's [1]", "Speed, rotations blocked [m/s]", "Speed, rotations free [m/s]"),
        tuple(rows), "rrr",
    )  # fmt: skip
