"""Exudyn sensors that read a joint."""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.record.element import Element
from exudyn_ehd.coupling.record.history import Quantity, column

_SIZE = {Quantity.MOTION: 10, Quantity.ECCENTRICITY: 2, Quantity.FORCE: 3, Quantity.MOMENT: 3}


def add_sensor(
    mbs: exu.MainSystem, element: Element, quantity: Quantity, name: str, file_name: str, write_to_file: bool
) -> Index:
    """Add a sensor of one quantity; its values are stored in the sensor.

    The sensor looks at the state Exudyn shows it, which after an accepted step is exactly the state the record gets, so
    that both agree bit for bit. Where the film can't be evaluated, it gives nan.
    """
    size = _SIZE.get(quantity, 1)

    def read(
        mbs: exu.MainSystem,
        t: float,
        sensorNumbers: list[int],
        factors: list[float],
        configuration: exu.ConfigurationType,
    ) -> list[float]:
        element.require_items(mbs)
        row = element.current_row(mbs)
        values = np.full(size, np.nan) if row is None else column(row, quantity)
        return values.tolist()

    return mbs.AddSensor(
        eii.SensorUserFunction(
            name=name,
            sensorNumbers=[],
            factors=[],
            sensorUserFunction=read,
            storeInternal=True,
            fileName=file_name,
            writeToFile=write_to_file,
        )
    )
