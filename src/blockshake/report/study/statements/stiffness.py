"""Statements on contact stiffness, wave speed and damping."""

import numpy as np

from blockshake.geometry.reference_block import reference_body
from blockshake.report.document.units import printed
from blockshake.report.document.wording import given, millimetres, number, percent
from blockshake.report.study.statements.calibration import judged_by_tests
from blockshake.report.study.statements.statement import judged, unjudged
from blockshake.study.calibration.settings import RESTITUTION as CALIBRATED
from blockshake.study.stiffness.definition_range import definition_range
from blockshake.study.stiffness.over_modulus import ONE_NUMBER, grows_with_density, over_modulus
from blockshake.study.stiffness.similar_velocity import TOLERANCES, read_at_similar_velocity
from blockshake.study.stiffness.wave_speed import speed_deviation

RESTITUTION = 0.5
_MATCHED = 1e-3  # relative difference of wave speeds that counts as none


def wave_speeds(content):
    """Eqs. (7) and (8)."""
    told, largest = [], 0.0
    for calibrated in content.calibrated:
        material = _material(content, calibrated)
        shear = material.youngs_modulus / (2.0 + 2.0 * material.poisson_ratio)
        for direction, modulus in (("normal", material.youngs_modulus), ("shear", shear)):
            formula = np.sqrt(modulus / material.density)
            target = float(calibrated.waves["target_wave_speed"].sel(direction=direction))
            deviation = speed_deviation(calibrated.waves, direction)
            largest = max(largest, abs(target / formula - 1.0), abs(deviation))
            told.append(
                f"{direction} {number(formula, 4)} m/s by the equation, tower within {1e6 * deviation:.0f} ppm"
            )
        told.append(
            f"nominal materials; Poisson's ratio {given(material.poisson_ratio)}, which the paper does not state"
        )
    return judged(largest < _MATCHED, f"{'; '.join(told)}.")


def delayed(content):
    """Higher blocks follow later."""
    told, rises = [], True
    for calibrated in content.calibrated:
        arrival = calibrated.waves["arrival"]
        rises = rises and bool((arrival.diff("block") > 0.0).all())
        for direction in calibrated.waves["direction"].values:
            times = ", ".join(number(1e3 * one) for one in arrival.sel(direction=direction).values)
            told.append(f"{direction} {times} ms")
    return judged(rises, f"Arrivals at the blocks of the tower from the lowest up: {'; '.join(told)}.")


def similar_velocity(content):
    """The instant at which the waves are read, Fig. 9."""
    readings = [read_at_similar_velocity(one.waves) for one in content.calibrated]
    told = []
    for direction in ("normal", "shear"):
        at = [one.sel(direction=direction)["stiffness_ratio"] for one in readings]
        ratios = np.concatenate([one.values[np.isfinite(one.values)] for one in at])
        never = sorted(
            {float(one["within"][place]) for one in at for place in np.flatnonzero(np.isnan(one.values))}
        )
        words = f"{direction} {min(ratios):.2f} to {max(ratios):.2f}" if len(ratios) else f"{direction} none"
        if never:
            words += f" (never within {' or '.join(percent(one) for one in never)} % while the test lasts)"
        told.append(words)
    return judged(
        False,
        "The study reads the lag when half of the step arrives. Read once the velocities of all blocks are within "
        f"{percent(TOLERANCES[0])} to {percent(TOLERANCES[-1])} % of each other, the stiffness is so many times that "
        f"of the study: {'; '.join(told)}.",
    )


def definitions(content):
    """Other readings of the arrival."""
    found = definition_range(content.definitions)
    own, levels = found.at_own_damping, found.over_levels
    return unjudged(
        "The paper names no difference of the velocities that counts as similar. By definition of arrival k_n is "
        f"{own.lowest:.2f} to {own.highest:.2f} times that of the study, and {levels.lowest:.2f} to "
        f"{levels.highest:.2f} times over levels of velocity and dampings."
    )


