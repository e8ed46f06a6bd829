"""One step of the elastic coordinates: implicit, each by itself, so that its law is known in closed form."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import inline_kernel, inner_kernel, kernel, kernel_without_allocation
from blockshake.solvers.nscd_deformable.elastic_bodies import shapes_of


class ElasticResponse(NamedTuple):
    """How the elastic coordinates answer impulses over a step of one length.

    ``dt`` [s]; ``theta`` [1]; ``admittance`` (n_shapes,): rate per modal impulse [1]. ``first_entry`` int64
    (n_bodies + 1,), ``compliance`` (n_entries,): velocity of each body's points, all of them or those of `at_anchors`,
    per impulse at them [1/kg], rows and columns ``3 point + axis``, body frame.
    """

    dt: float
    theta: float
    admittance: np.ndarray
    first_entry: np.ndarray
    compliance: np.ndarray


@kernel
def step_response(elastic, dt, theta):
    """Response over steps of a length.

    Notes
    -----
    ``rate' = rate - h (omega^2 amplitude_theta + damping rate_theta) + impulse`` with ``amplitude' = amplitude +
    h rate_theta`` gives ``rate' (1 + theta^2 h^2 omega^2 + theta h damping) = ... + impulse``.
    """
    n_bodies = elastic.first_shape.size - 1
    w, d = elastic.squared_frequency, elastic.damping
    admittance = 1.0 / (1.0 + theta * theta * dt * dt * w + theta * dt * d)
    first_entry = np.zeros(n_bodies + 1, np.int64)
    for body in range(n_bodies):
        rows = 3 * (elastic.first_point[body + 1] - elastic.first_point[body])
        first_entry[body + 1] = first_entry[body] + rows * rows
    compliance = np.empty(first_entry[n_bodies])
    for body in range(n_bodies):
        if first_entry[body + 1] > first_entry[body]:
            shapes = shapes_of(elastic, body)
            admittances = admittance[elastic.first_shape[body] : elastic.first_shape[body + 1]]
            answer = np.dot(shapes * admittances, np.ascontiguousarray(shapes.T))
            compliance[first_entry[body] : first_entry[body + 1]] = answer.ravel()
    return ElasticResponse(dt, theta, admittance, first_entry, compliance)


@inner_kernel
def at_anchors(elastic, response, anchors):
    """The response with the compliance of the points alone that carry contact."""
    n_bodies = anchors.first.size - 1
    first_entry = np.zeros(n_bodies + 1, np.int64)
    for body in range(n_bodies):
        rows = 3 * (anchors.first[body + 1] - anchors.first[body])
        first_entry[body + 1] = first_entry[body] + rows * rows
    compliance = np.empty(first_entry[n_bodies])
    _compliance_into(elastic, response, anchors, compliance)
    return ElasticResponse(response.dt, response.theta, response.admittance, first_entry, compliance)


@kernel_without_allocation
def _compliance_into(elastic, response, anchors, compliance):
    count = 0
    for body in range(anchors.first.size - 1):
        active = anchors.active[anchors.first[body] : anchors.first[body + 1]]
        C, first = compliance_of(elastic.first_point, response, body), elastic.first_point[body]
        for source in active:
            for axis in range(3):
                row = C[3 * (source - first) + axis]
                for point in active:
                    at = 3 * (point - first)
                    compliance[count], compliance[count + 1], compliance[count + 2] = (
                        row[at],
                        row[at + 1],
                        row[at + 2],
                    )
                    count += 3


@inline_kernel
def compliance_of(first_point, response, body):
    """Velocity per impulse of one body's points: float64 array, shape (3 n_points, 3 n_points), a view.

    ``first_point`` int64 (n_bodies + 1,): where the points of each body begin.
    """
    rows = 3 * (first_point[body + 1] - first_point[body])
    first, last = response.first_entry[body], response.first_entry[body + 1]
    return response.compliance[first:last].reshape(rows, rows)


@kernel_without_allocation
def predict_elastic_into(elastic, response, deformation, amplitude, rate):
    """Elastic coordinates at which contacts are found, and rates at the end of the step without contact.

    ``amplitude`` and ``rate`` (n_shapes,) are overwritten.
    """
    dt, theta = response.dt, response.theta
    for shape in range(amplitude.size):
        q, v = deformation.amplitude[shape], deformation.rate[shape]
        w, d = elastic.squared_frequency[shape], elastic.damping[shape]
        amplitude[shape] = q + (1.0 - theta) * dt * v
        pull = dt * (w * (q + theta * (1.0 - theta) * dt * v) + (1.0 - theta) * d * v)
        rate[shape] = response.admittance[shape] * (v - pull)


@kernel_without_allocation
def points_into(elastic, coordinates, anchors, points):
    """Displacements, or velocities, of the lattice's points that carry contact, body frames.

    ``coordinates`` (n_shapes,): amplitudes or rates. ``points`` (n_active, 3), those of ``anchors`` (Anchors), are
    overwritten.
    """
    for body in range(elastic.first_shape.size - 1):
        shapes, first = shapes_of(elastic, body), elastic.first_point[body]
        values = coordinates[elastic.first_shape[body] : elastic.first_shape[body + 1]]
        for entry in range(anchors.first[body], anchors.first[body + 1]):
            point = anchors.active[entry]
            for axis in range(3):
                points[entry, axis] = _dot(shapes[3 * (point - first) + axis], values)


@kernel_without_allocation
def _dot(x, y):
    """``x`` times ``y`` in four sums that are added in a fixed order."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    n = x.size
    last = n - n % 4
    for i in range(0, last, 4):
        a += x[i] * y[i]
        b += x[i + 1] * y[i + 1]
        c += x[i + 2] * y[i + 2]
        d += x[i + 3] * y[i + 3]
    for i in range(last, n):
        a += x[i] * y[i]
    return (a + b) + (c + d)


