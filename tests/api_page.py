"""The page of all public names, `exudyn_ehd/API.md`, made of signatures and docstrings.

``python -m tests.api_page`` writes it; `tests/test_api_page.py` tells when it has to be written again.
"""

import dataclasses
import inspect
import math
import pathlib
import re
import textwrap
from typing import NamedTuple

import exudyn_ehd as ehd
from exudyn_ehd.coupling.record.history import _PARTS as COMPONENTS

PAGE = pathlib.Path(ehd.__file__).with_name("API.md")
COMMAND = "python -m tests.api_page"


class Group(NamedTuple):
    """Public names for one task.

    Attributes
    ----------
    title, text : str
        Heading, and what stands below it: which guide tells more.
    names : str
        Public names in the order of the page.
    methods : str
        Classes whose methods are listed too.
    """

    title: str
    text: str
    names: str
    methods: str = ""


GROUPS = (
    Group(
        "Describe a bearing",
        "`JournalBearing` takes all options below. What is not named is not computed. Which option a bearing needs: "
        "[table in the project's README](../README.md#which-options-do-i-need).",
        "JournalBearing SphericalBearing TiltingPads Lubricant oil",
    ),
    Group(
        "Oil: how viscosity and density change",
        "Arguments of `Lubricant`.",
        "BarusPressure RoelandsPressure ReynoldsTemperature VogelTemperature WaltherTemperature TableViscosity "
        "CarreauShear DowsonHigginson",
    ),
    Group(
        "Film and cavitation",
        "Arguments `film`, `cavitation`, `inlet`, `arc` and `turbulence` of `JournalBearing`. Errors and times of the "
        "films: [accuracy and speed](../README.md#accuracy-and-speed).",
        "FiniteLength ShortBearing LongBearing ImpedanceMap ClassicSOR SwiftStieber ElrodAdams Gumbel FullSommerfeld "
        "Periodic MaximumGap Arc Dam two_lobe three_lobe offset_halves pressure_dam NgPan Hirs",
    ),
    Group(
        "Oil supply and end faces",
        "Arguments `supply`, `end_seals` and `thrust` of `JournalBearing`; "
        "[thrust faces in a model](coupling/README.md#thrust-faces).",
        "AxialGroove CircumferentialGroove Hole Pocket Orifice Capillary GivenFlow EndSeal ThrustFaces TaperLand "
        "StepLand",
    ),
    Group(
        "Tilting thrust pads",
        "[Tilting thrust pads](coupling/README.md#tilting-thrust-pads): a bearing of its own beside journal bearings.",
        "TiltingThrustPads CreateTiltingPadThrustBearing TiltingPadThrustBearing ThrustPadsResult",
        "ThrustPadsResult",
    ),
    Group(
        "Surfaces: shape, roughness, contact, wear",
        "Arguments `profile`, `roughness`, `asperity`, `contact` and `wear` of `JournalBearing`. `d` is the depth that "
        "a profile adds to the gap.",
        "Crown EdgeRelief OutOfRound AxialProfile ProfileTable WornArc PatirCheng GreenwoodTripp composite_modulus "
        "RegularisedWall ArchardWear",
    ),
    Group(
        "Heat",
        "Argument `thermal` of `JournalBearing`.",
        "LumpedThermal FilmEnergy Conduction Sump",
    ),
    Group(
        "Put it into a model",
        "Which bodies a joint can hold, and how: [joints in an Exudyn model](coupling/README.md). The first arguments "
        "are those of Exudyn's own joints.",
        "CreateLubricatedJoint CreateLubricatedSphericalJoint CreateTiltingPadBearing ReplaceJoint ReplaceJoints "
        "ReplaceReducedBody Free Held LubricatedJoint LubricatedSphericalJoint TiltingPadJoint File Every Period",
    ),
    Group(
        "Run",
        "Settings, starts, restarts: [steps, starts and restarts](coupling/README.md#steps-starts-and-restarts).",
        "ConfigureSolver SolveDynamic SolveStatic SolveDynamicSparse FactorReuse StepControl UntilPeriodic LastCycle "
        "SaveState SystemState JointState show_progress",
    ),
    Group(
        "Look at results",
        "Tables, files and pictures: [results and plots](../README.md#results-and-plots); which effects mattered: "
        "[the audit](joint/README.md#the-audit). Columns of a history: [below](#columns-of-a-joints-history). "
        "`FilmFields` and `SteadyResult` have the `plot_...` methods of a film too, `JointHistory` those of a history.",
        "JointHistory SphericalHistory TiltingPadHistory Revolutions Quantity load_history FilmFields Audit Finding",
        "LubricatedJoint LubricatedSphericalJoint TiltingPadJoint JointHistory Audit",
    ),
    Group(
        "Static questions: one film, no multibody model",
        "[One bearing](joint/README.md).",
        "steady SteadyResult ThrustResult equilibrium EquilibriumResult TiltingPadResult stribeck StribeckResult "
        "steady_spherical SphericalResult solve_film FilmResult bearing_grid slider_grid Status",
        "SteadyResult EquilibriumResult TiltingPadResult StribeckResult SphericalResult",
    ),
    Group(
        "Rotors",
        "[Rotors in several films](coupling/README.md#rotors-in-several-films).",
        "SolveEquilibrium SolveThreshold stability_map RotorResult",
        "RotorResult",
    ),
    Group(
        "Bushes and journals that deflect",
        "Arguments `bush` and `journal` of `JournalBearing`; which one to take: "
        "[choosing a bush](solid/README.md#choosing-a-bush), [elastic journals](solid/README.md#elastic-journals), "
        "[your own finite-element bore](coupling/README.md#your-own-finite-element-bore).",
        "ElasticLiner ModalBush ANCFBush FEBore add_bore_modes BoreModesReport ElasticJournal HeldEnds HeldBands "
        "FEJournal SaintVenantKirchhoff NeoHooke Rayleigh",
    ),
    Group(
        "Meshes of bushes",
        "[A bush from a mesh of your own](solid/README.md).",
        "HollowCylinder BushMesh mesh_from_file mesh_from_fem mesh_from_arrays OnCylinder OnPlane",
        "HollowCylinder BushMesh",
    ),
    Group(
        "A bush as an object of its own, without a film",
        "[A bush of finite elements](solid/README.md#a-bush-of-finite-elements-as-an-object-of-its-own).",
        "CreateFlexibleBush FlexibleBush FixedOuter CarriedOuter FreeOuter Support LineLoad SurfaceLoad DeadPressure "
        "FollowerPressure Gravity",
        "FlexibleBush",
    ),
    Group(
        "Studies",
        "[Studies](studies/README.md): which film and how many steps keep an error, results over parameters.",
        "recommend Recommendation recommend_steps StepRecommendation parameter_study EquilibriumPoint varied "
        "StudyTable",
        "StudyTable",
    ),
    Group(
        "Errors and warnings",
        "Every message with its cause: [all messages](coupling/README.md#all-messages); with code that raises it: "
        "[messages](MESSAGES.md).",
        "EHDError InputError FilmError RunError PlausibilityWarning GridWarning ThinFilmWarning OverloadWarning "
        "HotFilmWarning StarvationWarning StrainWarning RingingWarning MemoryWarning",
    ),
)
# Public for the package itself.
INNER = {"of_columns", "extremes", "sample_gradients", "restore_state", "state"}


