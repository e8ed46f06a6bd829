"""The model extended by a cause: an effect of the registry, or a form from outside."""

from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS


def can_extend(cause):
    """Whether a model can hold a `Cause`, and whether the cause acts in tests that are still to come."""
    if not cause.members:
        return False
    if not cause.outside:
        return True
    form = FORMS[cause.name]
    return form.act is not None and form.lasts(cause.when)


def extended_experiment(experiment, cause, number, test):
    """An experiment with one member of a cause in it.

    Parameters
    ----------
    experiment : Experiment
    cause : Cause
    number : int
        Of the member; counted from the start again where there are fewer.
    test : str
        Name: a form from outside may act in some tests alone.

    Returns
    -------
    Experiment
    """
    values = cause.members[number % len(cause.members)]
    if cause.outside:
        form = FORMS[cause.name]
        return form.act(experiment, values[form.size], cause.place, cause.when, test)
    effect = EFFECTS[cause.name]
    extend = effect.extends or effect.act
    return extend(experiment, values, cause.place)
