"""Joint forces of the measured tests: histories for the reader's eye, and the force from outside they ask for."""

import json

import numpy as np
import xarray as xr

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.diagnosis.laws.outside_force import outside_force
from blockshake.forces.joint_forces import gives_forces, joint_forces
from blockshake.forces.laws.closed_joint import pressed
from blockshake.forces.laws.friction import slipping
from blockshake.forces.laws.lever import bears_on_an_edge
from blockshake.forces.laws.table import table_readings
from blockshake.forces.laws.work import energy_taken
from blockshake.geometry.structure import load_structure
from blockshake.measurement.motion.outliers import without_outliers
from blockshake.parity.correction import load_corrected_test

LAWS = {"lever": bears_on_an_edge, "friction": slipping, "closed": pressed}


def measured_forces(campaign, names, findings):
    """Joint forces of open tests, their sensors' faults taken out.

    Parameters
    ----------
    campaign : Campaign
    names : sequence of str
        Of the tests.
    findings : sequence of Finding
        Sensor faults.

    Returns
    -------
    xarray.Dataset
        Along ``test`` and ``time``, single precision: ``lever``, ``lever_error``, ``normal`` and ``shear(joint)`` of
        the joints that are statically determinate [m, N], ``side(joint)``, the edge that bears, ``rotation(joint)``
        [rad], ``slip_rate(joint)`` [m/s], ``work(joint)``, the energy that it has taken [J], and
        ``unexplained(body)``, the least unexplained force along x [N]; ``told(joint, law)``, the instants that the laws
        of the lever, of friction and of the closed joint are read from; ``half_width(joint)`` [m] and
        ``coefficient(joint)`` of friction in the structure [1]; of the table ``table_rotation`` [rad],
        ``table_acceleration`` [m/s2] and ``table_moment`` [N m], see `table_readings`; ``read``, 1 at the
        test's own times. Attributes: ``outside``, an `OutsideForce` as JSON, or null, and ``weight`` of all free bodies
        [N]. Empty where the sensors give no forces.
    """
    structure = load_structure(campaign.structure)
    found = {}
    for name in names:
        test = without_outliers(load_corrected_test(campaign, name, structure, findings), structure)
        if gives_forces(test, structure, campaign.sensors):
            found[name] = joint_forces(test, structure, campaign.sensors)
    if not found:
        return xr.Dataset(attrs={"outside": json.dumps(None)})
    outside = outside_force(found)
    whole = xr.concat([_histories(one) for one in found.values()], dim="test", join="outer")
    text = json.dumps(outside.model_dump() if outside else None)
    weight = structure.mass[~structure.driven].sum() * np.linalg.norm(structure.file.gravity)
    return whole.assign_coords(test=list(found)).assign_attrs(outside=text, weight=float(weight))


def forces_of(forces, name):
    """Forces of one test of `measured_forces`, at its own times: another one may be read at another rate."""
    return forces.sel(test=name, drop=True).dropna("time", subset=["read"])


def outside_of(forces):
    """Force from outside that `measured_forces` found, or None."""
    found = json.loads(forces.attrs["outside"])
    return OutsideForce(**found) if found else None


def _histories(forces):
    """Histories of one test."""
    n_times, places = len(forces.motion.time), range(len(forces.transmitted.faces))
    joints = [forces.faces.index(face) for face in forces.transmitted.faces]
    free = np.flatnonzero(~forces.structure.driven)
    names = forces.structure.body_names
    columns = {
        "lever": forces.transmitted.lever,
        "lever_error": forces.transmitted.lever_error,
        "normal": forces.transmitted.normal,
        "shear": forces.transmitted.force[..., 0],
        "side": forces.joints.side[:, joints],
        "rotation": forces.joints.rotation[:, joints],
        "slip_rate": forces.joints.slip_rate[:, joints],
        "work": np.reshape([energy_taken(forces, place) for place in places], (len(places), n_times)).T,
    }
    told = [[law(forces, place) for law in LAWS.values()] for place in places]
    return xr.Dataset(
        {
            "read": ("time", np.ones(n_times, dtype=np.int8)),
            **{name: (("time", "joint"), values.astype(np.float32)) for name, values in columns.items()},
            "unexplained": (("time", "body"), forces.least.wrench[:, free, 0].astype(np.float32)),
            **{
                f"table_{name}": ("time", values.astype(np.float32))
                for name, values in zip(
                    ("rotation", "acceleration", "moment"), table_readings(forces), strict=True
                )
            },
            "told": (
                ("joint", "law", "time"),
                np.reshape(told, (len(places), len(LAWS), n_times)).astype(np.int8),
            ),
            "coefficient": ("joint", [face.friction for face in forces.transmitted.faces]),
            "half_width": ("joint", [face.half_width for face in forces.transmitted.faces]),
        },
        {
            "time": np.round(forces.motion.time, 6),
            "joint": [face.name for face in forces.transmitted.faces],
            "law": list(LAWS),
            "body": [names[body] for body in free],
        },
    )
