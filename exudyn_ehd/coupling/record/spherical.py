"""Rows of a ball joint, with what errors of its steps are known from."""

from __future__ import annotations

import dataclasses

import numpy as np

from exudyn_ehd.coupling.record.history import FIRST_BLOCK, LOAD, JointHistory
from exudyn_ehd.coupling.record.record import Record, history_of
from exudyn_ehd.joint.step_error import errors_of_ball

# Where rows have what `pack_of_ball` keeps.
PACK = slice(FIRST_BLOCK, FIRST_BLOCK + 15)


class BallRecord(Record):
    """Rows of a ball, which know the stiffness and the damping of three translations."""

    def snapshot(self, final: np.ndarray | None) -> JointHistory:
        """The record, with ``final`` as its last row if given."""
        rows = self._all_rows(final)
        history = history_of(rows, self._dimensions, lags=False)
        packed, load = rows.behind[:, PACK], rows.behind[:, LOAD]
        place, velocity, _ = np.split(history.motion[:, :9], 3, axis=1)
        clearance = self._dimensions["radial_clearance"]
        errors = errors_of_ball(history.time, place, velocity, packed, history.minimum_gap, clearance, load)
        return dataclasses.replace(history, step_error=errors)
