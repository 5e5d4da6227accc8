"""Temperature laws and named oils: points, slopes, tables and messages."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.lubricant import ISO_GRADES, MULTIGRADES, SAE_GRADES

T40, T100 = 313.15, 373.15


def kinematic(oil):
    """mm2/s, with the density of ASTM D1250, table 54D, at the oil's temperature."""
    x = 0.6278 / oil.density * (oil.temperature - 288.15)
    return 1e6 * oil.viscosity / (oil.density * math.exp(-x * (1.0 + 0.8 * x)))


def test_reynolds_is_an_exponential():
    law = ehd.ReynoldsTemperature(point=(T40, 0.04), coefficient=0.03)
    assert law.viscosity(T40 + 10.0, 870.0) == pytest.approx(0.04 * math.exp(-0.3), rel=1e-13)
    assert ehd.ReynoldsTemperature(point=(T40, 0.04), coefficient=0.0).viscosity(400.0, 870.0) == 0.04


@pytest.mark.parametrize("pole", [0.0, 178.15, 200.0])
def test_vogel_meets_its_points_and_its_formula(pole):
    law = ehd.VogelTemperature(first=(T40, 0.04), second=(T100, 0.006), pole=pole)
    np.testing.assert_allclose(law.viscosity(np.array([T40, T100]), 870.0), [0.04, 0.006], rtol=1e-13)
    A, B = law.constants
    assert law.viscosity(340.0, 870.0) == pytest.approx(A * math.exp(B / (340.0 - pole)), rel=1e-13)


def test_walther_meets_its_points_and_is_straight_on_the_chart():
    """log10 log10(nu + 0.7) is linear in log10 T (ASTM D341)."""
    law = ehd.WaltherTemperature(first=(T40, 46e-6), second=(T100, 6.7e-6))
    T = np.array([T40, 330.0, 350.0, T100])
    nu = law.viscosity(T, 870.0) / 870.0 * 1e6
    np.testing.assert_allclose(nu[[0, -1]], [46.0, 6.7], rtol=1e-12)
    w = np.log10(np.log10(nu + 0.7))
    np.testing.assert_allclose(np.diff(w) / np.diff(np.log10(T)), (w[-1] - w[0]) / np.log10(T100 / T40), rtol=1e-10)


def test_walther_worked_example():
    """32 mm2/s at 40 and 5.4 at 100 degrees Celsius give 8.5 at 80."""
    law = ehd.WaltherTemperature(first=(T40, 32e-6), second=(T100, 5.4e-6))
    assert law.viscosity(353.15, 1000.0) * 1e3 == pytest.approx(8.5, abs=0.05)  # printed with two digits


@pytest.mark.parametrize("name", list(ISO_GRADES))
def test_iso_grades_meet_their_mid_point(name):
    oil = ehd.oil(name)
    assert kinematic(oil) == pytest.approx(float(name.split()[-1]), rel=1e-12)
    assert kinematic(oil.at(T100)) == pytest.approx(ISO_GRADES[name][1], rel=1e-12)


def test_density_falls_with_temperature():
    """875 kg/m3 at 15 degrees Celsius are 859.2 at 40 and 820.8 at 100 (ASTM D1250); none without an expansion."""
    points = {"first": (T40, 32e-6), "second": (T100, 5.4e-6)}
    oil, plain = (ehd.WaltherTemperature(**points, expansion=e) for e in (0.6278 / 875.0, 0.0))
    assert oil.viscosity(T40, 875.0) == pytest.approx(32e-6 * 859.2, rel=1e-4)
    assert oil.viscosity(T100, 875.0) == pytest.approx(5.4e-6 * 820.8, rel=1e-4)
    assert plain.viscosity(T100, 875.0) == pytest.approx(5.4e-6 * 875.0, rel=1e-12)
    with pytest.raises(ehd.InputError, match=r"WaltherTemperature\.expansion"):
        ehd.WaltherTemperature(**points, expansion=0.63)


# ISO 3448: limits at 40 degrees Celsius, 10 % around the mid-point, in mm2/s.
ISO_3448 = {
    "ISO VG 22": (19.8, 24.2),
    "ISO VG 32": (28.8, 35.2),
    "ISO VG 46": (41.4, 50.6),
    "ISO VG 68": (61.2, 74.8),
    "ISO VG 100": (90.0, 110.0),
    "ISO VG 150": (135.0, 165.0),
    "ISO VG 220": (198.0, 242.0),
    "ISO VG 320": (288.0, 352.0),
    "ISO VG 460": (414.0, 506.0),
}


def test_iso_grades_lie_in_the_standard_limits():
    assert ISO_3448.keys() == ISO_GRADES.keys()
    for name, (low, high) in ISO_3448.items():
        oil = ehd.oil(name)
        assert low < kinematic(oil) < high


