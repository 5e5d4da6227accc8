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


def test_elastic_slider_crank(example, tmp_path):
    rows = example("elastic_slider_crank").main(quick=True, output=tmp_path)
    assert (tmp_path / "elastic_slider_crank.png").stat().st_size > 10_000
    ideal, bent, rigid, elastic = (
        rows[name]
        for name in ("ideal pins, rigid rod", "ideal pins, elastic rod", "oil, rigid rod", "oil, elastic rod")
    )
    assert ideal["slider_position_um"] == 0.0
    # with ideal pins the slider leaves the rigid mechanism's path by the rod's stretch (its bow shortens the chord by 0.1 um)
    theory = rows["beam theory on this mesh"]
    assert bent["slider_position_um"] == pytest.approx(theory["rod_stretch_um"], rel=0.01)
    for row in (bent, elastic):
        assert row["rod_stretch_um"] == pytest.approx(theory["rod_stretch_um"], rel=0.01)
        # 3 %: quasi-static theory against a first bending frequency of 19 times the crank's, and what is left of the start-up
        assert row["rod_deflection_um"] == pytest.approx(theory["rod_deflection_um"], rel=0.03)
    # with oil it leaves it by the eccentricities of both pins at most, along a rod inclined by up to 24.6 degrees, with the
    # elastic rod by the stretch too
    eccentricity = 20 * sum(rigid[f"{pin}_eccentricity_ratio"] for pin in ("crank_pin", "gudgeon_pin")) / 0.909
    assert 20 < rigid["slider_position_um"] < eccentricity
    assert rigid["slider_position_um"] + 3 < elastic["slider_position_um"] < eccentricity + bent["slider_position_um"]
    # the mechanism's inertia sets the forces, 0.14 w^2 (r + r^2 / l) on the gudgeon pin at the dead centre: films stay
    assert rigid["gudgeon_pin_force_N"] == pytest.approx(0.14 * 523.6**2 * 0.05 * (1 + 0.05 / 0.12), rel=2e-3)
    for pin in ("crank_pin", "gudgeon_pin"):
        assert elastic[f"{pin}_force_N"] == pytest.approx(rigid[f"{pin}_force_N"], rel=3e-3)
        assert elastic[f"{pin}_minimum_gap_um"] == pytest.approx(rigid[f"{pin}_minimum_gap_um"], rel=0.08)
