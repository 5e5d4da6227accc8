"""READMEs: their Python runs as it stands, what they name and link to exists, one word for one thing."""

import ast
import functools
import importlib
import inspect
import itertools
import pathlib
import re
import sys

import exudyn as exu
import pytest
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd
from tests.sampling import but_slow

ROOT = pathlib.Path(__file__).resolve().parent.parent
GUIDES = sorted(path for folder in ("exudyn_ehd", "examples", "tests") for path in (ROOT / folder).rglob("*.md")) + [
    ROOT / "README.md"
]
TEXTS = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in GUIDES}
# An audit tries every effect, a bush takes the kernels of the solid: long to compile; studies solve many films.
SLOW = {"exudyn_ehd/coupling/README.md", "exudyn_ehd/joint/README.md", "exudyn_ehd/solid/README.md"}
SLOW |= {"exudyn_ehd/studies/README.md"}
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks(name, language):
    """Fenced blocks of a guide in one language."""
    return [code for kind, code in FENCE.findall(TEXTS[name]) if kind == language]


def anchors(text):
    """Anchors that GitHub makes of headings."""
    heads = re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in TEXTS if blocks(n, "python")],
)
def test_python_of_the_guides_runs(name, tmp_path, monkeypatch, capsys):
    """One block after the other, as a reader pastes them."""
    monkeypatch.chdir(tmp_path)
    known = {"__name__": "__main__"}
    for code in blocks(name, "python"):
        exec(compile(code, name, "exec"), known)
    if name == "README.md":
        assert capsys.readouterr().out.splitlines()[0] in TEXTS[name]


@pytest.mark.parametrize("name", TEXTS)
def test_links_and_pictures_of_the_guides_exist(name):
    text = FENCE.sub("", TEXTS[name])
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if target.startswith(("http://", "https://")):
            continue
        path, _, anchor = target.partition("#")
        place = (ROOT / name).parent / path if path else ROOT / name
        assert place.exists(), f"{name} links to {target}"
        if anchor:
            assert anchor in anchors(place.read_text(encoding="utf-8")), f"{name} links to {target}"


@pytest.mark.parametrize("name", TEXTS)
def test_what_the_guides_name_exists(name):
    """Files and folders: seen from the guide, the project, the package, packages with a guide, or the tables."""
    prose = FENCE.sub("", TEXTS[name])
    names = [n for n in re.findall(r"`([\w./-]+)`", prose) if "/" in n or n.endswith((".py", ".csv"))]
    names += re.findall(r"(?:examples|tests|exudyn_ehd)/[\w./-]*", TEXTS[name])
    modules = [n.replace(".", "/") for n in re.findall(r"python -m ((?:tests|exudyn_ehd)[\w.]*)", TEXTS[name])]
    names += [f"{n}.py" if (ROOT / f"{n}.py").exists() else n for n in modules]
    package, tables = ROOT / "exudyn_ehd", ROOT / "tests" / "benchmarks" / "accuracy" / "data"
    places = ((ROOT / name).parent, ROOT, package, package / "joint", package / "joint" / "audit", tables)
    # made by the examples
    for wanted in sorted({n.rstrip(".") for n in names} - {"results/"}):
        assert any((place / wanted).exists() for place in places), f"{name} names {wanted}, which is not there"


STEP = re.compile(r"`([\w.]+): ([\w.]+)`")


def walks():
    """Walks of the package's guide: their titles with the text below."""
    (text,) = re.findall(r"^## Three walks.*?(?=^## )", TEXTS["exudyn_ehd/README.md"], re.DOTALL | re.MULTILINE)
    return re.findall(r"^### (.*?)\n(.*?)(?=^### |\Z)", text, re.DOTALL | re.MULTILINE)


def step_of(module, name):
    """Object that a step names as ``module: function``."""
    return functools.reduce(getattr, name.split("."), importlib.import_module(f"exudyn_ehd.{module}"))


def test_steps_of_the_walks_exist():
    assert len(walks()) == 3
    for title, text in walks():
        lines = re.findall(r"^\d+\. (.*)$", text, re.MULTILINE)
        assert 5 <= len(lines) <= 10 and all(STEP.search(line) for line in lines), title
        for module, name in STEP.findall(text):
            step_of(module, name)


