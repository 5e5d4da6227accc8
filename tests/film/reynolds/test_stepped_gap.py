"""Links of stepped gaps."""

import numpy as np

from exudyn_ehd.film.reynolds.gap import stepped_links


def test_twin():
    """Two halves of constant gap in series, written out with the pressure on the face."""
    H = np.random.default_rng(1).uniform(0.2, 2.0, (5, 4))
    gx, cx, gz, cz = (np.zeros(H.shape) for _ in range(4))
    stepped_links(H, gx, cx, gz, cz)
    for i in range(5):
        for j in range(4):
            for other, g, c in (((i + 1) % 5, j), gx, cx), ((i, j + 1), gz, cz):
                if other[1] > 3:
                    continue
                a, b = H[i, j], H[other]
                for V, drop in ((1.0, 0.0), (0.0, 1.0), (0.7, -0.3)):
                    # Unknowns q and the face pressure pf, p1 = 0, p2 = drop, unit distance.
                    q, _ = np.linalg.solve([[1.0, 2.0 * a**3], [1.0, -2.0 * b**3]], [V * a, V * b - 2.0 * b**3 * drop])
                    assert abs(q - (V * c[i, j] - g[i, j] * drop)) < 1e-13


def test_equal_gaps_give_the_plain_coefficients():
    H = np.full((3, 3), 0.8)
    gx, cx, gz, cz = (np.zeros(H.shape) for _ in range(4))
    stepped_links(H, gx, cx, gz, cz)
    np.testing.assert_allclose(gx, 0.8**3, rtol=1e-15)
    np.testing.assert_allclose(cx, 0.8, rtol=1e-15)
    np.testing.assert_allclose(gz[:, :-1], 0.8**3, rtol=1e-15)
    np.testing.assert_allclose(cz[:, :-1], 0.8, rtol=1e-15)
