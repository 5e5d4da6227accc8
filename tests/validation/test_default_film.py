"""The default film against a fine grid: any direction of the journal, L/D 0.25 to 2, eccentricity ratio 0.1 to 0.9.

Entries of K and C are relative, those below W/c in units of W/c. Aligned films repeat after one column, so that
sixteen directions within one column stand for all.
"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.static.equilibrium import whirl_threshold
from tests.sampling import sample

SPEED = 100.0
FINE = {0.25: (384, 48), 0.35: (384, 40), 0.5: (384, 32), 0.7: (384, 32), 1.0: (384, 32), 2.0: (384, 32)}
# Largest M c omega^2 / W of a rotor that is told to be stable or not.
HEAVIEST = 30.0
ECCENTRICITIES = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)

# K and C up to eps 0.8, K and C up to 0.9, whirl ratio, critical mass, load, peak pressure: what `FiniteLength` says.
LIMITS = (0.01, 0.01, 0.015, 0.015, 0.01, 0.02, 0.002, 0.005)
NAMES = ("K up to 0.8", "C up to 0.8", "K up to 0.9", "C up to 0.9", "whirl ratio", "critical mass", "load", "peak")


def film_at(model, eps, direction):
    """Load, peak pressure, K and C in the frame of the load, whirl ratio and critical mass in c omega^2 / W."""
    c = model.bearing.radial_clearance
    x, y = math.cos(direction), math.sin(direction)
    evaluation = model.evaluate(np.array([eps * c * x, eps * c * y, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, SPEED, 0.0]))
    force, tangent = evaluation.wrench[:2], evaluation.tangent()
    load = float(np.hypot(*force))
    turn = np.array([[-force[0], -force[1]], [force[1], -force[0]]]) / load
    stiffness, damping = turn @ -tangent[:2, :2] @ turn.T, turn @ -tangent[:2, 4:6] @ turn.T
    whirl, mass = whirl_threshold(stiffness, damping, SPEED)
    return SimpleNamespace(
        load=load,
        peak=evaluation.quantities()["peak_pressure"],
        k=stiffness * c / load,
        c=damping * SPEED * c / load,
        whirl=whirl,
        mass=mass * c * SPEED**2 / load,
    )


def _mean(films):
    return SimpleNamespace(**{key: np.mean([vars(film)[key] for film in films], axis=0) for key in vars(films[0])})


def _model(make_bearing, ratio, **options):
    return build_study_model(make_bearing(ratio, **options), 0.0)


def _in_units(found, true):
    """Largest error of entries, in W/c where they are smaller."""
    return float(np.max(np.abs(found - true) / np.maximum(1.0, np.abs(true))))


def worst_errors(model, fine, eccentricities=ECCENTRICITIES):
    """Largest errors over directions, in the order of ``NAMES``."""
    worst = dict.fromkeys(NAMES, 0.0)

    def note(name, error):
        worst[name] = max(worst[name], float(error))

    width, fine_width = (2.0 * math.pi / m.bearing.sized_film.n_theta for m in (model, fine))
    for eps in eccentricities:
        true = _mean([film_at(fine, eps, 0.1 + fine_width * k / 4) for k in range(4)])
        for k in range(16):
            found = film_at(model, eps, 0.1 + width * k / 16)
            reach = "0.8" if eps <= 0.8 else "0.9"
            note(f"K up to {reach}", _in_units(found.k, true.k))
            note(f"C up to {reach}", _in_units(found.c, true.c))
            note("load", abs(found.load / true.load - 1.0))
            note("peak", abs(found.peak / true.peak - 1.0))
            if true.mass < HEAVIEST:
                note("whirl ratio", abs(found.whirl / true.whirl - 1.0))
                note("critical mass", abs(found.mass / true.mass - 1.0))
    return worst


@pytest.mark.parametrize("ratio", sample(list(FINE), 2))
def test_figures_in_any_direction(make_bearing, measured, ratio):
    n_theta, n_z = FINE[ratio]
    fine = _model(make_bearing, ratio, film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z))
    found = worst_errors(_model(make_bearing, ratio), fine)
    for name, limit in zip(NAMES, LIMITS, strict=True):
        measured(f"L/D {ratio}: {name}", found[name], limit)


@pytest.mark.parametrize("eps", [0.5, 0.8])
def test_a_path_over_columns_is_smooth(make_bearing, measured, eps):
    """K and C while the line passes twenty columns, thirty states to each, against a fit without columns."""
    model = _model(make_bearing, 0.5)
    places = np.linspace(0.0, 20.0 * 2.0 * math.pi / 96, 601)
    films = [film_at(model, eps + 0.02 * place / places[-1], place) for place in places]
    for name in ("k", "c"):
        values = np.array([vars(film)[name].ravel() for film in films])
        fit = np.polynomial.chebyshev.Chebyshev
        smooth = np.array([fit.fit(places, column, 4)(places) for column in values.T]).T
        measured(name, float(np.max(np.abs(values - smooth) / np.maximum(1.0, np.abs(smooth)))), 0.01)


def test_on_vertices_the_place_of_a_column_shows(make_bearing):
    """The line inside the cells is needed: with it on the vertices K is off by several per cent in some directions."""
    fine = _model(make_bearing, 1.0, film=ehd.FiniteLength(n_theta=384, n_z=32))
    plain = _model(make_bearing, 1.0, cavitation=ehd.SwiftStieber(line_in_cells=False))
    found = worst_errors(plain, fine, (0.6, 0.8))
    assert 0.02 < found["K up to 0.8"] < 0.08
    assert 0.03 < found["C up to 0.8"] < 0.1
