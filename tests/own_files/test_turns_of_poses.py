"""Poses whose rotations do not fit their places, or whose places are not the structure's: refused or remarked."""

import numpy as np
import pandas as pd
import pytest
import yaml
from scipy.spatial.transform import Rotation

from blockshake.cli import main
from blockshake.measurement.campaigns.campaign import load_campaign, load_test

TIME = np.arange(400) / 100
MOVING = (TIME > 1.0) * np.sin(2.0 * np.pi * TIME)
PITCH = {"low": 0.01 * MOVING, "high": 0.03 * MOVING}  # rad about +y
NAMES = ("table", "low", "high")
PARTS = ("x", "y", "z", "qw", "qx", "qy", "qz")
STRUCTURE = """\
name: column
materials: {c: {density: 2400, youngs_modulus: 3.0e10, poisson_ratio: 0.2}}
shapes: {b: {box: [0.4, 0.4, 0.6]}, s: {box: [3, 1, 0.2]}}
bodies:
  - {name: table, shape: s, material: c, position: [0, 0, -0.1], driven: true}
  - {name: low, shape: b, material: c, position: [0, 0, 0.3]}
  - {name: high, shape: b, material: c, position: [0, 0, 0.9]}
friction: [{pair: [c, c], coefficient: 0.6}]
markers:
  - {name: s1, body: table, position: [0, -0.5, 0]}
  - {name: l1, body: low, position: [0.2, 0, 0]}
  - {name: h1, body: high, position: [0.2, 0, 0.1]}
"""


def filmed(folder):
    """Poses of two blocks that turn about the middles of their feet, 0.1 mm and 0.1 mrad of noise."""
    (folder / "column.yaml").write_text(STRUCTURE)
    moved = 0.02 * MOVING
    rows = [f"{t},{x:.8f}" for t, x in zip(TIME, moved, strict=True)]
    (folder / "command.csv").write_text("\n".join(["time_s,displacement_x", *rows]) + "\n")
    generator, columns = np.random.default_rng(1), {"t": TIME}
    foot = np.column_stack([moved, 0 * TIME, 0 * TIME])
    up, columns_of = np.array([0.0, 0.0, 0.6]), {}
    columns_of["table"] = foot - [0, 0, 0.1], Rotation.identity(len(TIME))
    for name in ("low", "high"):
        turn = Rotation.from_rotvec(np.outer(PITCH[name], [0, 1, 0]))
        columns_of[name], foot = (foot + turn.apply(up / 2), turn), foot + turn.apply(up)
    for name, (place, turn) in columns_of.items():
        noise = generator.normal(0.0, 1e-4, (2, len(TIME), 3))
        quaternion = (Rotation.from_rotvec(noise[1]) * turn).as_quat(scalar_first=True)
        values = np.column_stack([place + noise[0] + [5.0, 2.0, 1.0], quaternion])
        columns |= {f"{name}-{part}": values[:, number] for number, part in enumerate(PARTS)}
    return pd.DataFrame(columns)


def imported(folder, table, capsys, mapped=None, **settings):
    """Exit code, and what was printed."""
    table.to_csv(folder / "take.csv", index=False)
    whole = {f"{name}.{part}": f"{name}-{part}" for name in NAMES for part in PARTS}
    mapping = {
        "name": "take", "structure": "column.yaml", "time": "t", "displacement_unit": "m",
        "columns": whole if mapped is None else mapped, **settings,
        "tests": [{"name": "t1", "file": "take.csv", "motion": "command.csv", "scale": 1.0, "role": "fit"}],
    }  # fmt: skip
    (folder / "map.yaml").write_text(yaml.safe_dump(mapping))
    code = main(["import-campaign", str(folder / "map.yaml"), "--output", str(folder / "made")])
    printed = capsys.readouterr()
    return code, printed.out + printed.err


def assert_true(folder):
    """The side marker falls by its arm, 0.2 m, times the pitch."""
    test = load_test(load_campaign(folder / "made"), "t1")["marker_displacement"]
    np.testing.assert_allclose(test.sel(marker="l1", axis="z"), -0.2 * PITCH["low"], atol=8e-4)


def test_poses_as_they_are_make_no_remark(tmp_path, capsys):
    code, printed = imported(tmp_path, filmed(tmp_path), capsys)
    assert code == 0, printed
    assert "no inconsistency found" in printed
    assert_true(tmp_path)


def conjugated(table, *names):
    return table.assign(**{f"{name}-q{axis}": -table[f"{name}-q{axis}"] for name in names for axis in "xyz"})


def test_quaternions_of_the_world_in_the_body_are_refused_and_have_a_key(tmp_path, capsys):
    table = conjugated(filmed(tmp_path), *NAMES)
    code, printed = imported(tmp_path, table, capsys)
    assert code == 2
    assert "map.yaml: quaternion: expected world-to-body; low leans one way while its centroid" in printed
    code, printed = imported(tmp_path, table, capsys, quaternion="world-to-body")
    assert code == 0, printed
    assert_true(tmp_path)


