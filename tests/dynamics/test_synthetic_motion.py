import numpy as np
import pytest
from scipy.stats import kstest

from blockshake.dynamics.intensity import arias_intensity, motion_figures, response_spectrum
from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.synthetic_motion import (
    Envelope,
    close_integrals,
    end_of_motion,
    load_synthetic,
    source_shape,
    standard_normal,
    synthesise,
    taper_ends,
    target_acceleration,
    window,
)
from blockshake.errors import InputError
from blockshake.files import shipped

STANDARD_GRAVITY = 9.80665


@pytest.fixture(scope="module", params=["alkion", "basso-tirreno"])
def named(request):
    parameters = load_synthetic(shipped("motions", request.param))
    return parameters, synthesise(parameters)


def test_peak_acceleration_is_table_1(named):
    parameters, motion = named
    table_1 = {"alkion": 1.176, "basso-tirreno": 1.585}  # Zhou et al. (2023), m/s2
    assert motion_figures(motion)["peak_acceleration"] == pytest.approx(table_1[parameters.name], rel=1e-14)


def test_spectrum_follows_the_target(named):
    parameters, motion = named
    periods = np.geomspace(0.1, 2.5, 60)
    ratio = response_spectrum(motion, periods) / target_acceleration(parameters, periods)
    # the peak acceleration scales the record last, which leaves some per cent everywhere
    assert np.abs(np.log(ratio)).max() < 0.12
    assert abs(np.log(ratio).mean()) < 0.03


def test_alkion_has_the_published_ordinates():
    motion = synthesise(load_synthetic(shipped("motions", "alkion")))
    # Korinthos-OTE, in g; 4 % is far within the spread of a station's two horizontal components
    published = np.array([0.356, 0.272, 0.142]) * STANDARD_GRAVITY
    np.testing.assert_allclose(response_spectrum(motion, [0.3, 0.6, 1.0]), published, rtol=0.04)


def test_motion_starts_and_ends_at_rest_within_the_stroke_of_a_table(named):
    _, motion = named
    figures = motion_figures(motion)
    end = motion.table.breaks[-1:]
    assert abs(motion.evaluate(end, 1)[0, 0]) < 1e-12
    assert abs(figures["end_displacement"]) < 1e-12
    assert figures["peak_displacement"] < 0.1  # tables have some 0.5 m; 150 % must pass too
    assert abs(motion.evaluate(np.zeros(1), 2)[0, 0]) < 0.002 * figures["peak_acceleration"]


def test_strong_part_lies_in_the_first_twelve_seconds(named):
    _, motion = named
    figures = motion_figures(motion)
    arias = arias_intensity(motion)
    assert np.interp(12.0, motion.table.breaks, arias) > 0.9 * arias[-1]
    assert figures["significant_start"] < 2.0
    assert (
        8.0 < figures["significant_duration"] < 11.0
    )  # Bommer et al. (2009): 8 to 15 s, deviation 0.47 in ln


def test_same_seed_same_bytes_and_another_seed_another_record(named):
    parameters, motion = named
    assert (
        synthesise.__wrapped__(parameters).table.coefficients.tobytes() == motion.table.coefficients.tobytes()
    )
    other = synthesise(parameters.model_copy(update={"seed": parameters.seed + 1}))
    difference = other.evaluate(other.table.breaks, 2) - motion.evaluate(motion.table.breaks, 2)
    assert np.abs(difference).max() > 0.5 * parameters.peak_acceleration


def test_record_says_that_it_is_synthetic(named):
    _, motion = named
    assert motion.attributes["synthetic"] is True
    assert "synthetic" in motion.attributes["source"]
    assert "high-pass" in motion.attributes["baseline"]


def test_noise_is_standard_normal_and_a_known_stream():
    noise = standard_normal(7, 20000)
    assert kstest(noise, "norm").pvalue > 0.01
    # serial correlation of white noise: within 3.5 / sqrt(n)
    assert abs(np.mean(noise[:-1] * noise[1:])) < 3.5 / np.sqrt(20000)
    np.testing.assert_array_equal(noise[:100], standard_normal(7, 100))


def test_window_peaks_at_one_and_lasts_as_told():
    envelope = Envelope(significant_duration=6.0, peak=0.25, level=0.1)
    time = np.linspace(0.0, 60.0, 60001)
    shape = window(time, envelope)
    peak_time = time[shape.argmax()]
    assert shape.max() == pytest.approx(1.0, abs=1e-6)
    # Boore (2003): the level is reached where the peak stands at a quarter of the way
    assert np.interp(peak_time / 0.25, time, shape) == pytest.approx(0.1, rel=1e-3)
    motion = ground_motion("window", time, {"x": shape}, "acceleration")
    assert motion_figures(motion)["significant_duration"] == pytest.approx(6.0, rel=1e-3)


def test_source_has_brunes_corner_and_slopes():
    source = load_synthetic(shipped("motions", "alkion")).source
    # Brune in Boore's units: 4.9e6 beta[km/s] (stress[bar] / M0[dyne cm])^(1/3)
    corner = 4.9e6 * 3.5 * (100.0 / 10.0 ** (1.5 * 6.3 + 16.05)) ** (1.0 / 3.0)
    decay = np.exp(-np.pi * source.kappa * corner)
    assert source_shape(np.array([corner]), source)[0] == pytest.approx(corner**2 / 2.0 * decay, rel=1e-9)
    low = source_shape(np.array([0.001, 0.002]), source)
    assert low[1] / low[0] == pytest.approx(4.0, rel=1e-3)


def broken(tmp_path, old, new):
    text = shipped("motions", "alkion").read_text()
    assert old in text
    path = tmp_path / "motion.yaml"
    path.write_text(text.replace(old, new))
    return path


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("seed: ", "sed: ", "seed"),
        ("duration: 25.0", "colour: red\nduration: 25.0", "colour"),
        ("  kappa: 0.04", "  kappa: -0.04", "source.kappa"),
        ("synthetic: true", "synthetic: false", "synthetic"),
        ("{period: 0.1,", "{period: 0.01,", "target_spectrum in order"),
        ("duration: 25.0", "duration: 0.1", "100 to 200000 time steps"),
    ],
)
def test_wrong_parameters_are_named(tmp_path, old, new, key):
    path = broken(tmp_path, old, new)
    with pytest.raises(InputError, match=key) as caught:
        load_synthetic(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_end_of_motion_is_exact_for_a_ramp():
    # a = 3 t: v = 1.5 t^2, d = 0.5 t^3
    time = 0.01 * np.arange(401)
    velocity, displacement = end_of_motion(3.0 * time, 0.01)
    assert velocity == pytest.approx(24.0, rel=1e-12)
    assert displacement == pytest.approx(32.0, rel=1e-12)


def test_closing_removes_a_linear_acceleration_and_nothing_else():
    time = 0.01 * np.arange(2001)
    drift = 0.02 - 0.003 * time
    np.testing.assert_allclose(close_integrals(drift, 0.01), 0.0, atol=1e-13)


def test_taper_touches_two_percent_at_each_end():
    tapered = taper_ends(np.ones(1000))
    assert tapered[0] == 0.0
    assert tapered[-1] == 0.0
    np.testing.assert_array_equal(tapered[20:-20], 1.0)
    assert tapered[10] == pytest.approx(0.5)
