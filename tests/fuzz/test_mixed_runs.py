"""Four to nine effects over cycles of load on every kind of bore: runs with the usual settings come to their end."""

import numpy as np
import pytest

from tests.fuzz import mixed_runs

SEEDS = {
    "rigid": range(10),
    "liner": range(4),
    "modal": range(3),
    "nodal": range(1),
    "tilted": range(2),
    "body": range(1),
}


@pytest.mark.slow
# profiles are drawn without regard to the coarse grids
@pytest.mark.filterwarnings("ignore:.* it departs from a straight line .*:UserWarning")
@pytest.mark.parametrize(("kind", "seed"), [(kind, seed) for kind, seeds in SEEDS.items() for seed in seeds])
def test_mixed_runs(kind, seed):
    scene = mixed_runs.draw(seed, kind)
    out = mixed_runs.run(scene, 0.5 * mixed_runs.CYCLES[kind])
    assert out.error is None, f"{mixed_runs.words(scene)}: {out.error}"
    if out.rows >= 4.0:
        # steps too long for a film between soft surfaces that touch: four times as many are not halved
        out = mixed_runs.run(scene, 0.5 * mixed_runs.CYCLES[kind], finer=4)
        assert out.rows < 1.1
    assert out.smallest > 1e-3
    for name in ("minimum_gap", "peak_pressure", "force", "power_loss"):
        assert np.all(np.isfinite(getattr(out.history, name))), name
    assert "OverloadWarning" not in out.warned
