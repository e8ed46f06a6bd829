"""The transform that tames the heavy tails of features, so that Gaussian methods apply."""

import numpy as np

from blockshake.diagnosis.features.feature_table import kind


def signed_log(values):
    """Features, with their coordinate, on a scale that is linear near zero and logarithmic far from it.

    sign(x) ln(1 + |x| / scale) with the scale of the feature table [1]; as they are where it has none.
    """
    scale = np.array([kind(str(name)).scale for name in values["feature"].values])
    scale = values["feature"].copy(data=scale).reset_coords(drop=True)
    logarithm = np.sign(values) * np.log1p(abs(values) / scale.where(scale > 0.0, 1.0))
    return logarithm.where(scale > 0.0, values)
