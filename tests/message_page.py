"""The page of messages, `exudyn_ehd/MESSAGES.md`: texts of the package with code that raises them.

``python -m tests.message_page`` runs every example of `tests/message_examples.py` and writes the page;
`tests/test_message_page.py` tells when it has to be written again.
"""

import ast
import contextlib
import functools
import io
import itertools
import logging
import math
import os
import pathlib
import re
import sys
import tempfile
import unittest.mock
import warnings
from typing import NamedTuple

import matplotlib

import exudyn_ehd as ehd
from tests.api_page import anchor, table, wrapped
from tests.message_examples import GROUPS, SETUPS

PACKAGE = pathlib.Path(ehd.__file__).parent
PAGE = PACKAGE / "MESSAGES.md"
COMMAND = "python -m tests.message_page"
# Errors that a user reads, and the calls that tell a user something without one.
ERRORS = {"InputError", "FilmError", "RunError", "EHDError", "KeyError", "AttributeError", "KeyboardInterrupt"}
CALLS = {"warn_user", "warnings.warn", "doubts.LOGGER.info"}
# Calls whose text is the second argument.
TEXT_SECOND = {"doubts.LOGGER.info", "self._at"}
# The file whose `self._at` makes errors; elsewhere it is something else.
FAILURES = "coupling/element/failures.py"
# Pass on the texts of their callers.
PASSED_ON = {"status.warn_user", "coupling.element.failures._at"}


class Site(NamedTuple):
    """One place of the package that makes a message.

    Attributes
    ----------
    path : str
        File, seen from the package.
    first, last : int
        Lines of the call.
    text : str
        The message with "..." for values; empty if another function writes it.
    """

    path: str
    first: int
    last: int
    text: str


class Told(NamedTuple):
    """Message that an example has raised: its class, its text, and the places whose words are in it."""

    kind: str
    text: str
    sites: tuple[Site, ...]


def template(node):
    """The text of a message as far as it stands in the code, with "..." for values."""
    if isinstance(node, ast.Constant):
        return str(node.value)
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "..." for part in node.values)
    return "..."


def is_message(node, path):
    """Return whether a call in a file of the package makes an error, a warning or a line for users."""
    if not isinstance(node, ast.Call):
        return False
    name = ast.unparse(node.func)
    if name == "self._at":
        return path == FAILURES
    return name in CALLS or name.split(".")[-1] in ERRORS or name == "type(cause)"


@functools.cache
def sites():
    """All places of the package that make a message."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        tree = ast.parse(path.read_text(encoding="utf-8"))
        skipped = [
            range(node.lineno, node.end_lineno + 1)
            for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef) and f"{name[:-3].replace('/', '.')}.{node.name}" in PASSED_ON
        ]
        for node in ast.walk(tree):
            if is_message(node, name) and not any(node.lineno in lines for lines in skipped):
                text = template(node.args[ast.unparse(node.func) in TEXT_SECOND]) if node.args else ""
                found.append(Site(name, node.lineno, node.end_lineno, "" if text == "..." else text))
    return found


def site_of(frames):
    """The site among (file, line) of a stack, the innermost frame first, in a tuple; empty if none is one."""
    for file, line in frames:
        if not file.startswith(str(PACKAGE)):
            continue
        name = pathlib.Path(file).relative_to(PACKAGE).as_posix()
        for site in sites():
            if site.path == name and site.first <= line <= site.last:
                return (site,)
    return ()


def stack(frame):
    """(file, line) of a frame and those that have called it."""
    while frame is not None:
        yield frame.f_code.co_filename, frame.f_lineno
        frame = frame.f_back


def traced(error):
    """(file, line) of the frames that an error has passed, the innermost first."""
    frames, at = [], error.__traceback__
    while at is not None:
        frames.append((at.tb_frame.f_code.co_filename, at.tb_lineno))
        at = at.tb_next
    return frames[::-1]


class _Listener(logging.Handler):
    """Handler of the package's log that keeps its lines with their sites."""

    def __init__(self, told):
        super().__init__()
        self.told = told

    def emit(self, record):
        self.told.append(Told("log", record.getMessage(), site_of([(record.pathname, record.lineno)])))


