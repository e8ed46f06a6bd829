"""Poses of one filmed body from the table of a user, as a test's file has them."""

import numpy as np
import pandas as pd

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.imports.read_readings import check_once, columns_of
from blockshake.measurement.poses.pose_file import ANGLE, QUATERNION, free_body


def posed_table(test, asked, structure, where):
    """Text of a CSV table with ``time_s`` and the columns of the free body; see `read_poses`.

    Parameters
    ----------
    test : ImportedTest
    asked : ImportMap
    structure : Structure
    where : str
        Map that an error names.

    Raises
    ------
    InputError
        A key that is no pose of the free body; faults of the table as of `columns_of`.
    """
    body = structure.body_names[free_body(structure)[0]]
    places = [f"{body}.{axis}" for axis in AXES]
    turns = [f"{body}.{ANGLE}", *(f"{body}.q{one}" for one in QUATERNION)]
    for key in asked.columns:
        if key not in (*places, *turns):
            raise InputError(where, f"columns.{key}", f"expected one of {', '.join((*places, *turns))}")
    check_once(asked.columns, asked, where)
    parts = []
    for names, kind in ((places, "displacement"), (turns, "rotation")):
        own = [name for name in names if name in asked.columns]
        if not own:
            raise InputError(where, "columns", f"expected a column of {body} among {', '.join(names)}")
        time, values = columns_of(test.file, own, asked, kind, where)
        parts.append(pd.DataFrame(values, columns=own))
    table = pd.concat(parts, axis=1)
    table.insert(0, "time_s", np.asarray(time))
    return table.to_csv(index=False)
