"""Statements on the samples and on the calibration of friction."""

import numpy as np

from blockshake.report.document.rows import face_markers
from blockshake.report.document.wording import given, model_label, number, parameter_label, percent
from blockshake.report.study.calibrations.all_tests import answer_words
from blockshake.report.study.statements.statement import judged, unjudged
from blockshake.study.calibration.calibration import ALL
from blockshake.study.sampling.distributions import TABLE_2

SIZE = 50
LOWEST, HIGHEST = 0.3, 0.8  # range of the mean friction
OPTIMUM = 0.75  # mean friction of Table 2
_NO_SEARCH = "This study searches no mean friction."
_SIDES = {0.0: "is refused", 1.0: "is not refused"}
_LOW_VARIABILITY = 0.1  # half of an interval over its median


def table_2(content):
    """Distributions of Table 2 and their samples, Fig. 8."""
    summary, asked = content.design_summary, content.distributions
    mean = max(abs(summary["mean"][name] / one.mean - 1.0) for name, one in asked.items())
    short = [1.0 - summary["cov"][name] / one.cov for name, one in asked.items()]
    other = sorted({name for name in {**asked, **TABLE_2} if asked.get(name) != TABLE_2.get(name)}, key=str)
    words = (
        f"Other than in the table: {', '.join(map(parameter_label, other)) or 'none'}. The samples' means are off by "
        f"{percent(mean)} % at most; their coefficients of variation fall short by {percent(min(short))} to "
        f"{percent(max(short))} %."
    )
    return judged(not other, words)


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
    told, halves, fewer = [], [], []
    for case in content.cases.values():
        top = next(iter(face_markers(case.structure).values()))
        for model, one in case.responses.items():
            counted = int(one.envelope.attrs["counted"])
            if counted < len(content.design):
                fewer.append(f"{case.name}, {model_label(model)} {counted}")
                continue
            at = {"frame": "slab", "marker": top, "quantile": 0.5}
            median, limits = one.envelope["peak"].sel(at), one.envelope["peak_interval"].sel(at)
            share = float(limits.max() - limits.min()) / (2.0 * float(median))
            halves.append(share)
            told.append(f"{case.name}, {model_label(model)} {percent(share)} %")
    smaller = f" Of fewer samples and not judged: {'; '.join(fewer)}." if fewer else ""
    if not told:
        return unjudged(f"No model has all {len(content.design)} samples of a case.{smaller}")
    words = (
        "Half of the 95 % interval, by order statistics, of the median peak at the top, over that median, of "
        f"{len(content.design)} samples: {'; '.join(told)}. {percent(_LOW_VARIABILITY)} % counts as low. The "
        f"interval takes the samples as independent; those of a Latin hypercube vary less.{smaller}"
    )
    return judged(True, words) if np.max(halves) < _LOW_VARIABILITY else unjudged(words)


def judged_by_tests(found, parameter, words):
    """Finding on a value that the joint calibration tells of, after other words."""
    one = found["parameters"][parameter]
    answer = one["answers"][ALL]
    words = f"By all open tests, {answer_words(parameter, one)} {words}"
    if any(test["synthetic"] for test in found["tests"]):
        return unjudged(f"Tests are synthetic and tell nothing of the specimens. {words}")
    if answer["assumed_is_refused"]:
        return judged(False, words)
    bounded = answer["lower"] is not None and answer["upper"] is not None
    return judged(True, words) if bounded else unjudged(words)


def friction_range(content):
    """Range in which the mean friction is searched."""
    if not content.friction:
        return unjudged(_NO_SEARCH)
    ranges = {(found["lowest"], found["highest"]) for found in content.friction.values()}
    words = "; ".join(
        f"{case}: {', '.join(map(given, found['means']['mean']))}" for case, found in content.friction.items()
    )
    sizes = {found["size"] for found in content.friction.values()}
    models = sorted({model_label(found["model"]) for found in content.friction.values()})
    return judged(
        ranges == {(LOWEST, HIGHEST)},
        f"Means that were run, {words}; samples of each: {', '.join(map(given, sorted(sizes)))}; by "
        f"{' and '.join(models)}.",
    )


def optimum(content):
    """Mean friction that fits best."""
    if not content.friction:
        return unjudged(_NO_SEARCH)
    told, told_apart, refused, synthetic = [], True, False, []
    for case, found in content.friction.items():
        means, accepted = found["means"]["mean"], np.asarray(found["means"]["accepted"], dtype=float)
        within = min(means) <= OPTIMUM <= max(means)
        side = float(np.interp(OPTIMUM, means, accepted)) if within else None
        known = not found["answer"].startswith("unknown")
        refused = refused or (known and side == 0.0)
        bounded = found["lower"] is not None and found["upper"] is not None
        told_apart = told_apart and known and bounded and side == 1.0
        synthetic += [case] if found["synthetic"] else []
        words = f"{case}: the mean is {found['answer']}; lowest score at {given(found['best'])}"
        if not within:
            words += f"; {given(OPTIMUM)} lies outside the means that were run"
        elif known:
            words += (
                f"; {given(OPTIMUM)} {_SIDES.get(side, 'lies between a refused mean and one that is not')}"
            )
        if within and np.abs(np.asarray(means) - OPTIMUM).min() > 1e-9:
            words += f"; {given(OPTIMUM)} itself was not run"
        told.append(words)
    words = f"{'; '.join(told)}."
    if content.calibration is not None:
        words += " By all open tests: " + " ".join(
            answer_words(name, one)
            for name, one in content.calibration["parameters"].items()
            if name.startswith("friction.")
        )
    if synthetic:
        return unjudged(
            f"The tests of {', '.join(synthetic)} are synthetic and tell nothing of the specimens. {words}"
        )
    if refused:
        return judged(False, words)
    words = f"{words} A mean counts as the best where it is not refused and the range has both ends."
    return judged(True, words) if told_apart else unjudged(f"The tests do not tell the mean. {words}")
