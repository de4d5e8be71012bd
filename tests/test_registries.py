"""One rule for all that other packages add: a name is taken once, what is broken costs itself."""

from __future__ import annotations

import sys
import threading
from importlib.metadata import EntryPoint
from types import ModuleType, SimpleNamespace

import pytest

from kineme._util.checks import Registry
from kineme.errors import KinemeWarning, ParameterError
from kineme.evaluation.score import SCORES
from kineme.formats.dialects import DIALECTS
from kineme.formats.registry import FORMATS
from kineme.labels.registry import FORMATS as LABEL_FORMATS
from kineme.methods.presets import PRESETS

GROUP = "example.tools"


class Tool(SimpleNamespace):
    name: str


def tools(**options) -> Registry[Tool]:
    return Registry(Tool, "tool", GROUP, **options)


@pytest.fixture
def plugin(monkeypatch):
    """A module of another package, which `offer` names objects of in the group of tools."""
    module = ModuleType("somebodys_tools")
    monkeypatch.setitem(sys.modules, "somebodys_tools", module)

    def offer(**named: object) -> None:
        points = []
        for name, value in named.items():
            setattr(module, name, value)
            points.append(EntryPoint(name, f"somebodys_tools:{name}", GROUP))
        points.append(EntryPoint("absent", "somebodys_tools:nothing", GROUP))
        monkeypatch.setattr("importlib.metadata.entry_points", lambda group: points)

    return offer


@pytest.mark.parametrize("newest_first", [False, True])
def test_a_name_that_is_taken_stays_unless_it_is_to_be_replaced(newest_first) -> None:
    registry = tools(newest_first=newest_first)
    saw, axe, other = Tool(name="saw"), Tool(name="axe"), Tool(name="saw")
    registry.register(saw)
    registry.register(axe)
    for again in (saw, other):
        with pytest.raises(ParameterError, match="a tool named 'saw' exists already"):
            registry.register(again)
    assert registry["saw"] is saw
    registry.register(other, replace=True)
    assert registry["saw"] is other
    assert list(registry) == (["axe", "saw"] if newest_first else ["saw", "axe"])
    registry.remove("saw")
    assert list(registry) == ["axe"]
    with pytest.raises(ParameterError, match="register takes a Tool, not str: see "):
        registry.register("saw")


def test_a_broken_plugin_costs_itself_only_and_is_named(plugin) -> None:
    saw, axe, file = (Tool(name=name) for name in ("saw", "axe", "file"))
    plugin(b_saw=saw, c_saw=Tool(name="saw"), d_text="saw", e_two=(axe, file))
    registry = tools()
    with pytest.warns(KinemeWarning) as caught:
        assert list(registry) == ["saw", "axe", "file"]
    assert registry["saw"] is saw
    told = [str(one.message) for one in caught]
    assert [text.split(" was skipped")[0] for text in told] == [
        f"{name!r} of {GROUP}" for name in ("absent", "c_saw", "d_text")
    ]
    assert "a tool named 'saw' exists already" in told[1]
    assert list(registry) == ["saw", "axe", "file"]  # looked up, and warned of, once


@pytest.mark.filterwarnings("ignore:'absent'")
def test_a_plugin_may_register_what_it_names_while_it_is_loaded(plugin) -> None:
    registry, saw = tools(), Tool(name="saw")

    class Late:
        def __get__(self, module, owner):
            registry.register(saw)
            return saw

    plugin(saw=saw)
    module = sys.modules["somebodys_tools"]
    del module.saw
    module.__class__ = type("Module", (ModuleType,), {"saw": Late()})
    assert dict(registry) == {"saw": saw}


@pytest.mark.filterwarnings("ignore:'absent'")
def test_all_threads_see_the_whole_registry(plugin) -> None:
    plugin(**{f"tool_{i}": Tool(name=f"{i}") for i in range(50)})
    registry, lengths = tools(), []
    threads = [threading.Thread(target=lambda: lengths.append(len(registry))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert lengths == [50] * 8


@pytest.mark.parametrize("registry", [FORMATS, DIALECTS, LABEL_FORMATS, PRESETS, SCORES])
def test_the_packages_own_are_there_by_their_names(registry) -> None:
    assert all(name == one.name for name, one in registry.items())
    name, one = next(iter(registry.items()))
    with pytest.raises(
        ParameterError, match="exists already: choose another name or set replace=True"
    ):
        registry.register(one)
    assert name in repr(registry)
