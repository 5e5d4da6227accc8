"""Contracts of the 20-node hexahedron and of its quadratures."""

from itertools import product

import numpy as np
import pytest

from exudyn_ehd.solid.hex20 import (
    EDGES,
    FACE_NODES,
    FACES,
    GAUSS8,
    GAUSS27,
    IRONS14,
    NODES,
    face_gauss,
    face_shapes,
    shape_functions,
    shape_gradients,
)

ROUNDING = 1e-13  # sums of 20 products of order one
RANDOM = np.random.default_rng(1).uniform(-1, 1, (30, 3))


def test_shape_functions_are_one_at_their_own_node_and_zero_at_the_others():
    assert np.allclose(shape_functions(NODES), np.eye(20), atol=ROUNDING)


def test_shape_functions_sum_to_one_and_their_gradients_to_zero():
    assert np.allclose(shape_functions(RANDOM).sum(axis=1), 1, atol=ROUNDING)
    assert np.allclose(shape_gradients(RANDOM).sum(axis=1), 0, atol=ROUNDING)


@pytest.mark.parametrize("powers", [p for p in product(range(3), repeat=3) if sum(p) <= 2])
def test_every_quadratic_polynomial_is_interpolated_exactly(powers):
    values = np.prod(NODES**powers, axis=1)
    assert np.allclose(shape_functions(RANDOM) @ values, np.prod(RANDOM**powers, axis=1), atol=ROUNDING)


def test_gradients_agree_with_central_differences():
    step = 1e-5
    for i in range(3):
        change = step * np.eye(3)[i]
        slope = (shape_functions(RANDOM + change) - shape_functions(RANDOM - change)) / (2 * step)
        # the difference quotient of a polynomial of degree four errs by step^2 and by rounding / step, both 1e-10
        assert np.allclose(shape_gradients(RANDOM)[:, :, i], slope, atol=1e-9)


@pytest.mark.parametrize("rule", [GAUSS27, IRONS14, GAUSS8])
def test_quadrature_integrates_every_monomial_of_its_degree(rule):
    for powers in product(range(rule.degree + 1), repeat=3):
        if sum(powers) > rule.degree:
            continue
        exact = np.prod([0 if p % 2 else 2 / (p + 1) for p in powers])
        assert rule.weights @ np.prod(rule.points**powers, axis=1) == pytest.approx(exact, abs=ROUNDING)


def test_faces_are_the_traces_of_the_element_and_point_outward():
    points, _ = face_gauss(3)
    value, gradient = face_shapes(points)
    for side, face in enumerate(FACES):
        on_face = value @ NODES[face]
        normal = np.cross(*np.einsum("qar,ai->rqi", gradient, NODES[face]))
        axis, sign = side // 2, 2 * (side % 2) - 1
        assert np.allclose(on_face[:, axis], sign, atol=ROUNDING)
        assert np.allclose(normal, sign * np.eye(3)[axis], atol=ROUNDING)
        assert np.allclose(shape_functions(on_face)[:, face], value, atol=ROUNDING)
    assert np.allclose(face_shapes(FACE_NODES)[0], np.eye(8), atol=ROUNDING)


def test_edges_carry_their_middle_node():
    assert np.allclose(NODES[EDGES[:, :2]].mean(axis=1), NODES[EDGES[:, 2]], atol=0)
