"""Where a test's file says that markers and bodies started, held against the structure."""

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.sensors.markers import marker_position

_PLACE = 0.1  # m, of a marker off the structure's
# A block more than some 1 m off hangs over the edge of a slab 3 m wide; one twice as high as thick falls when it is
# tilted by atan(1/2) = 0.46 rad. Degrees lie beyond in all but small cases.
_LIMITS = {"initial_offset": (1.0, "m"), "initial_rotation": (0.5, "rad")}


def check_initial_places(test, structure, path):
    """Refuse markers that start elsewhere than in the structure, and offsets that no standing body has.

    Raises
    ------
    InputError
        Places off by more than 0.1 m, or in another order of the axes; an offset beyond 1 m; a rotation beyond
        0.5 rad.
    """
    _check_marker_places(test, structure, path)
    for name, (limit, unit) in _LIMITS.items():
        if name in test:
            size = np.abs(test[name].transpose("body", "axis").to_numpy())
            size = np.where(np.isfinite(size), size, 0.0).max(axis=1, initial=0.0)
            if size.max(initial=0.0) > limit:
                body = test["body"].values[int(size.argmax())]
                raise InputError(
                    path, f"{name}.{body}", f"expected at most {limit:g} {unit}, not {size.max():.3g}"
                )


def _check_marker_places(test, structure, path):
    if "marker_initial_position" not in test:
        return
    places = marker_position(structure, structure.position, structure.orientation)
    own = {marker.name: place for marker, place in zip(structure.file.markers, places, strict=True)}
    nominal = np.array([own[str(name)] for name in test["marker"].values])
    read = test["marker_initial_position"].transpose("marker", "axis").to_numpy()
    known = np.isfinite(read).any(axis=1)
    away = np.linalg.norm(np.nan_to_num(read - nominal), axis=1)[known]
    if not len(away) or away.max() < _PLACE:
        return
    for order in ((1, 0, 2), (2, 1, 0), (0, 2, 1), (1, 2, 0), (2, 0, 1)):
        if np.linalg.norm(read[:, order] - nominal, axis=1)[known].max() < _PLACE:
            swapped = ", ".join(AXES[place] for place in order)
            raise InputError(
                path,
                "axis",
                f"expected x, y, z; the markers start where the structure has them in the order {swapped}",
            )
    name = test["marker"].values[known][int(away.argmax())]
    raise InputError(
        path,
        f"marker_initial_position.{name}",
        f"expected it within {_PLACE:g} m of the structure's, not {away.max():.3g} m off",
    )
