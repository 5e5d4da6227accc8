"""Rules of the package's structure that no other tool checks."""

import ast
import collections
import dataclasses
import functools
import importlib
import inspect
import io
import pathlib
import pkgutil
import re
import subprocess
import sys
import tokenize

import pytest

import exudyn_ehd

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "exudyn_ehd"
MODULES = [m.name for m in pkgutil.walk_packages(exudyn_ehd.__path__, "exudyn_ehd.")]


def _sources():
    return sorted(PACKAGE.rglob("*.py"))


def test_only_coupling_and_studies_import_exudyn():
    for path, _, tree, _ in _parsed():
        if path.relative_to(PACKAGE).parts[0] in ("coupling", "studies", "__main__.py"):
            continue
        for node in ast.walk(tree):
            names = []
            if isinstance(node, ast.Import):
                names = [a.name for a in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            assert not any(n.split(".")[0] == "exudyn" for n in names), path


def test_film_studies_do_not_load_exudyn():
    """`steady` and its like run without Exudyn being imported, and without parts of scipy that few bearings need."""
    code = (
        "import sys, exudyn_ehd as ehd;"
        "b = ehd.JournalBearing(journal_radius=.01, length=.02, radial_clearance=2e-5, "
        "lubricant=ehd.Lubricant(viscosity=.04));"
        "ehd.steady(b, speed=100., eccentricity_ratio=.5);"
        "assert not {'exudyn', 'scipy.interpolate', 'scipy.optimize', 'scipy.special'} & {*sys.modules}"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


@pytest.mark.parametrize("name", MODULES)
def test_every_module_and_public_object_has_a_docstring(name):
    module = importlib.import_module(name)
    assert module.__doc__, name
    for label, item in vars(module).items():
        if label.startswith("_") or getattr(item, "__module__", None) != name:
            continue
        if inspect.isclass(item) or inspect.isfunction(item) or hasattr(item, "py_func"):
            doc = getattr(item, "py_func", item).__doc__
            assert doc, f"{name}.{label}"


def test_public_names_exist_and_are_sorted():
    assert list(exudyn_ehd.__all__) == sorted(exudyn_ehd.__all__)
    for name in exudyn_ehd.__all__:
        assert getattr(exudyn_ehd, name) is not None


@pytest.mark.parametrize("name", exudyn_ehd.__all__)
def test_docstrings_name_every_parameter(name):
    """Every argument of a public call and every field of a public description stands in its docstring."""
    item = getattr(exudyn_ehd, name)
    if dataclasses.is_dataclass(item):
        names = [f.name for f in dataclasses.fields(item)]
    elif inspect.isfunction(item):
        names = list(inspect.signature(item).parameters)
    else:
        return
    for argument in names:
        assert argument in item.__doc__, f"{name}: {argument} is not documented"


def test_options_are_frozen_and_keyword_only():
    for name in exudyn_ehd.__all__:
        item = getattr(exudyn_ehd, name)
        if dataclasses.is_dataclass(item) and not name.endswith("Result"):
            assert item.__dataclass_params__.frozen, name
            assert all(f.kw_only for f in dataclasses.fields(item)), name


# How large things may be; docstrings don't count. A reader holds no more than this at once.
LONGEST_FILE, LONGEST_FUNCTION, MOST_PARAMETERS, MOST_FILES = 300, 60, 14, 13
# Of the whole package: marks that keep the formatter off aligned tables,
# annotations that say nothing, logical lines of code.
MOST_SKIPS, MOST_ANY, MOST_CODE, MOST_MODULES = 7, 56, 24543, 200
MOST_CONSTANTS = 390
# Beginnings of a clause without its noun: no docstring of package, tests and examples begins with one.
BARE_CLAUSE = re.compile(
    r'^ *r?"""\s*((?:What|Whether|As|Of|The same|Where|Which|How|From|With|That|Those|Who|Whose|Why|For|At|When)\b.*)',
    re.MULTILINE,
)


def _docstring_lines(tree):
    lines = set()
    for node in ast.walk(tree):
        if (
            isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef))
            and ast.get_docstring(node, clean=False) is not None
        ):
            lines.update(range(node.body[0].lineno, node.body[0].end_lineno + 1))
    return lines


@functools.cache
def _parsed():
    """(path, text, syntax tree, lines of docstrings) of every file."""
    texts = [(path, path.read_text(encoding="utf-8")) for path in _sources()]
    return [(path, text, tree := ast.parse(text), _docstring_lines(tree)) for path, text in texts]