def evaluate_joint(options):
    """Describe a bearing, put it into a system, and ask its film for force and Jacobian."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        film=ehd.FiniteLength(n_theta=32, n_z=6),
        **({"lubricant": ehd.Lubricant(viscosity=0.02)} | options),
    )
    mbs = exu.SystemContainer().AddSystem()
    inertia = InertiaCuboid(density=7800, sideLengths=[0.1] * 3)
    shaft = mbs.CreateRigidBody(
        inertia=inertia, initialAngularVelocity=[0, 0, 100.0], initialDisplacement=[4e-6, -8e-6, 0]
    )
    joint = ehd.CreateLubricatedJoint(mbs, "main", [mbs.CreateGround(), shaft], [0, 0, 0], [0, 0, 1], bearing)
    mbs.Assemble()
    for item in (exu.ComputeItemType.ODE2LHS, exu.ComputeItemType.JacobianODE2):
        mbs.ComputeItem(joint.objectNumber, item)


def follow(function):
    """Call a function; return the codes of the package that it calls, in order, and the stacks of their modules."""
    codes, stacks, stack = [], set(), []

    def note(frame, event, _):
        module = frame.f_globals.get("__name__", "")
        if module.startswith("exudyn_ehd."):
            if event == "call":
                stack.append(module)
                codes.append(frame.f_code)
                stacks.add(tuple(stack))
            elif event == "return":
                stack.pop()

    sys.setprofile(note)
    try:
        function()
    finally:
        sys.setprofile(None)
    return codes, stacks


def entered_twice(stack):
    """Packages that a stack of modules has left and entered again; checks of arguments are in none."""
    names = [name.split(".")[1:] for name in stack if name not in ("exudyn_ehd.status", "exudyn_ehd.plausible")]
    packages = [".".join(name if len(name) < 3 else name[:2]) for name in names]
    path = [package for package, _ in itertools.groupby(packages)]
    return {package for package in path if path.count(package) > 1}


WALKED = {
    "profile": {"profile": ehd.OutOfRound(order=2, amplitude=1e-6)},
    "heat and wall": {
        "lubricant": ehd.oil("ISO VG 46"),
        "profile": ehd.OutOfRound(order=2, amplitude=1e-6),
        "thermal": ehd.FilmEnergy(supply_temperature=313.0),
        "contact": ehd.RegularisedWall(onset=1e-6),
    },
    "liner": {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9), "profile": ehd.Crown(drop=1e-6)},
    # all but its own kernels are compiled for thinning too, those of the one above for it alone
    "liner and thinning": {
        "lubricant": ehd.Lubricant(viscosity=0.03, shear_law=ehd.CarreauShear(relaxation_time=1e-7, exponent=0.8)),
        "bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9),
        "profile": ehd.Crown(drop=1e-6),
    },
}


@pytest.mark.parametrize("name", but_slow(WALKED, "liner"))
def test_walks_have_the_order_of_the_calls_and_come_back_to_no_package(name):
    """Kernels and dataclasses have no calls to follow; a first evaluation compiles and imports."""
    evaluate_joint(WALKED[name])
    codes, stacks = follow(lambda: evaluate_joint(WALKED[name]))
    assert {package for stack in stacks for package in entered_twice(stack)} == set()
    for title, text in walks():
        steps = [step_of(*STEP.search(line).groups()) for line in re.findall(r"^\d+\. .*$", text, re.MULTILINE)]
        steps = [step.__code__ for step in steps if inspect.isfunction(step)]
        start = codes.index(steps[0])
        places = [codes.index(step, start) for step in steps]
        assert len(places) >= 6 and places == sorted(places), title


def test_project_package_citation_and_changelog_tell_one_version():
    (version,) = re.findall(r'^version = "(.*)"$', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE)
    assert ehd.__version__ == version
    assert re.findall(r"exudyn_ehd (\d[\d.]*\d)", TEXTS["README.md"]) == [version]
    assert re.findall(r"^## (.*)$", TEXTS["exudyn_ehd/CHANGELOG.md"], re.MULTILINE)[0] == version


def test_the_main_guide_is_short_and_its_difference_is_the_example_s(example):
    text = TEXTS["README.md"]
    assert len(text.splitlines()) <= 250
    (shown,) = blocks("README.md", "diff")
    # without the head of the difference and the return of the joints
    assert shown.splitlines() == example("upgrade_existing_model").difference().splitlines()[3:-1]


# What is written otherwise, in prose: the class is `Gumbel`, the man is Gümbel.
VARIANTS = re.compile(
    r"(?<!FullSommerfeld, )\bGumbel\b(?![.`(=])"
    r"|\bmin(?:imal|imum)?\.? film\b(?! thickness)|\b(?:smallest|least|minimal) film thickness"
)


def prose(path):
    """Prose of a file: its text without code; of Python its docstrings, messages and comments."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py" and re.search("umbel|min[a-z.]* *film|film *thickness", text):
        comments = " ".join(re.findall(r"#+ (.*)", text))
        known = [n.value for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Constant) and isinstance(n.value, str)]
        # a string of one word is a name of the code
        text = " | ".join([comments, *(value for value in known if value != "Gumbel")])
    elif path.suffix == ".py":
        text = ""
    return re.sub(r"\s+", " ", re.sub(r"`+[^`]*`+", "", FENCE.sub("", text)))


def test_one_spelling_for_one_thing():
    folders = [ROOT / folder for folder in ("exudyn_ehd", "examples", "tests/benchmarks")]
    paths = [path for folder in folders for path in folder.rglob("*.py")] + GUIDES
    found = [f"{path}: {match.group(0)!r}" for path in paths for match in VARIANTS.finditer(prose(path))]
    assert not found, "\n".join(found)
