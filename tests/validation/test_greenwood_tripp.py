"""Asperity contact against a table of the exact integrals F_n of Greenwood and Tripp (own quadrature, seven digits)."""

import csv
from pathlib import Path

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.film.surfaces.roughness import AsperityContact, greenwood_tripp_integral

with open(Path(__file__).parent / "data" / "greenwood_tripp_F_functions.csv", encoding="utf-8") as _file:
    ROWS = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(_file)]
U = np.array([row["H=h/sigma"] for row in ROWS])
CLEARANCE, SIGMA = 20e-6, 0.5e-6


def test_kernel_gives_the_exact_integral():
    """Printed with seven digits: 5e-7 relative at worst, and the kernel's own 6e-7."""
    spec = ehd.GreenwoodTripp(composite_roughness=SIGMA, composite_modulus=1e11)
    H = U[None] * SIGMA / CLEARANCE
    P = np.empty(H.shape)
    AsperityContact(spec, CLEARANCE).pressure(H, P, np.empty(H.shape))
    np.testing.assert_allclose(P[0] / spec.pressure_scale, [row["F5_2_exact"] for row in ROWS], rtol=1.2e-6)


def test_integrals_of_every_order():
    """The last printed digit of the smallest entries is 7e-7 relative."""
    for order, column in ((0.0, "F0_exact"), (1.0, "F1_exact"), (2.0, "F2_exact"), (2.5, "F5_2_exact")):
        np.testing.assert_allclose(greenwood_tripp_integral(order, U), [row[column] for row in ROWS], rtol=8e-7)


def test_the_power_fit_is_not_used():
    """The common fit is 10.7 % low at u = 0."""
    assert abs(4.4086e-5 * 4.0**6.804 / greenwood_tripp_integral(2.5, 0.0) - 0.8926665) < 1e-4
