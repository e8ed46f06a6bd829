"""Statements on contact stiffness and damping."""

from blockshake.geometry.reference_block import reference_body
from blockshake.pages.wording import given, number
from blockshake.study.calibration.settings import RESTITUTION as CALIBRATED
from blockshake.study.statements.calibration import judged_by_tests
from blockshake.study.statements.statement import judged, unjudged
from blockshake.study.stiffness.over_modulus import ONE_NUMBER, grows_with_density, over_modulus

RESTITUTION = 0.5


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
    """Restitution of the normal dashpot."""
    used = {case.structure.file.restitution for case in content.cases.values()}
    words = f"C_res is {', '.join(map(given, sorted(used)))} here."
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