# Reference viscosities L and H of ASTM D2270 at the oil's viscosity at 100 degrees
# Celsius, and the index that makers print with these points: Mobil Oil Australia's product
# pages (2012), Shell's sheet of Omala S2 G 220 (98, of a viscosity before rounding).
D2270 = {
    "ISO VG 22": (29.07, 22.05, None),
    "ISO VG 32": (47.31, 32.37, None),
    "ISO VG 46": (71.29, 45.33, None),
    "ISO VG 68": (113.9, 66.48, None),
    "ISO VG 100": (176.6, 96.45, None),
    "ISO VG 150": (296.5, 149.7, None),
    "ISO VG 220": (467.0, 219.4, 98.0),
    "ISO VG 320": (736.5, 320.9, None),
    "ISO VG 460": (1073.6, 438.9, None),
    "SAE 0W-20": (113.9, 66.48, 173.0),
    "SAE 5W-30": (163.2, 90.19, 156.0),
    "SAE 10W-40": (276.3, 141.0, 155.0),
    "SAE 15W-40": (279.6, 142.4, 136.0),
    "SAE 20W-50": (416.7, 199.4, 126.0),
}


@pytest.mark.parametrize("name", list(D2270))
def test_viscosity_index(name):
    """Viscosity index of both points by ASTM D2270, procedures A and B: the printed one, to its rounding, or 95 to 102
    for plain mineral oils."""
    L, H, printed = D2270[name]
    U, Y = (ISO_GRADES | MULTIGRADES)[name][:2]
    index = 100.0 * (L - U) / (L - H)
    if index > 100.0:
        index = 100.0 + (10.0 ** (math.log10(H / U) / math.log10(Y)) - 1.0) / 0.00715
    if printed is None:
        assert 95.0 < index < 102.5
    else:
        assert index == pytest.approx(printed, abs=0.5 if name in MULTIGRADES else 2.0)


# Other oils of the ISO grades: dynamic viscosities at 40 and 100 degrees Celsius over the
# density (mm2/s), and that (kg/m3). 32 to 68: those of the rotor dynamics code ROSS
# (Petrobras); the others: Mobilgear 600 XP (ExxonMobil's sheet of 2020, density to two digits).
OTHER_ISO = {
    "ISO VG 32": (32.0, 5.34, 874.0),
    "ISO VG 46": (46.0, 7.04, 863.0),
    "ISO VG 68": (65.8, 8.84, 867.0),
    "ISO VG 100": (100.0, 11.2, 880.0),
    "ISO VG 150": (150.0, 14.7, 890.0),
    "ISO VG 220": (220.0, 19.0, 890.0),
    "ISO VG 320": (320.0, 24.1, 900.0),
    "ISO VG 460": (460.0, 30.6, 900.0),
}


@pytest.mark.parametrize("name", list(OTHER_ISO))
def test_iso_grades_are_near_other_oils(name):
    nu40, nu100, density = OTHER_ISO[name]
    assert ISO_GRADES[name][0] == pytest.approx(nu40, rel=0.04)
    assert ISO_GRADES[name][1] == pytest.approx(nu100, rel=0.06)
    assert ISO_GRADES[name][2] == pytest.approx(density, rel=0.025)


# SAE J300 (2015), high-temperature grades: kinematic viscosity at 100 degrees Celsius in mm2/s.
J300_HOT = {"20": (6.9, 9.3), "30": (9.3, 12.5), "40": (12.5, 16.3), "50": (16.3, 21.9)}
# Another oil of the grade: nu at 40 and at 100 degrees Celsius in mm2/s. 10W-40: mean of five oils tested by the
# Petroleum Quality Institute of America, May 2016; 5W-30: SBK Diamond 7000; the others: Casstek (makers' data sheets).
OTHER_OILS = {
    "SAE 0W-20": (47.6, 8.6),
    "SAE 5W-30": (60.4, 9.8),
    "SAE 10W-40": (102.3, 14.85),
    "SAE 15W-40": (116.0, 15.2),
    "SAE 20W-50": (172.0, 19.5),
}


@pytest.mark.parametrize("name", list(MULTIGRADES))
def test_multigrades_lie_in_their_class_and_near_other_oils_of_it(name):
    oil = ehd.oil(name)
    nu40, nu100 = (kinematic(oil.at(T)) for T in (T40, T100))
    assert (nu40, nu100) == pytest.approx(MULTIGRADES[name][:2], rel=1e-12)
    low, high = J300_HOT[name.split("-")[-1]]
    assert low <= nu100 < high
    # oils of one grade differ by that much
    assert (nu40, nu100) == pytest.approx(OTHER_OILS[name], rel=0.1)


