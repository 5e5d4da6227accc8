"""A free journal with all six coordinates under an off-centre load that swings around: every bush with every closure,
over load periods."""

from __future__ import annotations

import numpy as np
import pytest
from elastic_scene import CYLINDER, LOAD, STEEL, SWING, Scene, bearing
from scenes import settings

import exudyn_ehd as ehd

BUSHES = {
    "liner": ehd.ElasticLiner(thickness=0.02, youngs_modulus=2.1e11),
    "modal": ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.1),
    "nodal": ehd.ANCFBush(mesh=CYLINDER, material=STEEL),
}
CLOSURES = {
    "swift": ehd.SwiftStieber(),
    "gumbel": ehd.Gumbel(),
    "elrod": ehd.ElrodAdams(cavity_pressure=-1e5),
}
PAIRS = [(b, c) for b in BUSHES for c in CLOSURES]
STEPS = 100  # per period


@pytest.mark.slow
@pytest.mark.parametrize(("bush", "closure"), PAIRS)
def test_free_journal_tilts_and_settles_into_the_period_of_its_load(bush, closure):
    periods = 3
    scene = Scene(bearing(BUSHES[bush], cavitation=CLOSURES[closure]))
    end = periods * 2 * np.pi / SWING
    scene.run(settings(end, periods * STEPS, tolerance=1e-7), ehd.SolveDynamicSparse if bush == "nodal" else None)
    history = scene.joint.history
    # a rejected step is halved: none but with the mass conserving film, 5 to 7 % of whose steps are
    assert periods * STEPS < len(history.time) <= (1.1 if closure == "elrod" else 1.0) * periods * STEPS + 1
    assert np.allclose(history.time[-1], end)
    assert max(scene.cancelling) < 1e-11
    assert history.minimum_gap.min() > 0.0
    # a load 3 mm off the centre on a bearing of 66 mm tilts the journal
    last = history.time > end * (1.0 - 1.0 / periods)
    assert np.abs(history.motion[last, 2:4]).max() > 5e-5
    # over a period the film carries the mean load, apart from what is left of the transient
    mean = np.trapezoid(history.force[last, 1], history.time[last]) / np.ptp(history.time[last])
    assert mean == pytest.approx(LOAD, rel=0.02)
    if closure != "elrod":  # whose cavities take longer to fill and drain
        now, before = history.eccentricity[-STEPS:], history.eccentricity[-2 * STEPS : -STEPS]
        # the transient of the start has died away
        assert np.abs(now - before).max() < 0.04 * np.abs(now).max()
