"""Statements on the inputs: measured tests, samples, friction, contact stiffness and damping."""

from pathlib import Path

import numpy as np

from blockshake.dynamics.motion import CHANNELS
from blockshake.geometry.reference_block import reference_body
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import given, model_label, number, parameter_label, percent
from blockshake.study.calibration.calibration import ALL, models_of
from blockshake.study.calibration.section import answer_words
from blockshake.study.calibration.settings import RESTITUTION
from blockshake.study.sampling.distributions import TABLE_2
from blockshake.study.statements.statement import against_tests, compared, judged, unjudged
from blockshake.study.stiffness.over_modulus import ONE_NUMBER, grows_with_density, over_modulus

SIZE = 50
LOWEST, HIGHEST = 0.3, 0.8  # range of the mean friction
PRINTED_FRICTION, PRINTED_RESTITUTION = 0.75, 0.5
_CONCRETE = "friction.concrete.concrete"
_SAME = 0.005  # relative difference of two printed numbers that are one and the same
_LOW_VARIABILITY = 0.1  # half of an interval over its median


def along_one_axis(content):
    """A table that shakes along one axis."""
    cases = compared(content)
    unread = [case.name for case in cases if case.base.attrs.get("unread")]
    if unread:
        return unjudged(f"No marker reads all axes of the slab of {', '.join(unread)}.")
    words, shares = [], []
    for case in cases:
        moved = abs(case.base["displacement"]).max("time")
        aside = float(max(moved.sel(channel=one) for one in CHANNELS if one not in ("x", "pitch_y")))
        shares.append(aside / float(moved.sel(channel="x")))
        pitch = number(1e3 * moved.sel(channel="pitch_y"))
        words.append(f"{case.name} {percent(shares[-1])} %, pitch {pitch} mrad")
    sentence = f"Displacement of the slab across x or upright, over that along x: {'; '.join(words)}."
    return against_tests(cases, max(shares) < 0.05, f"{sentence} 5 % counts as none.")


def strongest_tests(content):
    """Tests with the largest accelerations, among those by the motions of the study."""
    words, holds = [], True
    for case in compared(content):
        named = case.settings["measured"]
        tests = [
            test
            for test in load_campaign(named["campaign"]).tests.values()
            if Path(test.motion).stem in content.motions
        ]
        peaks = {
            test.name: abs(test.scale) * content.motions[Path(test.motion).stem].attrs["peak_acceleration"]
            for test in tests
        }
        strongest = max(tests, key=lambda test: peaks[test.name])
        peak = content.peak_acceleration(case)
        holds = holds and peak >= (1.0 - _SAME) * peaks[strongest.name]
        words.append(
            f"{case.name} {named['test']} with {number(peak)} m/s2, the strongest of the campaign {strongest.name} "
            f"({strongest.role}) with {number(peaks[strongest.name])} m/s2"
        )
        opened = [test.name for test in tests if test.role != "sealed"]
        if strongest.name not in opened and opened:
            best = max(opened, key=peaks.get)
            words[-1] += f", of its open tests {best} with {number(peaks[best])} m/s2"
    return judged(holds, f"Commanded peaks: {'; '.join(words)}.")


def table_2(content):
    """Distributions of Table 2 and their samples, Fig. 8."""
    summary, asked = content.design_summary, content.distributions
    mean = max(abs(summary["mean"][name] / one.mean - 1.0) for name, one in asked.items())
    short = [1.0 - summary["cov"][name] / one.cov for name, one in asked.items()]
    other = sorted({name for name in {**asked, **TABLE_2} if asked.get(name) != TABLE_2.get(name)}, key=str)
    return judged(
        not other,
        f"Other than in the table: {', '.join(map(parameter_label, other)) or 'none'}. The samples' means are off by "
        f"{percent(mean)} % at most; their coefficients of variation fall short by {percent(min(short))} to "
        f"{percent(max(short))} %.",
    )


def correlation_control(content):
    """Correlation of the samples against the target."""
    summary = content.design_summary
    error, chance = summary["rms_correlation_error"], 1.0 / np.sqrt(summary["size"] - 1.0)
    target = "that of the configuration" if content.study["ensemble"].get("correlation") else "none"
    return judged(
        error < 0.1 * chance,
        f"The paper states no correlation; asked for here: {target}. The correlations of the samples miss it by "
        f"{number(error, 2)} rms and {number(summary['largest_correlation_error'], 2)} at most; pairs at random miss "
        f"it by {number(chance, 2)}. A tenth of that counts as controlled.",
    )


def size(content):
    """Number of samples."""
    counts = [
        f"{one.samples.sizes['sample']} of {case.name} by {model_label(model)}"
        for case in content.cases.values()
        for model, one in case.responses.items()
        if one.samples.sizes["sample"] != len(content.design)
    ]
    fewer = f" Fewer: {', '.join(counts)}." if counts else ""
    return judged(len(content.design) == SIZE and not counts, f"{len(content.design)} samples.{fewer}")


