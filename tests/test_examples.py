"""Every example runs headless in its quick mode and gives the figures that it is there to show."""

import pytest


def test_slider_crank(example, tmp_path):
    rows = example("slider_crank").main(quick=True, output=tmp_path)
    assert (tmp_path / "mechanism.png").stat().st_size > 10_000
    assert (tmp_path / "bearing.png").stat().st_size > 10_000
    play, real = rows["literature"], rows["realistic"]
    # the slider leaves the ideal path by about the clearance where there is play, by less than e where there is a film
    assert play["largest_slider_deviation_um"] == pytest.approx(500, rel=0.1)
    assert real["largest_slider_deviation_um"] < 20 * real["largest_eccentricity_ratio"] * 1.1
    # the inertia force of the slider at the outer dead centre: m w^2 (r + r^2 / l) = 2719 N
    assert real["largest_pin_force_N"] == pytest.approx(0.14 * 523.6**2 * 0.05 * (1 + 0.05 / 0.12), rel=2e-3)
    # play is felt as peaks in force and driving moment
    assert play["largest_pin_force_N"] > 1.01 * real["largest_pin_force_N"]
    assert play["largest_crank_moment_Nm"] > 1.15 * real["largest_crank_moment_Nm"]
    assert play["largest_eccentricity_ratio"] > 0.98
    assert real["minimum_gap_um"] == pytest.approx(8.4, abs=0.3)


def test_rotating_journal(example, tmp_path):
    cases = example("rotating_journal").main(quick=True, results=tmp_path)
    assert all(path.stat().st_size > 10_000 for path in cases.pop("pictures"))
    for closure in ("Gumbel", "mass conserving"):
        for name in ("aligned", "tilted"):
            rigid, steel = cases[closure, name, "rigid"], cases[closure, name, "steel, modal"]
            # the paper's conclusion: flexibility widens the film and lowers the peak
            assert steel["peak_MPa"] < 0.95 * rigid["peak_MPa"]
            assert steel["extent_deg"] >= rigid["extent_deg"]
            assert steel["minimum_gap_um"] > rigid["minimum_gap_um"]
    # Gumbel drops the linear film's suction: symmetric to rounding when aligned
    assert cases["Gumbel", "aligned", "steel, modal"]["asymmetry"] < 1e-6


def test_elastic_big_end(example, tmp_path):
    cases = example("elastic_big_end").main(quick=True, results=tmp_path)
    assert cases.pop("picture").stat().st_size > 10_000
    rigid, elastic = cases["rigid"], cases["elastic"]
    # the mechanism sets the force; the elastic bore spreads its pressure
    assert abs(elastic["largest_force_kN"] / rigid["largest_force_kN"] - 1) < 0.01
    assert elastic["peak_MPa"] < 0.95 * rigid["peak_MPa"]
    assert abs(elastic["iterations_per_step"] - rigid["iterations_per_step"]) < 2
