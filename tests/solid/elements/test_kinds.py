"""Contracts of the elements: shape functions, quadratures, faces."""

from itertools import product
from math import factorial, prod

import numpy as np
import pytest

from exudyn_ehd.solid.elements.element import (
    ELEMENTS,
    FLAT_TRIANGLE,
    GAUSS8,
    GAUSS27,
    HAMMER4,
    HEX20,
    IRONS14,
    QUADRILATERAL,
    TET10,
    TRIANGLE,
    WALKINGTON14,
    face_of,
)

ROUNDING = 1e-13  # sums of 20 products of order one
NAMES = [element.fem for element in ELEMENTS]


def inside(element):
    """Random points of the element."""
    points = np.random.default_rng(1).uniform(element.nodes.min(), 1, (60, 3))
    return points[element.outside(points) < 0]


@pytest.mark.parametrize("element", ELEMENTS, ids=NAMES)
def test_shape_functions_are_one_at_their_own_node_and_interpolate_every_quadratic_polynomial(element):
    points = inside(element)
    assert np.allclose(element.shapes(element.nodes)[0], np.eye(element.size), atol=ROUNDING)
    value, gradient = element.shapes(points)
    assert len(points) > 5
    assert np.allclose(gradient.sum(axis=1), 0, atol=ROUNDING)
    for powers in (p for p in product(range(3), repeat=3) if sum(p) <= 2):
        at_nodes = np.prod(element.nodes**powers, axis=1)
        assert np.allclose(value @ at_nodes, np.prod(points**powers, axis=1), atol=ROUNDING)


@pytest.mark.parametrize("element", ELEMENTS, ids=NAMES)
def test_gradients_agree_with_central_differences(element):
    step, points = 1e-5, inside(element)
    for i in range(3):
        change = step * np.eye(3)[i]
        slope = (element.shapes(points + change)[0] - element.shapes(points - change)[0]) / (2 * step)
        # the difference quotient of a polynomial of degree four errs by step^2 and by rounding / step, both 1e-10
        assert np.allclose(element.shapes(points)[1][:, :, i], slope, atol=1e-9)


@pytest.mark.parametrize("rule", [GAUSS27, IRONS14, GAUSS8, HAMMER4, WALKINGTON14])
def test_quadrature_integrates_every_monomial_of_its_degree(rule):
    on_cube = HEX20.accepts(rule)
    assert on_cube != TET10.accepts(rule)
    for powers in product(range(rule.degree + 1), repeat=3):
        if sum(powers) > rule.degree:
            continue
        if on_cube:
            exact = np.prod([0 if p % 2 else 2 / (p + 1) for p in powers])
        else:
            exact = prod(factorial(p) for p in powers) / factorial(3 + sum(powers))
        assert rule.weights @ np.prod(rule.points**powers, axis=1) == pytest.approx(exact, abs=ROUNDING)


@pytest.mark.parametrize("element", ELEMENTS, ids=NAMES)
def test_faces_are_the_traces_of_the_element_and_point_outward(element):
    kind, middle = face_of(element.faces), element.nodes.mean(axis=0)
    weights, value, gradient = kind.rule
    flux = 0.0
    for face in element.faces:
        on_face = value @ element.nodes[face]
        normal = np.cross(*np.einsum("qar,ai->rqi", gradient, element.nodes[face]))
        assert np.allclose(element.outside(on_face), 0.0, atol=ROUNDING)
        assert np.all(np.einsum("qi,qi->q", normal, on_face - middle) > 0)
        assert np.allclose(element.shapes(on_face)[0][:, face], value, atol=ROUNDING)
        flux += weights @ np.einsum("qi,qi->q", normal, on_face)
    # divergence theorem
    assert flux == pytest.approx(3 * element.exact.weights.sum(), rel=1e-13)


@pytest.mark.parametrize("face", [QUADRILATERAL, TRIANGLE, FLAT_TRIANGLE])
def test_a_face_knows_its_nodes_outline_triangles_and_area(face):
    assert np.allclose(face.shapes(face.nodes)[0], np.eye(len(face.nodes)), atol=ROUNDING)
    assert face_of(np.zeros((1, len(face.nodes)))) is face
    area = 4.0 if face.corners == 4 else 0.5
    points, weights = face.gauss(4)
    assert weights.sum() == pytest.approx(area, rel=1e-14)
    assert face.outside(points).max() < 0 <= face.outside(1.01 * face.nodes).max()
    if face.corners == 3:
        for i, j in (p for p in product(range(7), repeat=2) if sum(p) <= 6):
            exact = factorial(i) * factorial(j) / factorial(2 + i + j)
            assert weights @ (points[:, 0] ** i * points[:, 1] ** j) == pytest.approx(exact, abs=ROUNDING)
    a, b, c = face.nodes[face.triangles].transpose(1, 0, 2)
    # counter-clockwise, as the normal has it
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    assert np.all(turn > 0)
    assert 0.5 * turn.sum() == pytest.approx(area, rel=1e-14)
    x, y = face.nodes[face.outline].T
    assert 0.5 * (x[:-1] * y[1:] - x[1:] * y[:-1]).sum() == pytest.approx(area, rel=1e-14)


@pytest.mark.parametrize("element", ELEMENTS, ids=NAMES)
def test_edges_carry_their_middle_node(element):
    ends, middle = element.edges[:, :2], element.edges[:, 2]
    assert np.allclose(element.nodes[ends].mean(axis=1), element.nodes[middle], atol=0)


@pytest.mark.parametrize("element", ELEMENTS, ids=NAMES)
def test_extrapolation_of_a_linear_field_is_exact(element):
    field = np.array([0.3, -1.1, 0.7])
    assert np.allclose(element.extrapolation @ (element.sampling.points @ field), element.nodes @ field, atol=ROUNDING)
