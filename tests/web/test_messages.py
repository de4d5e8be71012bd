"""The pages and the package speak of the same messages."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any, Literal, TypedDict

import pytest

import kineme
from kineme.web import messages

Side = Literal["left", "right"]


class Foot(TypedDict):
    """A foot."""

    side: Side
    at: tuple[float, float]
    toes: list[str | None]
    more: dict[str, Any]


WEB = Path(kineme.__file__).parent / "studio" / "web"


@pytest.fixture(scope="module")
def maker() -> ModuleType:
    """The script that makes them; its folder is no package."""
    path = WEB / "make_messages.py"
    if not path.exists():
        pytest.skip("the sources of the pages are not in a wheel")
    spec = importlib.util.spec_from_file_location("make_messages", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_typescript_is_up_to_date(maker: ModuleType) -> None:
    made = (WEB / "src" / "messages.ts").read_text(encoding="utf-8")
    assert made == maker.typescript(messages), "run src/kineme/web/pages/make_messages.py"


def test_what_becomes_of_each_kind_of_type(maker: ModuleType) -> None:
    module = ModuleType("feet")
    module.Side, module.Foot = Side, Foot
    assert maker.typescript(module).endswith(
        """\
export type Side = "left" | "right";

/** A foot. */
export interface Foot {
  side: Side;
  at: [number, number];
  toes: (string | null)[];
  more: Record<string, unknown>;
}
"""
    )


def test_unknown_types_are_refused(maker: ModuleType) -> None:
    with pytest.raises(TypeError, match="bytes"):
        maker._type(bytes, {})