class Entry(NamedTuple):
    """One entry of a numpydoc section: its names, its type as written, the lines below it in one."""

    names: tuple[str, ...]
    kind: str
    text: str


def section(item, title):
    """Entries of a section of a docstring; None if there is no such section."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\S[^\n]*\n-+$|\Z)", inspect.getdoc(item) or "", re.M | re.S)
    if found is None:
        return None
    entries = []
    for line in found[1].splitlines():
        if re.match(r"[\w*]", line):
            names, _, kind = line.partition(" : ")
            entries.append(Entry(tuple(names.split(", ")), kind, ""))
        elif line.strip() and entries:
            entries[-1] = entries[-1]._replace(text=f"{entries[-1].text} {line.strip()}".strip())
    return entries


def default_text(value):
    """A default value as docstrings and the page write it."""
    if isinstance(value, float) and math.isfinite(value):
        if value == 0.5 * math.pi:
            return "pi / 2"
        digits = repr(value) if 1e-3 <= abs(value) < 1e5 or value == 0.0 else f"{value:.6g}"
        return re.sub(r"e([+-])0*(\d)", lambda m: "e" + m[1].strip("+") + m[2], digits)
    if isinstance(value, str):
        return f'"{value}"'
    if type(value) is tuple:
        inner = ", ".join(map(default_text, value))
        return f"({inner},)" if len(value) == 1 else f"({inner})"
    if dataclasses.is_dataclass(value) and value == type(value)():
        return f"{type(value).__name__}()"
    # Exudyn's enumerations have a repr in angle brackets
    return str(value)


def parameters(item):
    """Arguments of a call or of a class by name, without `self`, `*args` and `**options`."""
    found = inspect.signature(item).parameters.values()
    return {p.name: p for p in found if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD) and p.name != "self"}


def callables():
    """(name, item) of everything public whose docstring has parameters: functions, classes, methods of classes."""
    for name in ehd.__all__:
        item = getattr(ehd, name)
        members = inspect.getmembers(item, inspect.isfunction) if inspect.isclass(item) else []
        for label, own in [(name, item), *((f"{name}.{label}", own) for label, own in members if label[0] != "_")]:
            if section(own, "Parameters") is not None:
                yield label, own


def call_text(item):
    """Arguments with their defaults: first those that have to be given, last those that are None by default."""
    entries = section(item, "Parameters") or ()
    required = {name for e in entries if e.text.startswith("Required") for name in e.names}
    gone = {name for e in entries if e.kind.startswith("not supported") for name in e.names}
    known = [p for p in parameters(item).values() if p.name not in gone]
    defaults = {p.name: p.empty if p.name in required else p.default for p in known}
    texts = [name for name, value in defaults.items() if value is inspect.Parameter.empty]
    texts += [
        f"{name}={default_text(value)}"
        for name, value in defaults.items()
        if value is not None and value is not inspect.Parameter.empty
    ]
    absent = [name for name, value in defaults.items() if value is None]
    said = [f"`{', '.join(texts)}`"] if texts else []
    return "; ".join([*said, f"None: `{', '.join(absent)}`"] if absent else said)


def detail(name):
    """Return what the third column of the page says of a public name."""
    item = getattr(ehd, name)
    if inspect.isfunction(item) or section(item, "Parameters") is not None:
        return call_text(item)
    if (held := section(item, "Attributes")) is not None:
        if name in TABLES:
            return f"holds [these columns](#{anchor(TABLES[name].split(chr(10))[0][3:])})"
        names = [name for entry in held for name in entry.names]
        return f"holds `{', '.join(names)}`"
    return ""


def summary(item):
    """The first paragraph of a docstring as a line of a table."""
    return cell(" ".join((inspect.getdoc(item) or "").split("\n\n")[0].split()))


def table(head, rows):
    """A table in Markdown; columns that are empty throughout are left out."""
    kept = [k for k in range(len(head)) if any(row[k] for row in rows)]
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line[k] for k in kept) + " |" for line in lines)


def methods(name, listed):
    """Rows of the public methods and properties of a class, without those that are listed already."""
    cls = getattr(ehd, name)
    for label in sorted(label for label in dir(cls) if label[0] != "_" and label not in INNER):
        item = inspect.getattr_static(cls, label)
        if item in listed:
            continue
        listed.append(item)
        if inspect.isfunction(item):
            shown = ", ".join(
                p.name if p.default is p.empty else f"{p.name}={default_text(p.default)}"
                for p in parameters(item).values()
            )
            yield [f"`{name}.{label}({shown})`", summary(item)]
        elif isinstance(item, property) or hasattr(item, "attrname"):
            yield [f"`{name}.{label}`", summary(getattr(item, "func", item))]


def columns(cls):
    """(name, unit, meaning, sign or frame) of the columns of a history or a table of it, from its docstring."""
    for entry in section(cls, "Attributes"):
        if unit := re.search(r"\(\w+,.*\) \[(.*)\]$", entry.kind):
            meaning, _, sign = entry.text.partition(". ")
            for name in entry.names:
                yield name, unit[1], meaning.rstrip("."), sign


def column_table(cls):
    """The table of these columns."""
    rows = [[f"`{name}`", unit, *map(cell, texts)] for name, unit, *texts in columns(cls)]
    return table(["column", "unit", "meaning", "sign, frame, where it is nan"], rows)


def cell(text):
    """A text of a docstring in a table."""
    return re.sub(r"`+([^`]+)`+", r"`\1`", text).replace("|", r"\|")


HEAD = f"""# All public names