def histograms(content):
    """Stiffness of the samples, Fig. 10."""
    factor, unit = printed("N/m3")
    told = []
    for calibrated in content.calibrated:
        table = calibrated.stiffness
        for symbol, column in (("k_n", "normal"), ("k_s", "shear")):
            values = factor * table[f"ls_dem.{column}_stiffness"]
            told.append(f"{symbol} {number(values.min())} to {number(values.max())} {unit}")
    return unjudged(
        f"The paper prints histograms of a stiffness of a node, without a table. Per area here: {'; '.join(told)}."
    )


def follow_moduli(content):
    """Stiffness and moduli over the samples."""
    told, one_number = [], []
    for calibrated in content.calibrated:
        table, moduli = calibrated.stiffness, _sampled(content, calibrated, "youngs_modulus")
        if moduli is None:
            return unjudged("Young's modulus is no random variable of this study.")
        shear = moduli / (2.0 + 2.0 * _material(content, calibrated).poisson_ratio)
        for words, column, modulus in (("k_n / E", "normal", moduli), ("k_s / G", "shear", shear)):
            found = over_modulus(table[f"ls_dem.{column}_stiffness"].to_numpy(), modulus)
            one_number.append(found.is_one_number)
            told.append(
                f"{words} {number(found.mean, 4)} per m, smallest and largest of {len(modulus)} samples "
                f"{number(100.0 * found.spread, 2)} % apart, correlation {found.correlation:.4f}"
            )
    return judged(
        not any(one_number),
        f"{'; '.join(told)}. A spread below {number(100.0 * ONE_NUMBER, 1)} % counts as one number.",
    )


def heavier_blocks(content):
    """Stiffness and density over the samples."""
    told, rises = [], []
    for calibrated in content.calibrated:
        moduli = _sampled(content, calibrated, "youngs_modulus")
        density = _sampled(content, calibrated, "density")
        if moduli is None or density is None:
            return unjudged("Young's modulus and density are not both random variables of this study.")
        stiffness = calibrated.stiffness["ls_dem.normal_stiffness"].to_numpy()
        spread = over_modulus(stiffness, moduli).spread
        rises.append(grows_with_density(stiffness, moduli, density))
        told.append(
            f"k_n / E differs by {number(100.0 * spread, 2)} % at most over densities from {number(density.min(), 4)} "
            f"to {number(density.max(), 4)} kg/m3"
        )
    return judged(
        all(rises),
        f"At an equal modulus {'; '.join(told)}. At an equal speed of the waves the modulus grows as the density, and "
        "k_n with it.",
    )


def restitution(content):
    """Restitution of the normal dashpot, and the trace of it in a stack."""
    used = {case.structure.file.restitution for case in content.cases.values()}
    table = content.definitions
    own = table.sel(definition=table.attrs["definition"])
    told = ", ".join(
        f"{millimetres(own['top_peak'].sel(restitution=one))} mm at {given(one)}"
        for one in table["restitution"].values
    )
    words = (
        f"C_res is {', '.join(map(given, sorted(used)))} here. Peak of the top block in a nominal run of "
        f"{table.attrs['structure']} with the stiffness that goes with C_res: {told}."
    )
    if used != {RESTITUTION}:
        return judged(False, words)
    if content.calibration is None or CALIBRATED not in content.calibration["parameters"]:
        return unjudged(
            f"C_res is taken as printed and not calibrated, so that no result tells the need. {words}"
        )
    return judged_by_tests(content.calibration, CALIBRATED, words)


def _material(content, calibrated):
    """Material of the tower's blocks."""
    structure = content.cases[calibrated.cases[0]].structure
    return structure.file.materials[structure.file.bodies[reference_body(structure)].material]


def _sampled(content, calibrated, name):
    """Sampled values of a property of that material, shape (n_samples,); None where it is not random."""
    structure = content.cases[calibrated.cases[0]].structure
    column = f"materials.{structure.file.bodies[reference_body(structure)].material}.{name}"
    return content.design[column].to_numpy() if column in content.design else None