def test_the_key_on_quaternions_that_are_right_is_refused(tmp_path, capsys):
    code, printed = imported(tmp_path, filmed(tmp_path), capsys, quaternion="world-to-body")
    assert code == 2
    assert "quaternion: expected body-to-world" in printed


def test_one_body_alone_that_leans_the_other_way_is_named(tmp_path, capsys):
    code, printed = imported(tmp_path, conjugated(filmed(tmp_path), "high"), capsys)
    assert code == 2
    assert "columns.high.q" in printed
    assert "reversed" in printed


def test_a_scalar_part_that_comes_last_is_named(tmp_path, capsys):
    table = filmed(tmp_path)
    order = dict(zip(PARTS[3:], ("qx", "qy", "qz", "qw"), strict=True))  # the file's columns are x, y, z, w
    mapped = {f"{name}.{part}": f"{name}-{order.get(part, part)}" for name in NAMES for part in PARTS}
    renamed = table.rename(columns=lambda name: name.replace("q", "part-") if "q" in name else name)
    mapped = {key: one.replace("q", "part-") for key, one in mapped.items()}
    code, printed = imported(tmp_path, renamed, capsys, mapped)
    assert code == 2
    assert "columns.high.qw: expected it as in the structure; it begins turned by 180 deg" in printed
    assert "'high-part-w' looks like the scalar part" in printed


def test_parts_of_the_vector_in_another_order_are_named(tmp_path, capsys):
    """No letter of a name shows the axis; y was mapped to x, and x to y."""
    table = filmed(tmp_path).set_axis([f"n{one}" for one in range(22)], axis=1)
    mapped = {
        f"{name}.{part}": f"n{1 + 7 * body + number}"
        for body, name in enumerate(NAMES)
        for number, part in enumerate(PARTS)
    }
    for name in NAMES:
        mapped[f"{name}.qx"], mapped[f"{name}.qy"] = mapped[f"{name}.qy"], mapped[f"{name}.qx"]
    code, printed = imported(tmp_path, table, capsys, mapped, time="n0")
    assert code == 2
    assert "columns.low.qy: expected 'n13', by its motion" in printed


def in_the_plane(table, factor=1.0):
    """Angles about y in place of quaternions."""
    angles = {
        f"{name}-a": factor * 2.0 * np.arcsin(table[f"{name}-qy"]) * np.sign(table[f"{name}-qw"])
        for name in NAMES
    }
    mapped = {f"{name}.{axis}": f"{name}-{axis}" for name in NAMES for axis in "xz"}
    return table.assign(**angles), mapped | {f"{name}.angle_y": f"{name}-a" for name in NAMES}


def test_angles_of_the_other_sign_are_refused(tmp_path, capsys):
    table, mapped = in_the_plane(filmed(tmp_path), -1.0)
    code, printed = imported(tmp_path, table, capsys, mapped)
    assert code == 2
    assert "columns.low.angle_y: expected it reversed; low leans one way" in printed
    turned = {
        key: {"column": one, "reversed": True} if "angle" in key else one for key, one in mapped.items()
    }
    code, printed = imported(tmp_path, table, capsys, turned)
    assert code == 0, printed
    assert_true(tmp_path)


@pytest.mark.parametrize(("factor", "unit"), [(180.0 / np.pi, "deg"), (1e3, "mrad")])
def test_angles_in_another_unit_are_refused(factor, unit, tmp_path, capsys):
    table, mapped = in_the_plane(filmed(tmp_path), factor)
    code, printed = imported(tmp_path, table, capsys, mapped)
    assert code == 2
    assert f"rotation_unit: expected {unit}, by which blocks turn about their feet" in printed
    code, printed = imported(tmp_path, table, capsys, mapped, rotation_unit=unit)
    assert code == 0, printed
    assert_true(tmp_path)


def test_blocks_that_slide_and_do_not_turn_are_taken(tmp_path, capsys):
    table = filmed(tmp_path)
    table["high-x"] += 0.05 * (TIME > 2.0) * (TIME - 2.0)
    code, printed = imported(tmp_path, table, capsys)
    assert code == 0, printed


def test_bodies_that_stand_in_the_others_place_are_remarked(tmp_path, capsys):
    table = filmed(tmp_path)
    names = {one: one.replace("low", "high") if "low" in one else one.replace("high", "low") for one in table}
    code, printed = imported(tmp_path, table.rename(columns=names), capsys)
    assert code == 0, printed
    assert "high and low stand where the structure has the other one: are they exchanged?" in printed


def test_poses_of_another_point_than_the_centroid_are_remarked(tmp_path, capsys):
    table = filmed(tmp_path)
    for name in ("low", "high"):  # of the middles of their feet
        table[f"{name}-z"] -= 0.3
    code, printed = imported(tmp_path, table, capsys)
    assert code == 0, printed
    assert "table stands 0.00, 0.00, 0.30 m (x, y, z) off its place in the structure" in printed
