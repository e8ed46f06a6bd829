"""Input that no deformable model can run: one line each."""

import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.simulation.models import MODELS, split_parameters
from blockshake.simulation.simulate import simulate


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("materials.concrete.youngs_modulus", 0.0, "greater than or equal to 1"),
        ("materials.concrete.poisson_ratio", 0.5, "less than 0.5"),
        ("materials.concrete.viscous_modulus", -1.0, "greater than or equal to 0"),
        ("nscd_deformable.mesh_size", 0.0, "greater than 0"),
        ("nscd_deformable.elastic_theta", 0.4, "greater than or equal to 0.5"),
        ("nscd_deformable.shrink", 0.1, "expected one of"),
    ],
)
def test_a_value_out_of_range_is_one_line(key, value, words):
    with pytest.raises(InputError, match=words) as raised:
        simulate("configuration-1", "alkion", "nscd-elastic", {key: value}, duration=0.01)
    assert "\n" not in str(raised.value)


def test_a_mesh_is_refused(tmp_path, stone):
    import trimesh

    trimesh.creation.icosahedron().export(tmp_path / "ball.stl")
    (tmp_path / "ball.yaml").write_text(
        "name: ball\n"
        "materials: {stone: {density: 2400.0, youngs_modulus: 3.45e10, poisson_ratio: 0.2, viscous_modulus: 1.5e8}}\n"
        "shapes: {slab: {box: [3.0, 3.0, 0.2]}, ball: {mesh: ball.stl}}\n"
        "bodies:\n"
        "  - {name: slab, shape: slab, material: stone, position: [0, 0, -0.1], driven: true}\n"
        "  - {name: ball, shape: ball, material: stone, position: [0, 0, 2.0]}\n"
        "friction: [{pair: [stone, stone], coefficient: 0.5}]\n",
        encoding="utf-8",
    )
    with pytest.raises(InputError, match=r"shapes.ball: expected a box"):
        simulate(tmp_path / "ball.yaml", "alkion", "nscd-viscoelastic", duration=0.01)


def test_a_mesh_too_fine_to_factor_is_refused(stone):
    with pytest.raises(InputError, match="mesh_size"):
        simulate(
            "configuration-1", "alkion", "nscd-elastic", {"nscd_deformable.mesh_size": 0.01}, duration=0.01
        )


def test_a_viscous_modulus_far_beyond_the_step_still_rests(stone, tower, deform):
    """A thousand times the paper's: implicit, so that nothing blows up."""
    run = deform(
        stone(tower(1), viscous_modulus=1.5e11), 0.02, viscous=True, mesh_size=0.4, contact_spacing=0.8
    )
    assert run.status == "completed"
    assert np.abs(run.velocity).max() < 1e-9


def test_both_models_share_their_parameters():
    assert MODELS["nscd-elastic"].schema is MODELS["nscd-viscoelastic"].schema
    _, numerical = split_parameters({"nscd_deformable.modes": 3}, "nscd-viscoelastic")
    assert numerical.modes == 3
