"""READMEs: their Python runs as it stands, what they name and link to exists, one word for one thing."""

import ast
import pathlib
import re

import pytest

import exudyn_ehd

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


def test_project_package_citation_and_changelog_tell_one_version():
    (version,) = re.findall(r'^version = "(.*)"$', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE)
    assert exudyn_ehd.__version__ == version
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
    """What a person reads of a file: text without code, docstrings, messages and comments."""
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
