"""What other packages register is offered by the studio and can be used there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

from kineme.errors import ReadError
from kineme.labels import LabelFormat
from kineme.labels import register as register_labels
from kineme.labels import registry as labels
from kineme.methods import Preset, constant, presets, register
from kineme.methods.constants import Limits
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment


class Halves:
    """What a toy method finds: two activities."""

    timings: ClassVar[dict[str, float]] = {}

    def __init__(self, n: int, cut: int):
        self.n, self.cut = n, cut

    def columns(self) -> dict[str, Any]:
        return {
            "level": np.array(["activity"] * 2),
            "kind": np.array(["activity"] * 2),
            "start_frame": np.array([0, self.cut]),
            "stop_frame": np.array([self.cut, self.n]),
        }

    def doubts(self, *_: object) -> list[str]:
        return []


@dataclass(frozen=True, kw_only=True)
class ToyPreset(Preset):
    """Cuts once."""

    method: ClassVar[str] = "toy"
    units: ClassVar[tuple[str, ...]] = ("any",)
    where: float = constant("where it cuts", limits=Limits(0.1, 0.9), slider=(0.1, 0.9, 0.1))
    often: float | None = constant("not set", default=None, slider=(0.0, 1.0, 0.1))

    def analyze(self, features: Any, **_: object) -> Halves:
        return Halves(len(features), round(self.where * len(features)))


@pytest.fixture
def toy_preset() -> Iterator[Preset]:
    toy = ToyPreset(name="toy", help="Cuts a recording once.", unit="any", where=0.5)
    register(toy)
    yield toy
    presets.PRESETS.remove("toy")


def test_a_preset_of_another_package_is_offered_with_its_help_and_sliders(
    studio, toy_preset
) -> None:
    choices = {each["name"]: each for each in studio.get("/api/state").json()["presets"]}
    assert choices["toy"]["help"] == "Cuts a recording once."
    (offered,) = choices["toy"]["parameters"]
    assert (offered["name"], offered["help"], offered["value"]) == ("where", "where it cuts", 0.5)
    assert (offered["minimum"], offered["maximum"], offered["step"]) == (
        pytest.approx(0.1), 0.9, 0.1
    )  # fmt: skip
    again = studio.done(1, "segment", preset="toy", parameters={"where": 0.25})
    assert studio.starts() == [0, 60]
    assert again["segmentation"]["provenance"]["preset"] == "toy"
    refused = studio.edit(again["revision"], "segment", preset="toy", parameters={"where": 0.95})
    assert "where can be 0.1 to 0.9, not 0.95" in refused.json()["error"]
    compare = f"/api/recordings/{studio.id}/compare"
    other = studio.client.post(compare, json={"preset": "toy"}).json()["segmentation"]["segments"]
    assert [row["start_frame"] for row in other] == [0, 120]


def write_toy(segments: Sequence[Segment], _: Segmentation, path: Path) -> None:
    path.write_text("".join(f"{row.start_frame}\n" for row in segments))


def read_toy(path: Path) -> Segmentation:
    raise ReadError(path, "is not meant to be read")


@pytest.fixture
def toy_format() -> Iterator[LabelFormat]:
    toy = LabelFormat("toy", "First frames, one a line", (".toy",), "level", read_toy, write_toy)
    register_labels(toy)
    yield toy
    labels.FORMATS.remove("toy")


def test_a_label_format_of_another_package_is_offered_and_written(
    studio, toy_format, folder: Path
) -> None:
    state = studio.get("/api/state").json()
    offered = {each["name"]: each for each in state["export_formats"]}["toy"]
    assert offered == {"name": "toy", "suffix": ".toy", "help": "First frames, one a line"}
    answer = studio.get(f"/api/recordings/{studio.id}/export/toy?level=primitive")
    assert answer.headers["content-disposition"].endswith("take.primitives.toy")
    assert answer.text.split() == [str(start) for start in studio.starts("primitive")]
    studio.client.post("/api/recordings?name=said.toy", content=b"0\n")
    state = studio.get("/api/state").json()
    assert [file["name"] for file in state["annotations"]] == ["said.toy"]
    (said,) = state["annotations"]
    sent = {"annotation": said["id"]}
    refused = studio.client.post(f"/api/recordings/{studio.id}/compare", json=sent)
    assert "is not meant to be read" in refused.json()["error"]