@contextlib.contextmanager
def listening():
    """Give lists that receive warnings and lines of the log, and all errors with the places that make them."""
    told, made, log, init, warn = [], [], logging.getLogger("exudyn_ehd"), ehd.EHDError.__init__, warnings.warn
    handler = _Listener(told)

    def keep_warning(message, category=UserWarning, stacklevel=1, source=None):
        told.append(Told(category.__name__, str(message), site_of(stack(sys._getframe(1)))))
        # the package records some, to tell them later
        warn(message, category, stacklevel + 1, source)

    def keep_place(self, *args):
        init(self, *args)
        # the maker, and who has asked it for an error of this text
        made.append((str(self), site_of(itertools.islice(stack(sys._getframe(1)), 2))))

    level = log.level
    log.setLevel(logging.INFO)
    log.addHandler(handler)
    warnings.warn, ehd.EHDError.__init__ = keep_warning, keep_place
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield told, made
    finally:
        warnings.warn = warn
        del ehd.EHDError.__init__
        log.removeHandler(handler)
        log.setLevel(level)


@functools.cache
def once(setup):
    """Names of a setup that every example may share."""
    names = dict(once(SETUPS[setup].after)) if SETUPS[setup].after else {}
    exec(compile(SETUPS[setup].code, setup, "exec"), names)
    return names


def prepared(setup):
    """Names that an example of a setup begins with; a setup that examples change is made anew for each."""
    if SETUPS[setup].shared:
        return dict(once(setup))
    names = prepared(SETUPS[setup].after) if SETUPS[setup].after else {}
    exec(compile(SETUPS[setup].code, setup, "exec"), names)
    return names


@contextlib.contextmanager
def undone():
    """Undo what examples change for the whole process: hidden packages, the environment, settings of pictures."""
    modules = dict(sys.modules)
    with matplotlib.rc_context(), unittest.mock.patch.dict(os.environ):
        try:
            yield
        finally:
            for name in [name for name, module in sys.modules.items() if module is None]:
                del sys.modules[name]
            sys.modules.update(modules)


def raised(code, setup):
    """Run an example; return its error, else its first warning, what it prints, or its first line in the log.

    None if it is silent.
    """
    with listening() as (told, made), undone(), contextlib.redirect_stdout(io.StringIO()) as printed:
        names = prepared(setup)
        told.clear(), made.clear(), printed.seek(0), printed.truncate()
        try:
            exec(compile(code, "example", "exec"), names)
        except (ehd.EHDError, KeyError, AttributeError, KeyboardInterrupt) as error:
            text = error.args[0] if isinstance(error, KeyError) else str(error)
            return Told(type(error).__name__, anywhere(text), makers(made, text) or site_of(traced(error)))
        shown = [item for item in told if item.kind != "log"]
        if not shown and (places := makers(made, text := printed.getvalue())):
            return Told("printed", anywhere(text), places)
    return with_repeats(shown or told)


def makers(made, text):
    """Places of the errors (text, places) whose words are in a text."""
    return tuple(dict.fromkeys(site for said, places in made for site in places if said and said in text))


def with_repeats(told):
    """The first message that is passed on, else the first, with the places of all that say it; None for no message."""
    if not told:
        return None
    texts = [item.text for item in told]
    first = max(told, key=lambda item: texts.count(item.text))
    places = dict.fromkeys(site for item in told if item.text == first.text for site in item.sites)
    return first._replace(sites=tuple(places))


def anywhere(text):
    """A message without what depends on the machine: folders, places in memory and in Exudyn's files."""
    text = re.sub(r" in \d+ steps", " in ... steps", text.replace(os.getcwd() + os.sep, ""))
    return re.sub(r" at 0x\w+", " at 0x...", re.sub(r"\[Python file [^]]*\]", "[Python file ...]", text))


def examples(group):
    """Codes of a group's examples."""
    return [code.strip("\n") for code in re.split(r"\n\s*\n", group.examples.strip("\n"))]


@functools.cache
def results():
    """(group, code, what it tells) of all examples, run in an empty folder."""
    found = []
    here = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for group in GROUPS:
                found += [(group, code, raised(code, group.setup)) for code in examples(group)]
        finally:
            os.chdir(here)
    return found


