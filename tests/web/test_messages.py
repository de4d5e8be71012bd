"""The pages and the package speak of the same messages."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import msgspec
import pytest

from kineme.errors import ParameterError
from kineme.web.encoding import from_json, to_json
from kineme.web.requests import EditRequest, MoveBorder

Side = Literal["left", "right"]


class Foot(msgspec.Struct, tag_field="kind", tag="foot"):
    """A foot."""

    side: Side
    at: tuple[float, float]
    toes: list[str | None]
    more: dict[str, Any]
    size: float | msgspec.UnsetType = msgspec.UNSET


@pytest.fixture(scope="module")
def maker(page_script: Callable[[str], dict[str, Any]]) -> dict[str, Any]:
    return page_script("make_messages.py")


def test_typescript_is_up_to_date(maker: dict[str, Any]) -> None:
    for path, made in maker["make_files"]().items():
        assert path.read_text(encoding="utf-8") == made, "run src/kineme/web/pages/make_messages.py"


def test_what_becomes_of_each_kind_of_type(maker: dict[str, Any]) -> None:
    assert maker["format_typescript"]({"Side": Side, "Foot": Foot}).endswith(
        """\
export type Side = "left" | "right";

/** A foot. */
export interface Foot {
  kind: "foot";
  side: Side;
  at: [number, number];
  toes: (string | null)[];
  more: Record<string, unknown>;
  size?: number;
}
"""
    )


def test_unknown_types_are_refused(maker: dict[str, Any]) -> None:
    class Bytes(msgspec.Struct):
        """Bytes, which JSON has not."""

        data: bytes

    with pytest.raises(TypeError, match="Bytes"):
        maker["format_typescript"]({"Bytes": Bytes})


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("[]", "the request: expected object, got array"),
        ('{"edit": {"kind": "undo"}}', "the request: object missing required field revision"),
        ('{"revision": "1", "edit": {"kind": "undo"}}', "revision: expected int, got str"),
        ('{"revision": 1, "edit": {"kind": "dance"}}', "edit.kind: invalid value 'dance'"),
        (
            '{"revision": 1, "edit": {"kind": "split", "level": "floor", "frame": 1}}',
            "edit.level: invalid enum value 'floor'",
        ),
        (
            '{"revision": 1, "edit": {"kind": "name_cluster", "cluster": 1, "label": "%s"}}'
            % ("a" * 501),
            "edit.label: expected str of length <= 500",
        ),
        (
            '{"revision": 9007199254740993, "edit": {"kind": "undo"}}',
            "revision: expected int <= 9007199254740992",
        ),
        ("{", "the request does not hold JSON"),
    ],
)
def test_what_is_wrong_with_a_request_is_one_sentence(body: str, said: str) -> None:
    with pytest.raises(ParameterError) as caught:
        from_json(body.encode(), EditRequest)
    assert str(caught.value) == said


def test_requests_come_back_as_they_were_sent() -> None:
    sent = EditRequest(revision=3, edit=MoveBorder(level="activity", frame=3, to=5))
    assert from_json(to_json(sent), EditRequest) == sent
