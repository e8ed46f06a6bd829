"""Statements on the joints that open and slip."""

from blockshake.pages.wording import model_label, percent
from blockshake.statistics.intervals import SURE_FROM, quantile_interval, sample_quantiles
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.statements.order import Limited, all_of, ordered
from blockshake.study.statements.statement import missing, unjudged

_FIRST, _SECOND, _THIRD, _FOURTH = OF_THE_PAPER


def occurrences(content):
    """Joints that open, by configuration: the smallest share in the first, LS-DEM."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    return ordered(
        content,
        _moved_joints(content, "ls-dem", "joint_uplift"),
        [(_FIRST, other) for other in (_SECOND, _THIRD, _FOURTH)],
        f"Share of the joints ({_all_joints(content)}) whose middle opens by more than a marker's noise in %, median "
        "over the samples",
        percent,
        ceiling=1.0,
    )


def complicated(content):
    """Joints that open or slip, by configuration and model: a larger share of them in configurations 3 and 4."""
    pairs = [(simple, walls) for simple in (_FIRST, _SECOND) for walls in (_THIRD, _FOURTH)]
    words = (
        f"Share of the joints ({_all_joints(content)}) at whose middle the faces part or slip by more than a marker's "
        "noise in %, median over the samples"
    )
    return all_of(
        {
            model_label(model): ordered(
                content,
                _moved_joints(content, model, "joint_uplift", "joint_slip"),
                pairs,
                words,
                percent,
                ceiling=1.0,
            )
            for model in content.study["models"]
        }
    )


def _all_joints(content):
    """Numbers of the joints of the structures, in words."""
    counts = {
        name: next(iter(case.responses.values())).samples.sizes["joint"]
        for name, case in content.cases.items()
    }
    return ", ".join(f"{count} of {name}" for name, count in counts.items())


def _moved_joints(content, model, *figures):
    """Share of the joints any of whose figures is beyond the markers' noise, by case.

    A larger structure has more joints, so that their number would follow from the structure alone. A block that rocks
    moves the middle of its joint along the face too, so that slip alone would count it.
    """
    found = {}
    for name, case in content.cases.items():
        samples = counted_samples(case.responses[model].samples)
        if samples.sizes["sample"] >= SURE_FROM:
            beyond = samples[list(figures)].to_dataarray().max("variable") > case.marker_noise
            shares = beyond.mean("joint").values
            median, limits = sample_quantiles(shares, [0.5])[0], quantile_interval(shares, [0.5])[:, 0]
            found[name] = Limited(float(median), *map(float, limits))
    return found
