"""One block on a shaken slab: it stands still up to the acceleration g b/h, then rocks, then overturns.

``python examples/rocking_block.py`` (seconds). Housner (1963): a block of width b and height h starts to rock where the
ground's acceleration exceeds g b/h.
"""

import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

import blockshake

WIDTH, HEIGHT, GRAVITY = 0.6, 1.8, 9.81  # m, m, m/s2
FREQUENCY = 1.0  # Hz, of one cycle of sine
STRUCTURE = f"""
name: one-block
materials:
  concrete: {{density: 2400.0, youngs_modulus: 3.45e10, poisson_ratio: 0.2}}
shapes:
  slab:  {{box: [3.0, 3.0, 0.2]}}
  block: {{box: [{WIDTH}, 1.0, {HEIGHT}]}}
bodies:
  - {{name: slab,  shape: slab,  material: concrete, position: [0.0, 0.0, -0.1], driven: true}}
  - {{name: block, shape: block, material: concrete, position: [0.0, 0.0, {0.5 * HEIGHT}]}}
friction:
  - {{pair: [concrete, concrete], coefficient: 0.8}}
"""


def one_cycle(folder, amplitude):
    """A file with one cycle of sine after half a second of rest; acceleration in m/s2."""
    time = np.arange(0.0, 4.0, 0.005)
    phase = np.clip(time - 0.5, 0.0, 1.0 / FREQUENCY) * FREQUENCY
    path = folder / "motion.csv"
    table = {"time_s": time, "acceleration_x": amplitude * np.sin(2.0 * np.pi * phase)}
    pd.DataFrame(table).to_csv(path, index=False)
    return blockshake.load_motion(path)


def main():
    """Shake the block with growing amplitude and print a table."""
    threshold = GRAVITY * WIDTH / HEIGHT
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "one-block.yaml"
        file.write_text(STRUCTURE, encoding="utf-8")
        structure = blockshake.load_structure(file)
        for share in (0.95, 1.05, 1.2, 1.5):
            motion = one_cycle(Path(folder), share * threshold)
            run = blockshake.simulate(structure, motion, "nscd-rigid", duration=4.0)
            lean = 2.0 * np.arcsin(run["orientation"].sel(body="block", quaternion="y"))
            rows.append((share, float(np.degrees(np.abs(lean).max())), run.attrs["status"]))
    print(
        pd.DataFrame(rows, columns=["amplitude / (g b/h)", "largest rotation [deg]", "status"]).to_string(
            index=False
        )
    )


if __name__ == "__main__":
    main()
