"""Base-excited chains of masses: motions, exact poles, and files as a test would have them."""

import numpy as np
import xarray as xr
from scipy.signal import cont2discrete, dlsim

FINE, SKIP = 2000.0, 10  # Hz of the integration; every tenth value is read, at 200 Hz


def white(seed, duration, rms, highest=80.0, lowest=0.3):
    """Acceleration with a flat spectrum in a band and the displacement it integrates to, periodic, at FINE."""
    n = round(duration * FINE)
    frequency = np.fft.rfftfreq(n, 1.0 / FINE)
    generator = np.random.default_rng(seed)
    lines = generator.normal(size=len(frequency)) + 1j * generator.normal(size=len(frequency))
    lines *= (frequency > lowest) & (frequency < highest)
    lines *= rms / np.fft.irfft(lines, n).std()
    moved = np.zeros_like(lines)
    moved[1:] = -lines[1:] / (2.0 * np.pi * frequency[1:]) ** 2
    return np.fft.irfft(lines, n), np.fft.irfft(moved, n)


def stiffness(springs):
    """Stiffness matrix of masses in a row, the first spring to the base."""
    n = len(springs)
    matrix = np.zeros((n, n))
    for place, spring in enumerate(springs):
        matrix[place, place] += spring
        if place:
            matrix[place - 1, place - 1] += spring
            matrix[place - 1, place] -= spring
            matrix[place, place - 1] -= spring
    return matrix


def system(mass, K, C):
    """State matrix of displacement and velocity relative to the base, and the base's acceleration's column."""
    n = len(mass)
    inverse = np.diag(1.0 / np.asarray(mass))
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ C]])
    return A, np.r_[np.zeros(n), -np.ones(n)][:, None]


def exact(A):
    """Frequency [Hz], damping ratio and complex shape of every mode: eigenvalues of the state matrix."""
    poles, vectors = np.linalg.eig(A)
    kept = np.flatnonzero(poles.imag > 0.0)
    kept = kept[np.argsort(np.abs(poles[kept]))]
    shapes = vectors[: len(A) // 2, kept].T
    largest = shapes[np.arange(len(kept)), np.abs(shapes).argmax(axis=1)]
    return np.abs(poles[kept]) / 2 / np.pi, -poles[kept].real / np.abs(poles[kept]), shapes / largest[:, None]


def states(A, B, acceleration, rate=FINE):
    """Displacements and velocities relative to the base, from rest, acceleration linear between its values."""
    n = len(A)
    discrete = cont2discrete((A, B, np.eye(n), np.zeros((n, 1))), 1.0 / rate, "foh")
    return dlsim((*discrete[:4], 1.0 / rate), acceleration)[1]


def answer(A, B, acceleration):
    """Displacements relative to the base."""
    return states(A, B, acceleration)[:, : len(A) // 2]


def reading(displacement, relative, noise, seed):
    """Test file's content at 200 Hz: slab marker, then the masses' markers, moving along x, with noise [m]."""
    x = np.column_stack([displacement, displacement[:, None] + relative])[::SKIP]
    values = np.zeros((*x.shape, 3))
    values[:, :, 0] = x
    values += np.random.default_rng([seed, 1]).normal(0.0, 1.0, values.shape) * noise
    names = ["slab-face", *(f"mass-{place}" for place in range(relative.shape[1]))]
    return xr.Dataset(
        {"marker_displacement": (("time", "marker", "axis"), values)},
        {"time": np.arange(len(x)) * SKIP / FINE, "marker": names, "axis": ["x", "y", "z"]},
    )