def test_multigrades_thin_less_with_temperature_than_single_grades():
    for multi, single in (("SAE 5W-30", "SAE 30"), ("SAE 10W-40", "SAE 40"), ("SAE 20W-50", "SAE 50")):
        thinning = [ehd.oil(name).viscosity / ehd.oil(name, temperature=T100).viscosity for name in (multi, single)]
        assert thinning[0] < 0.8 * thinning[1]


# Mobil Delvac 1330, 1340, 1350 (ExxonMobil's data sheet): nu at 40 and at 100 degrees Celsius in mm2/s.
DELVAC = {"SAE 30": (106.0, 11.8), "SAE 40": (146.0, 14.6), "SAE 50": (231.0, 19.9)}


@pytest.mark.parametrize("name", list(DELVAC))
def test_sae_grades_are_near_present_oils(name):
    """Within 18 %: the fits of 1982 are of oils of a viscosity index below the
    99 of these, which thin more with temperature."""
    oil = ehd.oil(name)
    for T, nu, density in zip((T40, T100), DELVAC[name], (875.0, 837.0), strict=True):
        assert oil.at(T).viscosity == pytest.approx(1e-6 * nu * density, rel=0.18)


# SAE J300 before 2013, when the grade 20 began at 5.6: kinematic viscosity at 100 degrees Celsius in mm2/s.
J300 = {
    "SAE 20": (5.6, 9.3),
    "SAE 30": (9.3, 12.5),
    "SAE 40": (12.5, 16.3),
    "SAE 50": (16.3, 21.9),
    "SAE 60": (21.9, 26.1),
}


@pytest.mark.parametrize("name", list(J300))
def test_sae_grades_lie_in_their_class(name):
    nu = ehd.oil(name, temperature=T100).viscosity / 835.0 * 1e6  # density of mineral oil at 100 degrees Celsius
    low, high = J300[name]
    assert 0.95 * low < nu < 1.05 * high  # the fits of 1982 miss a limit by up to 3 %


def test_sae_is_the_published_fit_between_its_points():
    for name, (mu_0, b) in SAE_GRADES.items():
        expected = 1e-6 * mu_0 * 6894.757 * math.exp(b / (160.0 + 95.0))
        assert ehd.oil(name, temperature=(160.0 + 459.67) / 1.8).viscosity == pytest.approx(expected, rel=1e-11)


def test_names_are_forgiving_but_not_guessed():
    assert ehd.oil("iso vg46") == ehd.oil("ISO VG 46")
    with pytest.raises(ehd.InputError, match="ISO VG 22, ISO VG 32"):
        ehd.oil("ISO VG 47")
    assert ehd.oil("sae5w-30") == ehd.oil("SAE 5W-30")
    with pytest.raises(
        ehd.InputError, match="SAE 60, SAE 0W-20, SAE 5W-30, SAE 10W-40, SAE 15W-40, SAE 20W-50, got 'SAE 5W-31'"
    ):
        ehd.oil("SAE 5W-31")
    with pytest.raises(ehd.InputError, match="name must be one of"):
        ehd.oil(46)


def test_viscosity_comes_from_the_law_or_from_the_user():
    law = ehd.WaltherTemperature(first=(T40, 46e-6), second=(T100, 6.7e-6))
    assert ehd.Lubricant(temperature_law=law, temperature=T100, density=900.0).viscosity == pytest.approx(900 * 6.7e-6)
    given = ehd.Lubricant(viscosity=0.05, temperature_law=law)
    assert given.viscosity == 0.05
    assert given.at(T100).viscosity == pytest.approx(0.05 * 6.7 / 46.0, rel=1e-12)
    assert ehd.Lubricant(viscosity=0.04).viscosity == 0.04


def test_input_errors_name_argument_and_next_step():
    with pytest.raises(ehd.InputError, match=r"Lubricant\.viscosity must be > 0 Pa s, got None"):
        ehd.Lubricant()
    with pytest.raises(ehd.InputError, match="temperature_law"):
        ehd.Lubricant(viscosity=0.04).at(350.0)
    with pytest.raises(ehd.InputError, match="in kelvin"):
        ehd.VogelTemperature(first=(T100, 0.04), second=(T40, 0.006))
    with pytest.raises(ehd.InputError, match=r"VogelTemperature\.pole"):
        ehd.VogelTemperature(first=(T40, 0.04), second=(T100, 0.006), pole=320.0)
    with pytest.raises(ehd.InputError, match="m2/s"):
        ehd.WaltherTemperature(first=(T40, 46.0), second=(T100, 6.7))
    with pytest.raises(ehd.InputError, match=r"ReynoldsTemperature\.point"):
        ehd.ReynoldsTemperature(point=(-5.0, 0.04), coefficient=0.03)
