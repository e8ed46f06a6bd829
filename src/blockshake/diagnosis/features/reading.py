"""Features and histories of a test. Measured and simulated tests are read off by the same function."""

import numpy as np

from blockshake.diagnosis.features.features import features
from blockshake.diagnosis.features.phases import PHASES, find_phases
from blockshake.diagnosis.laws.law_reading import NO_LAWS, law_values
from blockshake.measurement.motion.joint_histories import joint_histories
from blockshake.measurement.motion.outliers import without_outliers
from blockshake.measurement.motion.reconstructed_base import reconstruct_base

HISTORIES = ("slip", "rotation", "opening", "drift")


def read_off(test, structure, sensors, laws=True):
    """Features, histories and laws of a test.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file; one that ended early is judged until then.
    structure : Structure
        The campaign's, for a simulated test too, whatever was varied in it.
    sensors : Sensors
        Of the campaign.
    laws : bool
        Whether the laws of the joints are read too, which takes most of the time.

    Returns
    -------
    xarray.Dataset
        ``value``, ``censored`` and ``error(feature)`` as from `features`; along the direction of shaking and in single
        precision ``slip``, ``opening(time, joint)`` [m], ``rotation(time, joint)`` [rad] and ``drift(time, body)``
        [m], the displacement against the table; ``acceleration(time)`` of the base [m/s2]; ``phase(time)``, number in
        `PHASES`; ``law_value`` and ``law_error(law)`` as from `read_laws`, empty without laws.
    """
    known = test["marker_displacement"].notnull().any(("marker", "axis")).to_numpy()
    ended = len(known) - int(np.argmax(known[::-1])) if known.any() else 0
    whole = test.isel(time=slice(ended))
    if "time_acc" in whole.dims:
        whole = whole.isel(time_acc=whole["time_acc"].to_numpy() <= whole["time"].to_numpy()[-1])
    whole = without_outliers(whole, structure)
    histories = joint_histories(whole, structure, sensors, reconstruct_base(whole, structure, sensors))
    moved = {
        "slip": histories["slip"].sel(tangent="x", drop=True),
        "rotation": histories["rotation"].sel(axis="y", drop=True),
        "opening": histories["opening"],
        "drift": histories["body_displacement"].sel(axis="x", drop=True),
        "acceleration": histories["acceleration"],
    }
    phases = find_phases(histories)
    number = sum(place * phases.mask(name) for place, name in enumerate(PHASES))
    kept = {name: values.astype(np.float32) for name, values in moved.items()}
    kept["phase"] = (
        "time",
        number.astype(np.int8),
        {"flag_values": [0, 1, 2], "flag_meanings": " ".join(PHASES)},
    )
    read = law_values(whole, structure, sensors) if laws else NO_LAWS
    return features(histories).assign(kept).merge(read)
