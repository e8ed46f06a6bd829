"""What a candidate adds to the features, as a function of its size: a Gaussian process fitted to paired runs."""

import warnings
from dataclasses import dataclass

import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, DotProduct, WhiteKernel


@dataclass(frozen=True)
class Response:
    """Mean and standard deviation of what is added, at some sizes.

    Attributes
    ----------
    sizes : float64 array, shape (n_sizes,)
        In units of the visible size.
    mean, deviation : float64 arrays, shape (n_sizes, n_features)
        In units of the features' spread. The deviation holds what the fit does not know and by how much the effect
        adds more in one nominal model than in another.
    """

    sizes: np.ndarray
    mean: np.ndarray
    deviation: np.ndarray


def fit_response(own_sizes, added, sizes):
    """Response of all features to a candidate's size.

    Parameters
    ----------
    own_sizes : float64 array, shape (n_draws,)
        Of the library's runs.
    added : float64 array, shape (n_draws, n_features)
        To the nominal run of the same draw.
    sizes : float64 array, shape (n_sizes,)
        Where it is asked for.

    Returns
    -------
    Response

    Notes
    -----
    Gaussian process (Rasmussen and Williams 2006) with the kernel ``u u' exp(-(u - u')^2 / 2 l^2)``, so that nothing
    is added at the null size, and white noise; one length and one noise for all features, each in units of its own
    root mean square, by the largest likelihood.
    """
    scale = np.sqrt((added**2).mean(axis=0))
    scale = np.where(scale > 0.0, scale, 1.0)
    kernel = ConstantKernel(1.0) * DotProduct(0.0, "fixed") * RBF(1.0, (0.1, 10.0)) + WhiteKernel(
        0.1, (1e-6, 10.0)
    )
    process = GaussianProcessRegressor(kernel, normalize_y=False)
    with warnings.catch_warnings():
        # a bound of a kernel's parameter reached is an answer: a response that is straight, or without scatter
        warnings.simplefilter("ignore", ConvergenceWarning)
        process.fit(own_sizes[:, None], added / scale)
    mean, deviation = process.predict(np.asarray(sizes)[:, None], return_std=True)
    if deviation.ndim == 1:
        deviation = np.repeat(deviation[:, None], added.shape[1], axis=1)
    return Response(np.asarray(sizes), mean.reshape(len(sizes), -1) * scale, deviation * scale)
