"""Readable numpy twins of the finite-volume kernels, and their adjoint against the linear dependence on every gap."""

from __future__ import annotations

import numpy as np
import pytest

from exudyn_ehd.film.reynolds.balance import linear_residual, link_derivatives
from exudyn_ehd.film.reynolds.gap import Gradients, link_rows

CASES = [(1, False, 1.0), (2, True, 1.0), (3, False, 0.0)]


def _mean_z(H):
    return 0.5 * (H[:, :-1] + H[:, 1:])


def _pad(field):
    """One column of zeros behind the last row."""
    return np.hstack((field, np.zeros((field.shape[0], 1))))


def _residual(f, P, H=None, HF=None, H_t=None, vx=None, vz=None):
    """Net outflow plus storage of every control volume, written as fluxes through its four sides."""
    H = f.H if H is None else H
    HF = f.HF if HF is None else HF
    H_t = f.H_t if H_t is None else H_t
    vx, vz = (f.vx if vx is None else vx), (f.vz if vz is None else vz)
    linked = (f.mesh.link_x != 0.0)[:, None]
    qx = linked * vx * HF - f.flow_x * HF**3 * f.mesh.link_x[:, None] * (np.roll(P, -1, axis=0) - P)
    qx = qx * f.mesh.width_z
    hz = _mean_z(H)
    qz = (vz * hz - hz**3 * f.mesh.link_z * np.diff(P, axis=1)) * f.mesh.width_x[:, None]
    out = qx - np.roll(qx, 1, axis=0)
    out[:, :-1] += qz
    out[:, 1:] -= qz
    return out + H_t * np.outer(f.mesh.width_x, f.mesh.width_z)


@pytest.mark.parametrize(("seed", "cut", "flow_x"), CASES)
def test_coefficients(make_film, seed, cut, flow_x):
    f = make_film(seed, cut=cut, flow_x=flow_x)
    np.testing.assert_allclose(f.kx, flow_x * f.HF**3 * f.mesh.link_x[:, None] * f.mesh.width_z, rtol=1e-13)
    np.testing.assert_allclose(f.kz, _pad(_mean_z(f.H) ** 3 * f.mesh.link_z * f.mesh.width_x[:, None]), rtol=1e-13)
    linked = (f.mesh.link_x != 0.0)[:, None]
    np.testing.assert_allclose(f.fx, linked * f.vx * f.HF * f.mesh.width_z, rtol=1e-13)
    np.testing.assert_allclose(f.fz, _pad(f.vz * _mean_z(f.H) * f.mesh.width_x[:, None]), rtol=1e-13)


@pytest.mark.parametrize(("seed", "cut", "flow_x"), CASES)
def test_balance_is_the_sum_of_the_fluxes(make_film, dense_matrix, seed, cut, flow_x):
    f = make_film(seed, cut=cut, flow_x=flow_x)
    P = np.random.default_rng(seed).normal(size=f.H.shape)
    out = np.empty_like(P)
    linear_residual((f.kx, f.kz, f.b), P, out)
    np.testing.assert_allclose(-out, _residual(f, P), rtol=1e-11, atol=1e-12)
    dense = dense_matrix(f.kx, f.kz) @ P.ravel() - f.b.ravel()
    np.testing.assert_allclose(-out.ravel(), dense, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize(("seed", "cut", "flow_x"), CASES)
def test_conservation(make_film, seed, cut, flow_x):
    # What leaves one control volume enters the next: the sum over all is the storage, at any pressure.
    f = make_film(seed, cut=cut, flow_x=flow_x)
    P, out = np.random.default_rng(seed).normal(size=f.H.shape), np.empty_like(f.H)
    linear_residual((f.kx, f.kz, f.b), P, out)
    storage = (f.H_t * np.outer(f.mesh.width_x, f.mesh.width_z)).sum()
    assert -out.sum() == pytest.approx(storage, abs=1e-12 * abs(out).sum())


@pytest.mark.parametrize(("seed", "cut", "flow_x"), CASES)
def test_adjoint_sensitivities(make_film, seed, cut, flow_x):
    f = make_film(seed, n=7, m=5, cut=cut, flow_x=flow_x)
    rng = np.random.default_rng(seed)
    P, lam = rng.normal(size=f.H.shape), rng.normal(size=(2, *f.H.shape))
    by, by_speed, rows, places = *(np.empty((k, P.size)) for k in (4, 3, 10)), np.arange(P.size)
    up = np.ones((2, P.size))
    link_derivatives(P, f.H, f.HF, None, up, None, f.metric, f.vx, f.vz, by, by_speed)
    link_rows(places, P.size, P.shape[1], by, by_speed, None, np.zeros((2, *P.shape)), rows)
    cell, face, _, speed = Gradients(places, places, rows).fields(lam.reshape(2, -1), f.H.shape)
    step = 1e-5  # the residual is cubic in the gap: central differences leave step^2 = 1e-10 and rounding 1e-10
    for k in range(2):
        for i, j in np.ndindex(f.H.shape):
            d = np.zeros_like(f.H)
            d[i, j] = step
            for out, plus, minus in (
                (cell, _residual(f, P, H=f.H + d), _residual(f, P, H=f.H - d)),
                (face, _residual(f, P, HF=f.HF + d), _residual(f, P, HF=f.HF - d)),
            ):
                expected = -(lam[k] * (plus - minus)).sum() / (2.0 * step)
                assert out[k, i, j] == pytest.approx(expected, rel=1e-7, abs=1e-7)
        for s, name in enumerate(("vx", "vz")):
            plus, minus = _residual(f, P, **{name: 1.0}), _residual(f, P, **{name: 0.0})
            assert speed[k, s] == pytest.approx(-(lam[k] * (plus - minus)).sum(), rel=1e-11)
