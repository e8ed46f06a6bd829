import numpy as np
import pytest
import xarray as xr

from blockshake.diagnosis.misfit.residual_atlas import code_word, residual_atlas

TIME = np.arange(400) / 100.0
N_JOINTS = 3
QUIET, STRONG = (TIME > 0.2) & (TIME < 1.0), (TIME >= 1.2) & (TIME < 2.5)


def _histories(generator, scale=1.0, quiet=0.0, strong=(0.0, 0.0, 0.0), sides=(1.0, 1.0)):
    """One test: joints rock in the strong phase by 10 mrad more or less; extra rotation in units of 1 mrad."""
    wave = np.sin(2.0 * np.pi * 2.5 * TIME)
    sided = np.where(wave > 0.0, sides[0] * wave, sides[1] * wave)
    rotation = np.zeros((len(TIME), N_JOINTS))
    size = 0.01 * (1.0 + 0.05 * generator.normal()) * scale
    for joint in range(N_JOINTS):
        rotation[:, joint] = (
            STRONG * (size * wave + 1e-3 * strong[joint] * sided) + QUIET * 1e-3 * quiet * wave
        )
    rotation += generator.normal(0.0, 1e-4, rotation.shape)
    small = generator.normal(0.0, 1e-4, (len(TIME), N_JOINTS, 3))
    return xr.Dataset(
        {
            "slip": (("time", "joint"), small[..., 0]),
            "opening": (("time", "joint"), small[..., 2]),
            "rotation": (("time", "joint"), rotation),
            "acceleration": ("time", scale * wave * (QUIET | STRONG)),
            "phase": ("time", np.select([TIME < 1.2, TIME < 2.5], [0, 1], 2)),
        },
        {"time": TIME, "joint": ["slab-a", "a-b", "b-c"]},
    )


def _ensemble(generator, scale=1.0):
    return xr.concat([_histories(generator, scale) for _ in range(40)], "draw")


def _atlases(seed, scales, **extra):
    generator = np.random.default_rng(seed)
    law = extra.pop("law", lambda scale: 1.0)
    return [
        residual_atlas(
            _histories(
                generator, scale, quiet=law(scale) * extra.get("quiet", 0.0),
                strong=law(scale) * np.array(extra.get("strong", (0.0,) * 3)), sides=extra.get("sides", (1.0, 1.0)),
            ),
            _ensemble(generator, scale),
        )
        for scale in scales
    ]  # fmt: skip


def test_residuals_are_standardised():
    """Of a further member: mean 0, variance that of Student's t; 25 tests tell some 10 %."""
    residuals = np.array([_atlases(seed, [1.0])[0]["residual"].to_numpy() for seed in range(25)])
    assert abs(residuals.mean()) < 0.1
    assert residuals.std() == pytest.approx(np.sqrt(39 / 37), rel=0.15)


def test_nothing_missing_has_no_code_word_in_most_cases():
    """The limit allows one false cell in 20 tests."""
    words = [code_word(_atlases(100 + seed, [1.0])).phase for seed in range(25)]
    # 1.25 expected at 5 %, standard deviation 1.1
    assert words.count("none") >= 25 - 1.25 - 3 * 1.1


def test_a_residual_is_where_it_was_put():
    atlas = _atlases(1, [1.0], strong=(0.0, 5.0, 0.0))[0]
    place = abs(atlas["residual"]).argmax(...)
    assert str(atlas["joint"][place["joint"]].values) == "a-b"
    assert str(atlas["phase"][place["phase"]].values) == "strong"
    assert str(atlas["quantity"][place["quantity"]].values) == "rotation"
    cell = atlas.sel(joint="a-b", phase="strong", quantity="rotation", side="+")
    # half the time to that side and half the square of a sine: rms 1/2; members scatter by 5 %
    assert float(cell["measured"] - cell["mean"]) == pytest.approx(2.5e-3, abs=1e-3)
    assert float(cell["residual"]) > 0.0


@pytest.mark.parametrize(
    ("extra", "expected"),
    [
        ({"strong": (0.0, 5.0, 0.0)}, ("strong", "both", "one")),
        ({"strong": (5.0, 5.0, 5.0), "sides": (1.0, 0.0)}, ("strong", "one-sided", "even")),
        ({"strong": (2.0, 4.0, 6.0)}, ("strong", "both", "rising")),
        ({"strong": (6.0, 4.0, 2.0)}, ("strong", "both", "falling")),
        ({"quiet": 0.3}, ("quiet", "both", "even")),
    ],
)
def test_code_words(extra, expected):
    word = code_word(_atlases(3, [1.0], **extra))
    assert (word.phase, word.symmetry, word.profile) == expected
    assert word.quantity == "rotation"
    assert word.law == "unknown"


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (lambda scale: scale, "proportional"),
        (lambda scale: scale**3, "faster"),
        (lambda scale: 1.0, "slower"),
        (lambda scale: float(scale > 1.5), "threshold"),
    ],
)
def test_laws(law, expected):
    atlases = _atlases(4, [1.0, 1.4, 2.0], strong=(0.0, 0.0, 8.0), law=law)
    assert code_word(atlases).law == expected
    assert code_word(atlases[::-1]).law == expected
