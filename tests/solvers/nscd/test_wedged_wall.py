"""A wall whose blocks lean on each other sideways: steps that Newton's method does not finish push nothing apart."""

from pathlib import Path

import pytest
import yaml

from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.structure import load_structure
from blockshake.simulation.simulate import simulate

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.slow
def test_energy_of_a_wedged_wall_is_explained(monkeypatch, tmp_path):
    """Nine blocks of the example rock and wedge; an answer of large self-stress gave them 6 kJ in one step."""
    monkeypatch.syspath_prepend(str(EXAMPLES))
    import own_wall

    (tmp_path / "wall.yaml").write_text(yaml.safe_dump(own_wall.wall()))
    (tmp_path / "own.at2").write_text(own_wall.record())
    wall, record = load_structure(tmp_path / "wall.yaml"), load_motion(tmp_path / "own.at2")
    run = simulate(wall, record, "nscd-rigid", duration=4.7, output_rate=200.0)
    assert run.attrs["status"] == "completed"
    assert run.attrs["numerics_capped_steps"] > 0
    assert run.attrs["numerics_max_residual"] < 2e-3
    assert run.attrs["energy_residual"] < 1e-5