def _module(path):
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _imports(tree, modules):
    """Modules of the package that a file names in any import, those inside functions and for types included."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (a.name for a in node.names if a.name in modules)
        elif isinstance(node, ast.ImportFrom) and node.module in modules:
            whole = [f"{node.module}.{a.name}" for a in node.names]
            yield from (name if name in modules else node.module for name in whole)


def _circles(graph):
    """Sets of modules that reach each other."""
    reach = {}
    for start in graph:
        seen, todo = set(), [start]
        while todo:
            for name in graph[todo.pop()] - seen:
                seen.add(name)
                todo.append(name)
        reach[start] = seen
    return {frozenset(m for m in reach[name] if name in reach[m]) for name in graph if name in reach[name]}


def test_no_circle_of_files():
    """Imports inside functions and for types alone included."""
    trees = {_module(path): tree for path, _, tree, _ in _parsed()}
    circles = _circles({name: set(_imports(tree, trees)) for name, tree in trees.items()})
    assert not circles, [sorted(c) for c in circles]


def _type_names(tree):
    """Classes, protocols included, and names of types: unions, type variables, callables."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield node.name.lstrip("_")
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        names = [target.id for target in targets if isinstance(target, ast.Name)]
        yield from (name.lstrip("_") for name in names if re.fullmatch("_?[A-Z][A-Za-z]*[a-z][A-Za-z]*", name))


def test_no_two_classes_share_a_name():
    """Two types of one name in two modules are taken for one another; a leading underscore does not tell them apart."""
    places = collections.defaultdict(list)
    for path, _, tree, _ in _parsed():
        for name in _type_names(tree):
            places[name].append(_module(path))
    shared = {name: modules for name, modules in places.items() if len(modules) > 1}
    assert not shared, "\n".join(f"{name}: {', '.join(modules)}" for name, modules in shared.items())


def test_folders_are_small():
    assert len(_sources()) <= MOST_MODULES
    for folder in {path.parent for path in _sources()}:
        assert len(list(folder.glob("*.py"))) <= MOST_FILES, folder


def test_files_functions_and_signatures_are_short():
    found = []
    for path, text, tree, docs in _parsed():
        if (lines := len(text.splitlines()) - len(docs)) > LONGEST_FILE:
            found.append(f"{path}: {lines} lines")
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef):
                continue
            kernel = any("njit" in ast.unparse(mark) for mark in node.decorator_list)
            lines = node.end_lineno - node.lineno + 1 - len(docs & set(range(node.lineno, node.end_lineno + 1)))
            if not kernel and lines > LONGEST_FUNCTION:
                found.append(f"{path}: {node.name} has {lines} lines")
            parameters = len(node.args.args) + len(node.args.kwonlyargs)
            if kernel and parameters > MOST_PARAMETERS and path.parent != PACKAGE / "film" / "banded":
                found.append(f"{path}: {node.name} takes {parameters} parameters")
    assert not found, "\n".join(found)


def test_the_package_stays_small():
    """Logical lines: the tokenizer's NEWLINE tokens outside docstrings."""
    skips = unknown = code = 0
    for _, text, tree, docs in _parsed():
        skips += text.count("# fmt: skip")
        unknown += sum(isinstance(node, ast.Name) and node.id == "Any" for node in ast.walk(tree))
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        code += sum(t.type == tokenize.NEWLINE and t.start[0] not in docs for t in tokens)
    assert skips <= MOST_SKIPS
    assert unknown <= MOST_ANY
    assert code <= MOST_CODE


def test_there_are_few_constants():
    """Names in capitals that hold a number, in modules; each is one more thing to know and to defend."""
    count = 0
    for _, _, tree, _ in _parsed():
        for node in tree.body:
            if not isinstance(node, ast.Assign):
                continue
            names = [name.id for target in node.targets for name in ast.walk(target) if isinstance(name, ast.Name)]
            numbers = (x.value for x in ast.walk(node.value) if isinstance(x, ast.Constant))
            holds = any(isinstance(x, int | float) and not isinstance(x, bool) for x in numbers)
            count += holds * sum(name.lstrip("_").isupper() for name in names)
    assert count <= MOST_CONSTANTS


def test_docstrings_begin_with_a_noun_or_a_verb():
    """Docstrings of modules, classes and functions, and those below constants; the formatter makes their quotes."""
    paths = [path for folder in ("exudyn_ehd", "tests", "examples") for path in sorted((ROOT / folder).rglob("*.py"))]
    found = [f"{p}: {line}" for p in paths for line in BARE_CLAUSE.findall(p.read_text(encoding="utf-8"))]
    assert not found, "\n".join([f"{len(found)} docstrings, e.g. 'Return whether ...' is better:", *found])


def test_functions_of_bench_and_examples_are_short():
    """Functions have at most 60 lines, docstrings apart, as in the package; files of the bench at most 300."""
    bench, found = ROOT / "tests" / "benchmarks" / "accuracy", []
    for path in [*bench.rglob("*.py"), *(ROOT / "examples").glob("*.py")]:
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text)
        docs = _docstring_lines(tree)
        if path.is_relative_to(bench) and len(text.splitlines()) - len(docs) > 300:
            found.append(str(path))
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                own = set(range(node.lineno, node.end_lineno + 1)) - docs
                found += [f"{path}: {node.name} has {len(own)} lines"] if len(own) > 60 else []
    assert not found, "\n".join(found)