def low_variability(content):
    """Estimates of small designs that vary little: of ensembles of the whole design."""
    if len(content.design) != SIZE:
        return unjudged(f"This study has {len(content.design)} samples, not {SIZE}.")
    halves, fewer = {}, []
    for case in content.cases.values():
        top = next(iter(face_markers(case.structure).values()))
        for model, one in case.responses.items():
            name, counted = f"{case.name}, {model_label(model)}", int(one.envelope.attrs["counted"])
            if counted < len(content.design):
                fewer.append(f"{name} {counted}")
                continue
            at = {"frame": "slab", "marker": top, "quantile": 0.5}
            median, limits = one.envelope["peak"].sel(at), one.envelope["peak_interval"].sel(at)
            halves[name] = float(limits.max() - limits.min()) / (2.0 * float(median))
    smaller = f" Of fewer samples and not judged: {'; '.join(fewer)}." if fewer else ""
    if not halves:
        return unjudged(f"No model has all {len(content.design)} samples of a case.{smaller}")
    words = (
        "Half of the 95 % interval, by order statistics, of the median peak at the top, over that median, of "
        f"{len(content.design)} samples: {'; '.join(f'{name} {percent(half)} %' for name, half in halves.items())}. "
        f"{percent(_LOW_VARIABILITY)} % counts as low. The interval takes the samples as independent; those of a Latin "
        f"hypercube vary less.{smaller}"
    )
    return judged(True, words) if np.max(list(halves.values())) < _LOW_VARIABILITY else unjudged(words)


def friction_range(content):
    """Range in which the friction of concrete on concrete is searched."""
    if (searched := _calibrated(content, _CONCRETE)) is None:
        return unjudged("This study calibrates no friction of concrete on concrete.")
    models = " and ".join(map(model_label, models_of(content.calibration)))
    return judged(
        searched["lowest"] <= LOWEST and searched["highest"] >= HIGHEST,
        f"{content.calibration['size']} samples are drawn evenly from {given(searched['lowest'])} to "
        f"{given(searched['highest'])}; those near a value stand for the ensemble of that mean. Each runs all open "
        f"tests by {models}.",
    )


def optimum(content):
    """Friction of concrete on concrete that fits best."""
    if (searched := _calibrated(content, _CONCRETE)) is None:
        return unjudged("This study calibrates no friction of concrete on concrete.")
    if searched["assumed"] != PRINTED_FRICTION:
        return unjudged(f"The study takes a mean of {given(searched['assumed'])}.")
    return _by_tests(content, _CONCRETE, "A mean counts as the best where its range has two ends.")


def restitution(content):
    """Restitution of the normal dashpot."""
    used = {case.structure.file.restitution for case in content.cases.values()}
    words = f"C_res is {', '.join(map(given, sorted(used)))} here."
    if used != {PRINTED_RESTITUTION}:
        return judged(False, words)
    if _calibrated(content, RESTITUTION) is None:
        return unjudged(
            f"C_res is taken as printed and not calibrated, so that no result tells the need. {words}"
        )
    return _by_tests(content, RESTITUTION, words)


def _calibrated(content, parameter):
    """Entry of a parameter in the joint calibration; None where this study does not calibrate it."""
    return content.calibration and content.calibration["parameters"].get(parameter)


def _by_tests(content, parameter, words):
    """Finding on the value of a calibrated parameter that the study takes, after which come other words."""
    entry = _calibrated(content, parameter)
    answer = entry["answers"][ALL]
    words = f"By all open tests, {answer_words(parameter, entry)} {words}"
    if any(test["synthetic"] for test in content.calibration["tests"]):
        return unjudged(f"Tests are synthetic and tell nothing of the specimens. {words}")
    if answer["assumed_is_refused"]:
        return judged(False, words)
    bounded = answer["lower"] is not None and answer["upper"] is not None
    return judged(True, words) if bounded else unjudged(words)


def follow_moduli(content):
    """Stiffness and moduli over the samples."""
    words, one_number = [], []
    for calibrated in content.calibrated:
        table, moduli = calibrated.stiffness, _sampled(content, calibrated, "youngs_modulus")
        if moduli is None:
            return unjudged("Young's modulus is no random variable of this study.")
        structure = content.cases[calibrated.cases[0]].structure
        material = structure.file.materials[_material(structure)]
        shear = moduli / (2.0 + 2.0 * material.poisson_ratio)
        for label, column, modulus in (("k_n / E", "normal", moduli), ("k_s / G", "shear", shear)):
            ratio = over_modulus(table[f"ls_dem.{column}_stiffness"].to_numpy(), modulus)
            one_number.append(ratio.is_one_number)
            words.append(
                f"{label} {number(ratio.mean, 4)} per m, smallest and largest of {len(modulus)} samples "
                f"{number(100.0 * ratio.spread, 2)} % apart, correlation {ratio.correlation:.4f}"
            )
    return judged(
        not any(one_number),
        f"{'; '.join(words)}. A spread below {number(100.0 * ONE_NUMBER, 1)} % counts as one number.",
    )


def heavier_blocks(content):
    """Stiffness and density over the samples."""
    words, rises = [], []
    for calibrated in content.calibrated:
        moduli = _sampled(content, calibrated, "youngs_modulus")
        density = _sampled(content, calibrated, "density")
        if moduli is None or density is None:
            return unjudged("Young's modulus and density are not both random variables of this study.")
        stiffness = calibrated.stiffness["ls_dem.normal_stiffness"].to_numpy()
        spread = over_modulus(stiffness, moduli).spread
        rises.append(grows_with_density(stiffness, moduli, density))
        words.append(
            f"k_n / E differs by {number(100.0 * spread, 2)} % at most over densities from {number(density.min(), 4)} "
            f"to {number(density.max(), 4)} kg/m3"
        )
    return judged(
        all(rises),
        f"At an equal modulus {'; '.join(words)}. At an equal speed of the waves the modulus grows as the density, and "
        "k_n with it.",
    )


def _material(structure):
    """Name of the material of the tower's blocks."""
    return structure.file.bodies[reference_body(structure)].material


def _sampled(content, calibrated, name):
    """Sampled values of a property of the tower's material, shape (n_samples,); None where it is not random."""
    material = _material(content.cases[calibrated.cases[0]].structure)
    column = f"materials.{material}.{name}"
    return content.design[column].to_numpy() if column in content.design else None