def silent():
    """Examples that tell nothing, or nothing of the package."""
    return [code for _, code, told in results() if told is None or not told.sites]


def without_example():
    """Sites that no example reaches."""
    reached = {site for _, _, told in results() if told is not None for site in told.sites}
    return [site for site in sites() if site not in reached]


def escaped(text):
    """A message as text of a table."""
    return re.sub(r"([|*<])", r"\\\1", " ".join(text.split()))


def shown_code(code):
    """Lines of code in a cell of a table."""
    return "<br>".join(f"`{line}`".replace("|", r"\|") for line in code.splitlines())


def group_text(group):
    """Heading, introduction and table of a group."""
    rows = [
        [f"**{told.kind}** {escaped(told.text)}", shown_code(code)]
        for own, code, told in results()
        if own is group and told
    ]
    text = f"{group.text} The code begins with the names of [{SETUPS[group.setup].title}](#names-in-the-code)."
    return [f"## {group.title}", wrapped(text), table(["message", "code that raises it"], rows)]


HEAD = f"""# All messages, with code that raises them

Errors, warnings and lines of the log, by the time when they appear. Search this page for a few words of the message
that you read: the code on its right raises it, and so shows what is wrong in yours. What to do is in the message; more
about causes and remedies is in [all messages](coupling/README.md#all-messages).

`InputError` says that an argument is invalid, `FilmError` that a film could not be evaluated, `RunError` that a run
failed for another reason. Names that end in `Warning` are warnings: the call goes on. "log" is a line of the logger
`exudyn_ehd`, "printed" what the code prints of an error that a result keeps.

*This page is made by `{COMMAND}`, which runs all of the code; a test compares.*
"""


def page():
    """The whole text."""
    titles = ["Names in the code", *(group.title for group in GROUPS), LEFT]
    texts = [HEAD, "\n".join(f"- [{title}](#{anchor(title)})" for title in titles)]
    texts += ["## Names in the code", NAMES]
    for setup in SETUPS.values():
        title = f"{setup.title[0].upper()}{setup.title[1:]}"
        texts += [f"{title}, after {SETUPS[setup.after].title}:" if setup.after else f"{title}:"]
        texts += [f"```python\n{setup.code.strip()}\n```"]
    for group in GROUPS:
        texts += group_text(group)
    # without the name of what says it, which is a value
    rest = {re.sub(r"^\.\.\.:? ", "", escaped(site.text)) for site in without_example()}
    rest = sorted(text for text in rest if len(text.replace("...", "").split()) > 3)
    texts += [f"## {LEFT}", REST, "\n".join(f"- {text}" for text in rest)]
    return "\n\n".join(text.strip("\n") for text in texts) + "\n"


NUMBER = re.compile(r"-?\d+(?:\.\d*)?(?:e[+-]?\d+)?")


def is_same(line, other):
    """Return whether two lines of the page differ in no more than round-off of numbers, which machines differ in."""
    numbers = [list(map(float, NUMBER.findall(text))) for text in (line, other)]
    pairs = zip(*numbers, strict=True) if len(numbers[0]) == len(numbers[1]) else [(0.0, 1.0)]
    close = all(math.isclose(*pair, rel_tol=ROUNDING, abs_tol=ZERO) for pair in pairs)
    return close and NUMBER.sub("", line) == NUMBER.sub("", other)


# Printed numbers have three digits or more; compilers and libraries of linear algebra change the last.
ROUNDING = 0.02
# Motions that are zero but for round-off, in clearances and radians.
ZERO = 1e-11
LEFT = "Messages without an example"
NAMES = "Every section says with the names of which of these blocks its code begins."
REST = wrapped(
    'The texts of all other messages, with "..." for values. They need folders that can\'t be written, an object of '
    "Exudyn without matrices, or a solver or a search that gives up."
)


if __name__ == "__main__":
    assert not silent(), "these examples tell nothing:\n\n" + "\n\n".join(silent())
    PAGE.write_text(page(), encoding="utf-8")
    print(f"{PAGE}: {len(sites())} sites, {len(without_example())} of them without an example")
