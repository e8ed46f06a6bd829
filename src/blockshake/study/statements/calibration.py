"""Statements on the samples and on the calibration of friction."""

import numpy as np

from blockshake.pages.rows import face_markers
from blockshake.pages.wording import given, model_label, number, parameter_label, percent
from blockshake.study.calibration.calibration import ALL, models_of
from blockshake.study.calibration.section import answer_words
from blockshake.study.sampling.distributions import TABLE_2
from blockshake.study.statements.statement import judged, unjudged

SIZE = 50
LOWEST, HIGHEST = 0.3, 0.8  # range of the mean friction
OPTIMUM = 0.75  # mean friction of Table 2
_CONCRETE = "friction.concrete.concrete"
_NO_SEARCH = "This study calibrates no friction of concrete on concrete."
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
    """Range in which the friction of concrete on concrete is searched."""
    if (one := _searched(content)) is None:
        return unjudged(_NO_SEARCH)
    found = content.calibration
    models = " and ".join(map(model_label, models_of(found)))
    return judged(
        one["lowest"] <= LOWEST and one["highest"] >= HIGHEST,
        f"{found['size']} samples are drawn evenly from {given(one['lowest'])} to {given(one['highest'])}; those near "
        f"a value stand for the ensemble of that mean. Each runs all open tests by {models}.",
    )


def optimum(content):
    """Friction of concrete on concrete that fits best."""
    if (one := _searched(content)) is None:
        return unjudged(_NO_SEARCH)
    if one["assumed"] != OPTIMUM:
        return unjudged(f"The study takes a mean of {given(one['assumed'])}.")
    return judged_by_tests(
        content.calibration, _CONCRETE, "A mean counts as the best where its range has two ends."
    )


def _searched(content):
    """The calibrated friction of concrete on concrete, None where this study calibrates none."""
    return content.calibration and content.calibration["parameters"].get(_CONCRETE)