Every name of `exudyn_ehd`, by task, one line each; then the columns of histories. `import exudyn_ehd as ehd` is taken
for granted: `steady` is `ehd.steady`. The whole text about a name, with units, ranges, equations and an example, is
shown by `help(ehd.steady)`. The first steps are in [the project's README](../README.md).

All numbers are SI: metres, seconds, pascals above ambient, radians, kelvin. Arguments without a value are required;
those named after "None:" are None by default, which means: absent, or chosen by the package.

*This page is made of signatures and docstrings by `{COMMAND}`; a test compares.*
"""
PARTS = "; ".join(f"`{name}` into `{', '.join(parts)}`" for name, parts in COMPONENTS.items() if name != "eccentricity")
# Classes with columns: what stands above their tables.
TABLES = {
    "JointHistory": f"""## Columns of a joint's history

`joint.history` has an array for each, one row per accepted step, first the initial state. Vectors are in the joint
frame, which is fixed in the housing: origin on the bearing's mid-plane, z along its axis. Forces act on the journal. A
quantity that the bearing's film does not have is nan.

In files of `to_csv` and in data frames, vectors are split into columns: {PARTS}. `eccentricity` is left out there: it
is `x, y`.

Fields over the surface, such as pressure, temperature and `wear_depth`, are no columns of a history: `joint.film()` has
them at the last step, `joint.films` at those that `joint.record_films()` has kept.""",
    "Revolutions": """## Columns of the table of revolutions

`joint.revolutions()`: a row for every whole revolution, or for every `period`.""",
    "SphericalHistory": """## Columns of a ball joint's history

Frame of the socket: origin in its centre, z along its axis. Forces act on the ball.""",
}


def page():
    """The whole text."""
    texts, listed = [HEAD, "\n".join(f"- [{title}](#{anchor(title)})" for title in titles())], []
    for group in GROUPS:
        rows = [[f"`{name}`", summary(getattr(ehd, name)), detail(name)] for name in group.names.split()]
        head = ["name", "what it is or does", "arguments with defaults, or what it holds"]
        texts += [f"## {group.title}", wrapped(group.text), table(head, rows)]
        if group.methods:
            rows = [row for name in group.methods.split() for row in methods(name, listed)]
            texts.append(table(["method or property", "what it gives"], rows))
    for name, text in TABLES.items():
        texts += [*map(wrapped, text.split("\n\n")), column_table(getattr(ehd, name))]
    return "\n\n".join(text.strip("\n") for text in texts) + "\n"


def wrapped(text):
    """A paragraph in lines of a readable length."""
    return textwrap.fill(text, 118, break_long_words=False, break_on_hyphens=False)


def titles():
    """Headings of the page."""
    return [group.title for group in GROUPS] + [text[3:].split("\n")[0] for text in TABLES.values()]


def anchor(title):
    """Anchor that GitHub makes of a heading."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"{PAGE}: {len(ehd.__all__)} names")
