"""Tables as text, HTML, CSV and data frames."""

import re
import sys
import types

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.tables import Table


class Small(Table):
    def _columns(self):
        return {"speed": np.array([1.0, 2.0]), "cost": np.array([0.5, np.nan])}

    def _units(self):
        return {"cost": "EUR"}

    def _remarks(self):
        return {"error": ("", "a < b")}


def test_table_in_every_form(tmp_path, monkeypatch):
    table = Small()
    assert str(table).splitlines()[0].split() == ["speed", "[rad/s]", "cost", "[EUR]"]
    assert str(table).splitlines()[2].endswith("nan  a < b")
    text = table._repr_html_()
    assert "<th>cost [EUR]</th><th>error</th>" in text and "<td>a &lt; b</td>" in text and text.count("<tr>") == 3
    table.to_csv(tmp_path / "table.csv")
    assert (tmp_path / "table.csv").read_text().splitlines()[0] == "speed [rad/s],cost [EUR],error"
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ehd.InputError, match="pip install pandas"):
        table.to_dataframe()
    monkeypatch.setitem(sys.modules, "pandas", types.SimpleNamespace(DataFrame=dict))
    assert list(table.to_dataframe()) == ["speed", "cost", "error"]


def test_print_is_in_engineers_units_and_all_else_in_si(tmp_path):
    one = np.ones(1)
    given = {
        "minimum_gap": 4.1e-6 * one,
        "radial_clearance": 2e-5 * one,
        "journal_radius": 0.01 * one,
        "peak_pressure": 24.6e6 * one,
        "mean_leakage": 1.5e-6 * one,
        "peak_angle": np.pi * one,
        "minimum_gap_time": 0.02 * one,
        "viscosity": 0.04 * one,
        "count": 3 * one,
    }

    class Given(Table):
        def _columns(self):
            return given

    head, row = (re.split(r"\s{2,}", text.strip()) for text in str(Given()).splitlines())
    assert dict(zip(head, map(float, row), strict=True)) == {
        "minimum_gap [um]": 4.1,
        "radial_clearance [um]": 20.0,
        "journal_radius [mm]": 10.0,
        "peak_pressure [MPa]": 24.6,
        "mean_leakage [l/min]": 0.09,
        "peak_angle [deg]": 180.0,
        "minimum_gap_time [s]": 0.02,
        "viscosity [Pa s]": 0.04,
        "count": 3.0,
    }
    assert "<th>peak_pressure [MPa]</th>" in Given()._repr_html_()
    Given().to_csv(tmp_path / "table.csv")
    head, row = (tmp_path / "table.csv").read_text().splitlines()
    assert head.startswith("minimum_gap [m],radial_clearance [m]") and float(row.split(",")[3]) == 24.6e6


def line(parameters):
    return {"minimum_gap": 1e-6 * parameters["speed"] * parameters.get("size", 1.0)}


def test_studies_draw_their_columns():
    study = ehd.parameter_study(line, {"speed": [3.0, 1.0, 2.0], "size": [1.0, 2.0]}, show_progress=False)
    ax = study.plot("minimum_gap").axes[0]
    assert ax.get_xlabel() == "speed [rad/s]" and ax.get_ylabel() == "minimum film thickness [µm]"
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["size = 1", "size = 2"]
    np.testing.assert_allclose(ax.lines[1].get_xydata(), [[1.0, 2.0], [2.0, 4.0], [3.0, 6.0]])
    other = study.plot("minimum_gap", along="size").axes[0]
    np.testing.assert_allclose(other.lines[0].get_xydata(), [[1.0, 3.0], [2.0, 6.0]])
    assert other.lines[0].get_label() == "speed = 3 rad/s"
    with pytest.raises(ehd.InputError, match="name must be one of speed, size, minimum_gap, seconds"):
        study.plot("gap")
    many = ehd.parameter_study(line, {"speed": [1.0], "size": list(range(11))}, show_progress=False)
    with pytest.raises(ehd.InputError, match="11 curves"):
        many.plot("minimum_gap")
    assert "<td>" in many._repr_html_()