@kernel_without_allocation
def _move_elastic_into(elastic, response, anchors, forces, rate, deformation, pushes):
    """`move_elastic_into` with an array (n_shapes,) to work in."""
    for body in range(elastic.first_shape.size - 1):
        shapes = shapes_of(elastic, body)
        first, low, high = elastic.first_point[body], elastic.first_shape[body], elastic.first_shape[body + 1]
        push = pushes[low:high]
        push[:] = 0.0
        for entry in range(anchors.first[body], anchors.first[body + 1]):
            point = anchors.active[entry]
            for axis in range(3):
                force, row = forces[entry, axis], shapes[3 * (point - first) + axis]
                if force != 0.0:
                    for shape in range(push.size):
                        push[shape] += force * row[shape]
        for shape in range(push.size):
            rate[low + shape] += response.admittance[low + shape] * push[shape]
    dt, theta = response.dt, response.theta
    viscous, algorithmic = 0.0, 0.0
    for shape in range(rate.size):
        old, new = deformation.rate[shape], rate[shape]
        mean = (1.0 - theta) * old + theta * new
        change = dt * mean
        viscous += dt * elastic.damping[shape] * mean * mean
        algorithmic += (new - old) * (new - old) + elastic.squared_frequency[shape] * change * change
        deformation.amplitude[shape] += change
        deformation.rate[shape] = new
    deformation.lost[0] += (theta - 0.5) * algorithmic
    return viscous + (theta - 0.5) * algorithmic


@inner_kernel
def move_elastic_into(elastic, response, anchors, forces, rate, deformation):
    """Elastic coordinates at the end of the step; the energy that viscosity and the scheme took is returned [J].

    Parameters
    ----------
    elastic, response, anchors : Elastic, ElasticResponse, Anchors
    forces : float64 array, shape (n_active, 3)
        Impulses on the points that carry contact, body frames [N s].
    rate : float64 array, shape (n_shapes,)
        At the end of the step without contact; overwritten with those with it.
    deformation : Deformation
        Changed in place.

    Notes
    -----
    With rates and amplitudes weighted by theta the work of an impulse is ``impulse rate_theta``, the viscosity takes
    ``h damping rate_theta^2`` and the scheme ``(theta - 1/2) (change of rate^2 + omega^2 change of amplitude^2)``:
    these add up to the change of the elastic and kinetic energy exactly. Neither loss is below zero.
    """
    return _move_elastic_into(elastic, response, anchors, forces, rate, deformation, np.empty(rate.size))


@kernel_without_allocation
def elastic_energy(elastic, deformation):
    """Kinetic and strain energy of the elastic coordinates [J]."""
    kinetic, strain = 0.0, 0.0
    for shape in range(deformation.rate.size):
        kinetic += 0.5 * deformation.rate[shape] ** 2
        strain += 0.5 * elastic.squared_frequency[shape] * deformation.amplitude[shape] ** 2
    return kinetic, strain
