"""The joint calibration: answers of each open test, of the tests by each model, and of all of them together."""

import numpy as np
import xarray as xr

from blockshake.geometry.structure import load_structure
from blockshake.store import load_made
from blockshake.study.calibration.answers import SHARES, answer_hypotheses
from blockshake.study.calibration.comparison import hollow_shape, left_out, read_distances
from blockshake.study.calibration.settings import RESTITUTION, STIFFNESS, CalibrationSettings
from blockshake.study.sampling.distributions import load_distributions

ALL = "all"  # models together


def calibrate(compared, study):
    """Answers of the open tests on friction, and on restitution, stiffness and flatness of contacts.

    Parameters
    ----------
    compared : sequence of xarray.Dataset or path
        From `compare_open_tests`, every case by every model.
    study : dict
        Entries ``calibration``, ``ensemble`` and ``cases`` of the configuration.

    Returns
    -------
    dict
        JSON-like. ``size`` of the design. ``left_out``: tests that are left out, since too many samples have no
        reading of them. ``parameters`` by name: ``lowest``, ``highest`` and ``scale`` of the range
        [1], ``assumed``, the value that the study takes, ``values`` at which scores are taken, and ``answers`` by
        model and of `ALL`. ``tests``: a list with ``case``, ``model``, ``test``, ``motion``, ``scale``, ``reading``,
        ``synthetic``, ``unsolved``, ``chance`` of the test [1], and ``answers`` by parameter. An answer has
        ``known_ones``, ``chance`` [1], ``best``, ``lower`` and ``upper``, between which no value is refused, null where
        none is refused on that side, ``assumed_is_refused``, and of groups of tests ``score`` [1].

    Notes
    -----
    All answers of models form one family of questions, those of single tests another.
    """
    compared = [one if isinstance(one, xr.Dataset) else load_made(one) for one in compared]
    settings = CalibrationSettings(**study["calibration"])
    seed = study["ensemble"]["seed"]
    ranges = settings.ranges_of(load_distributions(study["ensemble"]["distributions"], "ensemble"))
    single, grouped = {}, {}
    for place, one in enumerate(compared):
        for (test, reading), found in read_distances(one).items():
            for parameter in map(str, one["parameter"].values):
                shares = one["share"].sel(parameter=parameter).to_numpy()
                single[parameter, place, test, reading] = (shares, [found])
                for group in (one.attrs["model"], ALL):
                    grouped.setdefault((parameter, group), (shares, []))[1].append(found)
    alone, together = answer_hypotheses(single, seed), answer_hypotheses(grouped, seed)
    parameters = {}
    for name, span in ranges.items():
        if not any(parameter == name for parameter, _ in together):
            continue
        assumed = _assumed(name, study, [one.attrs["case"] for one in compared])
        answers = {
            group: _constraint(answer, span, assumed) | {"score": answer.score.tolist()}
            for (parameter, group), answer in together.items()
            if parameter == name
        }
        parameters[name] = {
            "lowest": span.lowest,
            "highest": span.highest,
            "scale": span.scale,
            "assumed": assumed,
            "values": span.value(SHARES).tolist(),
            "answers": answers,
        }
    tests = [
        _of_test(compared[place], test, reading)
        | {
            "answers": {
                name: _constraint(
                    alone[name, place, test, reading], ranges[name], parameters[name]["assumed"]
                )
                for name in map(str, compared[place]["parameter"].values)
            }
        }
        for place, test, reading in dict.fromkeys(key[1:] for key in single)
    ]
    lost = [f"{one.attrs['case']} {test}, {one.attrs['model']}" for one in compared for test in left_out(one)]
    return {"size": settings.size, "parameters": parameters, "tests": tests, "left_out": lost}


def _of_test(compared, test, reading):
    """A test by a model as JSON-like values, and its chance by a reading."""
    one = compared.sel(test=test, reading=reading)
    return {
        **{key: compared.attrs[key] for key in ("case", "model")},
        "test": test,
        "motion": one["motion"].item(),
        "scale": one["scale"].item(),
        "synthetic": one["synthetic"].item(),
        "unsolved": one["unsolved"].item(),
        "reading": reading,
        "chance": one["chance"].item(),
    }


def models_of(found):
    """Models in the answers of `calibrate`, by name."""
    return sorted({group for one in found["parameters"].values() for group in one["answers"]} - {ALL})


def _assumed(name, study, cases):
    """Value that the study takes: a mean friction, the wave speed's stiffness, a structure's restitution and concavity.

    The structure is the first one of the ``cases``, for a concavity the first of boxes.
    """
    if name.startswith("friction."):
        return float(load_distributions(study["ensemble"]["distributions"], "ensemble")[name].mean)
    if name == STIFFNESS:
        return 1.0
    structures = [load_structure(case["structure"]) for case in study["cases"] if case["name"] in cases]
    if name == RESTITUTION:
        return float(structures[0].file.restitution)
    structure = next(one for one in structures if hollow_shape(one)[0])
    shape, edge = hollow_shape(structure)
    return structure.file.shapes[shape].hollow / edge


def _constraint(answer, span, assumed):
    """An answer in the parameter's unit."""
    share = float(np.clip(span.share(max(assumed, span.lowest)), 0.0, 1.0))
    refused = answer.constrained and not answer.lower <= share <= answer.upper
    return {
        "told": answer.constrained,
        "chance": answer.chance,
        "best": float(span.value(answer.best)),
        "lower": float(span.value(answer.lower)) if answer.lower > 0.0 else None,
        "upper": float(span.value(answer.upper)) if answer.upper < 1.0 else None,
        "assumed_is_refused": bool(refused),
    }
