"""Kernels of the energy equation against readable twins."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.factors import number_cells
from exudyn_ehd.film.banded.workspace import PAD, assemble
from exudyn_ehd.film.heat.energy import content_rate, film_flows, film_heat, outside_flows, transport_slopes

SHAPE = (8, 5)


@pytest.fixture
def fields():
    rng = np.random.default_rng(6)
    names = ("P", "q", "kx", "kz", "fx", "fz", "fill", "storage", "rate")
    out = {name: rng.uniform(0.1, 1.0, SHAPE) for name in names}
    out["fx"] -= 0.5
    out["fz"] -= 0.5
    return out


def links(shape):
    n, m = shape
    for i in range(n):
        for j in range(m):
            yield "x", (i, j), ((i + 1) % n, j)
            if j + 1 < m:
                yield "z", (i, j), (i, j + 1)


def on_links(f, name):
    """Values (2, n, m) on the links; none behind the last row."""
    out = np.array((f[name + "x"], f[name + "z"]))
    out[1, :, -1] = 0.0
    return out


def test_heat(fields):
    f = fields
    heat, twin = film_heat(f["P"], f["q"], on_links(f, "k")), np.zeros(SHAPE)
    for kind, a, b in links(SHAPE):
        w = f["k" + kind][a] * (f["q"][a] - f["q"][b]) * (f["P"][a] - f["P"][b])
        twin[a] += 0.5 * w
        twin[b] += 0.5 * w
    np.testing.assert_allclose(heat, twin, rtol=1e-13)


def test_flows_take_the_fill_from_upstream(fields):
    f = fields
    flow = {"x": np.zeros(SHAPE), "z": np.zeros(SHAPE)}
    source = np.zeros(SHAPE)
    for kind, a, b in links(SHAPE):
        couette = f["f" + kind][a]
        flow[kind][a] = f["k" + kind][a] * (f["q"][a] - f["q"][b]) + couette * f["fill"][a if couette >= 0.0 else b]
        source[a] += flow[kind][a]
        source[b] -= flow[kind][a]
    (qx, qz), leaving = film_flows(f["q"], f["fill"], on_links(f, "k"), on_links(f, "f"))
    np.testing.assert_allclose(qx, flow["x"], rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(qz, flow["z"], rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(leaving, source, rtol=1e-12, atol=1e-14)


def test_outside_flows_are_the_balance_of_fixed_vertices(fields):
    """An end next to a ruptured film passes the link's flow alone."""
    f = fields
    (_, qz), leaving = film_flows(f["q"], f["fill"], on_links(f, "k"), on_links(f, "f"))
    source = f["storage"] * f["rate"] + leaving
    fixed = np.zeros(SHAPE, dtype=np.bool_)
    fixed[:, [0, -1]] = fixed[2, :] = True
    unbroken = np.random.default_rng(7).random(SHAPE) > 0.4
    for (i, j), value in np.ndenumerate(outside_flows(qz, source, fixed, unbroken)):
        twin = source[i, j] if fixed[i, j] else 0.0
        if j == 0 and not unbroken[i, 1]:
            twin = qz[i, 0]
        if j == SHAPE[1] - 1 and not unbroken[i, -2]:
            twin = -qz[i, -2]
        assert value == pytest.approx(twin, rel=1e-12, abs=1e-14)


def test_content_rate(fields):
    H, H_t, fill, old = (fields[k] for k in ("kx", "fx", "fill", "q"))
    for inverse_step, squeeze, twin in (
        (5.0, True, (fill * H - old) * 5.0),
        (0.0, True, fill * H_t),
        (0.0, False, 0.0 * H),
    ):
        found = content_rate(H, H_t, fill, old, inverse_step, squeeze)
        np.testing.assert_allclose(found, twin, rtol=1e-14, atol=1e-15)


def twin_weight(slopes, k, flow):
    """Weight downstream on the link k with these slopes: a half, or ``2 r / (1 + r)^2`` up to r = 1."""
    up = k - 1 if flow > 0.0 else k + 1
    if flow == 0.0 or not 0 <= up < len(slopes):
        return 0.0
    r = slopes[up] / slopes[k]
    return 0.0 if r <= 0.0 else 2.0 * min(r, 1.0) / (1.0 + min(r, 1.0)) ** 2


@pytest.mark.parametrize("held", [0.0, 0.2, np.inf])
def test_band_is_the_matrix_of_the_balance(fields, held):
    """By the limiter in theta and z, of no more flow than a step holds; one link in theta is missing."""
    n, m = SHAPE
    number, order = np.zeros(SHAPE, dtype=np.int64), np.zeros(n * m, dtype=np.int64)
    _, width = number_cells(np.ones(SHAPE, dtype=np.bool_), np.ones(SHAPE), order, number)
    lower, upper = np.zeros((2, n * m, width + 1 + PAD))
    # nothing flows over the links at the end
    fields["fz"][:, -1] = 0.0
    z, T, slopes = np.array([0.0, 0.1, 0.4, 0.6, 1.0]), np.cumsum(fields["P"], axis=1), np.empty((5, n * m))
    T[2:4] = fields["q"][2:4]
    lengths = 1.0 / (0.3 + 0.1 * np.arange(n)), 1.0 / np.diff(z)
    lengths[0][4], fields["fx"][4] = 0.0, 0.0
    transport_slopes(fields["fx"], fields["fz"], fields["storage"], T, lengths, np.full(SHAPE, held), slopes)
    assemble(np.ones(SHAPE), fields["fz"], slopes, number, order, n * m, lower, upper)
    band = np.zeros((n * m, n * m))
    for r in range(n * m):
        for d in range(width + 1):
            if r + d < n * m:
                band[r, r + d] += upper[r, d]
                if d:
                    band[r + d, r] += lower[r, d]
    twin, weights = np.zeros((n * m, n * m)), []
    for at, value in np.ndenumerate(fields["storage"]):
        twin[number[at], number[at]] += value
    for kind, a, b in links(SHAPE):
        flow = fields["f" + kind][a]
        up, down = (number[a], number[b]) if flow >= 0.0 else (number[b], number[a])
        twin[down, down] += abs(flow)
        twin[down, up] -= abs(flow)
        if kind == "z":
            weights.append(twin_weight(np.diff(T[a[0]]) / np.diff(z), a[1], flow))
        else:
            around = lengths[0] * (np.roll(T[:, a[1]], -1) - T[:, a[1]])
            # the link before the first one is the last one
            weights.append(twin_weight(np.roll(around, 1 - a[0]), 1, flow))
        share = weights[-1] * min(abs(flow), held)
        twin[up, down] += share
        twin[up, up] -= share
        twin[down, down] -= share
        twin[down, up] += share
    np.testing.assert_allclose(band, twin, rtol=1e-14, atol=1e-15)
    # every branch of the limiter
    assert {0.0, 0.5} < set(weights)
    # what a link carries leaves one vertex and reaches the other
    gone = fields["storage"].copy()
    for kind, a, b in links(SHAPE):
        gone[a] -= fields["f" + kind][a]
        gone[b] += fields["f" + kind][a]
    np.testing.assert_allclose(band.sum(axis=0)[number], gone, rtol=1e-12, atol=1e-13)
