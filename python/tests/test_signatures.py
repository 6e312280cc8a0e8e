"""Signatures of solves have the keywords of the lists of keys; run as a program, this file writes them anew."""

import ast
import inspect
import pathlib
import re
from typing import get_args, get_origin

import asperity
import pytest
from asperity.api import keywords
from asperity.common import types
from asperity.relaxation.viscoelastic import ELASTIC
from keys import KEYS

PACKAGE = pathlib.Path(asperity.__file__).parent
#: Keywords that Python alone has.
OTHERS = {
    "body": "Body | None = None",
    "against": "Heights | None = None",
    "start": "Start = None",
    "observe": "Callable[[Iteration], object] | None = None",
    "out": "str | PathLike[str] | None = None",
    "fields": "str | PathLike[str] | None = None",
    "force": "bool | None = False",
    "spring": "tuple[Quantity, Quantity] | None = None",
    "springs": "Iterable[tuple[Quantity, Quantity]] | None = None",
    "smooth": "bool | None = True",
    "prony": "Iterable[tuple[float, float]] | None = None",
    "times": "Iterable[float] | None = None",
}
CONTACT = ("Surface", "Adhesion", "Solver", "body", "against")
#: The lists of keys and the keywords of each method, and the keys of its lists that it does not have.
METHODS = {
    "solve": (("Load", "Nested", "Findings", "Conductor", "Accuracy", "start", "observe", "spring"), ()),
    "sweep": (
        ("Loads", "Fractions", "Stiffness", "Conductor", "Leakage", "start", "observe", "out", "force", "springs", "fields"),
        (),
    ),
    "cycle": (("Loads", "Path", "CycleAccuracy", "start", "observe", "out", "force", "springs", "smooth", "fields"), ()),
    "interface": (
        ("Loads", "Conductor", "Leakage", "start", "observe", "out", "force"),
        ("normal_forces", "approaches", "spring_stiffness", "spring_positions"),
    ),
    "pull_off": (("PullOff", "start", "observe"), ()),
    "viscoelastic": (
        ("start", "observe", "prony", "times", "Loads"),
        ("spring_stiffness", "spring_positions", "reduced_pressures"),
    ),
    "stability": (("Load", "spring"), ()),
}
#: The groups of keywords, what matters most first: loads, adhesion, surfaces, bodies, accuracy; all others come behind.
GROUPS = (
    "modulus mean_pressure mean_pressures mean_gap mean_gaps normal_force normal_forces approach approaches spring springs "
    "spring_stiffness spring_position spring_positions reduced_pressure reduced_pressures contact_fraction contact_fractions "
    "preload prony times law work_of_adhesion range exponent hamaker cut_off branch "
    "boundary absent_missing against against_modulus shift whole "
    "body layer base coating coating_modulus coating_poisson plate poisson hardness wall wall_stiffness "
    "accuracy accuracy_of memory nested tolerance"
).split()
#: The keywords of a contact that a function does not have.
WITHOUT = {"interface": ("boundary", "hardness"), "viscoelastic": ELASTIC}


def typed(text):
    """A keyword with the aliases of its words."""
    for name, alias in vars(types).items():
        if get_origin(alias) is types.Literal:
            words = ", ".join(f'"{word}"' for word in get_args(alias))
            text = text.replace(f"Literal[{words}]", name)
    return text


def keys_of(lists, without=()):
    """The keywords of lists of keys and of single names, each with its type and its default."""
    known = {}
    for name in lists:
        known.update(KEYS[name] if name in KEYS else {name: OTHERS[name]})
    return grouped({name: typed(text) for name, text in known.items() if name not in without})


def grouped(known):
    """Keywords by their groups."""
    place = lambda one: GROUPS.index(one[0]) if one[0] in GROUPS else len(GROUPS)
    return dict(sorted(known.items(), key=place))


def signatures():
    """The keywords of each function and method, by its name."""
    found = {"Contact.__init__": keys_of(CONTACT)}
    for name, (lists, without) in METHODS.items():
        found[f"Contact.{name}"] = keys_of(lists, without)
        of_contact = {} if name == "stability" else keys_of(CONTACT, WITHOUT.get(name, ()))
        found[name] = grouped({**of_contact, **found[f"Contact.{name}"]})
    return found


def function_of(name):
    owner, _, method = name.rpartition(".")
    return getattr(getattr(asperity, owner), method) if owner else getattr(asperity, name)


@pytest.mark.parametrize("name", signatures())
def test_signatures_have_the_keywords_of_the_lists(name):
    function = inspect.unwrap(function_of(name))
    found = {
        one.name: f"{one.annotation} = {one.default!r}".replace("'", '"')
        for one in inspect.signature(function).parameters.values()
        if one.kind is one.KEYWORD_ONLY and one.name != "axes"
    }
    expected = signatures()[name]
    assert list(found.items()) == list(expected.items()), f"run python {__file__}"


def entries(function):
    """The parameters that a docstring describes."""
    found = re.findall(r"^(\w[\w, ]*)(?: :|$)", inspect.getdoc(function) or "", re.MULTILINE)
    return [word.strip() for names in found for word in names.split(",")]


@pytest.mark.parametrize("name", signatures())
def test_each_keyword_is_described_with_its_function_or_with_solve(name):
    own, others = name.rpartition(".")[2].replace("__init__", "solve"), {"interface": ["sweep"]}
    described = {word for one in (own, "solve", *others.get(own, ())) for word in entries(getattr(asperity, one))}
    assert set(signatures()[name]) - described == set()


@pytest.mark.parametrize("name", signatures())
def test_keywords_are_described_in_the_order_of_the_signature(name):
    function = inspect.unwrap(function_of(name))
    described = [one for one in entries(function) if one in inspect.signature(function).parameters]
    assert described == [one for one in inspect.signature(function).parameters if one in described]


def test_parameters_of_laws_are_those_of_the_list():
    assert {"law", "wall", "wall_stiffness", "hardness", *keywords.OF_LAWS} == set(KEYS["Adhesion"])


def written(text, known):
    """The text of a module with the keywords of its functions."""
    lines = text.split("\n")
    nodes = [(node, owner) for owner in ast.walk(ast.parse(text)) for node in ast.iter_child_nodes(owner)]
    for node, owner in sorted(nodes, key=lambda both: -getattr(both[0], "lineno", 0)):
        name = "Contact." * isinstance(owner, ast.ClassDef) + str(getattr(node, "name", None))
        if isinstance(node, ast.FunctionDef) and name in known:
            keywords_of = [one for one in node.args.kwonlyargs if one.arg != "axes"]
            first, last = keywords_of[0], keywords_of[-1]
            rows = [f"{' ' * first.col_offset}{key}: {kind}," for key, kind in known[name].items()]
            lines[first.lineno - 1 : last.end_lineno] = rows
    return "\n".join(lines)


if __name__ == "__main__":
    for path in (PACKAGE / "api").glob("*.py"):
        path.write_text(written(path.read_text(encoding="utf-8"), signatures()), encoding="utf-8")
