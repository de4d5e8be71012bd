"""A package of somebody else's adds one of each; each is one module, found wherever it belongs.

So is what can be said of reading and of segmenting: one class each, which all others take.
"""

from __future__ import annotations

import inspect
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import kineme
from kineme._util.json import options_from_json, options_to_json
from kineme.cli.options import READING, SEGMENTING
from kineme.formats import ReadOptions
from kineme.library.planning import read_kept_options
from kineme.methods.segmenter import SegmentOptions
from kineme.studio.storage.sidecars import read_saved_options, write_reading
from kineme.synthesis import MotionGraph, Source, read_graph, write_graph
from kineme.web.encoding import from_json, to_json
from kineme.web.requests import ReadRequest
from plugins import install_package

METHOD = '''
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from kineme.methods.region_growing.neighbors import neighbor_graph
from kineme.methods import Preset, constant
from kineme.methods.base import Limits


@dataclass(frozen=True)
class Halves:
    """Two activities."""

    features: np.ndarray
    cut: int
    timings: ClassVar[dict[str, float]] = {}

    def columns(self):
        return {
            "level": np.array(["activity", "activity"]),
            "kind": np.array(["activity", "activity"]),
            "start_frame": np.array([0, self.cut]),
            "stop_frame": np.array([self.cut, len(self.features)]),
            "cluster": np.array([0, 1]),
            "confidence": np.full(2, np.nan),
        }

    @cached_property
    def graph(self):
        return neighbor_graph(self.features, radius=0.5, k=8)

    def doubts(self, columns, fps):
        return []


@dataclass(frozen=True, kw_only=True)
class HalvesPreset(Preset):
    """Cuts once."""

    method: ClassVar[str] = "halves"
    cut_share: float = constant(
        "where the one cut is", limits=Limits(0.1, 0.9), default=0.5, slider=(0.1, 0.9, 0.1)
    )

    def analyze(self, features, *, mirror=None, progress=None):
        return Halves(features, round(self.cut_share * len(features)))


PRESET = HalvesPreset(name="halves", help="Cuts a recording once.", unit="any")
'''

PRESET = """
from dataclasses import replace

from kineme.methods.kineme.preset import KINEME

PRESET = replace(KINEME, name="slowly", help="For slow exercises.", min_action=3.0)
"""

FORMAT = """
import numpy as np

from kineme.formats import Format
from kineme.recordings import Signals


def read(content, options):
    fps, *rows = content.text.splitlines()
    values = [[float(cell) for cell in row.split()] for row in rows]
    return Signals(values, options.fps or float(fps), provenance=content.provenance("PLAIN", []))


def write(signals, path):
    rows = [" ".join(map(repr, row)) for row in signals.values.tolist()]
    path.write_text("\\n".join([repr(signals.fps), *rows]))


FORMAT = Format("PLAIN", (".plain",), lambda head: False, read, write_signals=write)
"""

DIALECT = """
from kineme.formats.points import columns_to_motion
from kineme.formats.dialects import Dialect


def read(table, options):
    columns = dict(zip(table.names, table.numbers().T))
    named = {name: columns[f"{name[-1].upper()}.{name[:-2]}"] for name in ("hip_x", "hip_y")}
    return columns_to_motion(table.content, "axis first", named | columns, options)


DIALECT = Dialect("axis first", lambda names, lines: "X.hip" in names, read)
"""

LABELS = """
from kineme.labels import LabelFormat, Labels, Span


def read(path):
    rows = [line.split() for line in path.read_text().splitlines()]
    return Labels([Span(float(start), float(stop), text) for start, stop, text in rows])


def write(rows, segmentation, path):
    lines = [f"{row.start_s} {row.stop_s} {row.label or row.cluster}" for row in rows]
    path.write_text("\\n".join(lines))


FORMAT = LabelFormat("words", "Three words a line", (".words",), "level", read, write)
"""

SCORE = """
from kineme.evaluation import Score


def longest(compared):
    return max(run.stop - run.start for run in compared.found_runs) / compared.fps


SCORE = Score("longest", "longest found", "longest segment, seconds", "segments", longest)
"""

ENTRY_POINTS = """
[kineme.presets]
halves = somebody.halves:PRESET
slowly = somebody.slowly:PRESET

[kineme.formats]
plain = somebody.plain:FORMAT

[kineme.table_dialects]
axes = somebody.axes:DIALECT

[kineme.label_formats]
words = somebody.words:FORMAT

[kineme.scores]
longest = somebody.longest:SCORE
"""

STUDIO = """
import json, sys, time
from pathlib import Path
from starlette.testclient import TestClient
from kineme.studio.routes import create_app
from kineme.studio.http.events import Hub
from kineme.studio.folder import Folder
from kineme.studio.open_recordings import OpenRecordings

hub = Hub()
app = create_app(OpenRecordings(Folder(Path(sys.argv[1])), hub.tell), token="t", port=1, hub=hub)
client = TestClient(app, base_url="http://127.0.0.1:1", headers={"x-kineme-token": "t"})
state = client.get("/api/state").json()
(recording,) = state["recordings"]
opened = f"/api/recordings/{recording['id']}"
while (first := client.get(opened).json())["finding"]:  # no edits before segments are there
    time.sleep(0.05)
edit = {"kind": "segment", "preset": "halves", "parameters": {"cut_share": 0.3}}
done = client.post(f"{opened}/edits", json={"revision": first["revision"], "edit": edit}).json()
words = client.get(f"{opened}/export/words?level=activity").text
print(json.dumps({"state": state, "done": done, "words": words}))
"""

COMMANDS = """
import json, sys
from typer.testing import CliRunner
from kineme.cli.app import app

done = []
for arguments in json.load(sys.stdin):
    ran = CliRunner().invoke(app, arguments)
    done.append([ran.exit_code, ran.stdout, ran.stderr])
json.dump(done, sys.stdout)
"""
"""Runs commands one after the other in one process: each process takes seconds to start."""

Run = Callable[..., str]


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package as an installer leaves it: modules, and a folder that names its objects."""
    home = tmp_path_factory.mktemp("site")
    (home / "somebody").mkdir()
    modules = {"halves": METHOD, "slowly": PRESET, "plain": FORMAT, "axes": DIALECT,
               "words": LABELS, "longest": SCORE}  # fmt: skip
    for name, text in modules.items():
        (home / "somebody" / f"{name}.py").write_text(text)
    install_package(home, "somebody", ENTRY_POINTS)
    return home


@pytest.fixture(scope="module")
def place(package: Path) -> Path:
    """A folder to run in, with a recording of 40 s and labels in formats of the package."""
    place = package / "place"
    for name in ("recordings", "labels"):
        (place / name).mkdir(parents=True)
    rows = [f"{i % 30} {(i * 7) % 50}" for i in range(1200)]
    (place / "recordings" / "a.plain").write_text("\n".join(["30", *rows]))
    (place / "labels" / "a.words").write_text("0 20 slow\n20 40 fast\n")
    rows = [f"{i / 30};{i * 2 + 1};{i}" for i in range(40)]
    (place / "axes.csv").write_text("\n".join(["time;X.hip;Y.hip", *rows]))
    return place


@pytest.fixture(scope="module")
def python(package: Path, place: Path) -> Run:
    """Run Python where that package is installed; what it prints."""
    ours = Path(kineme.__file__).parents[1]

    def run(*arguments: object, given: str = "") -> str:
        done = subprocess.run(
            [sys.executable, "-W", "error", *map(str, arguments)],
            input=given,
            capture_output=True,
            text=True,
            cwd=place,
            env={**os.environ, "PYTHONPATH": f"{package}{os.pathsep}{ours}", "COLUMNS": "400",
                 "NO_COLOR": "1"},
            check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="module")
def printed(python: Run) -> dict[str, str]:
    """Run commands where that package is installed; what each prints."""
    recording, halves = "recordings/a.plain", "--preset halves --set cut_share=0.25"
    scores = "evaluate recordings --labels labels --methods halves,slowly --json"
    commands = [
        *("segment --help", "presets", "presets halves", "convert --help", "info axes.csv", scores),
        *(f"segment {recording} {halves} -o a.words", "convert a.words b.csv --fps 30"),
        *("convert b.csv b.words --fps 30", f"convert {recording} c.csv", "convert c.csv c.plain"),
        "segment recordings --preset slowly -o {name}.json",
    ]
    done = json.loads(python("-c", COMMANDS, given=json.dumps([each.split() for each in commands])))
    assert [code for code, _, _ in done] == [0] * len(commands), done
    return {command: said for command, (_, said, _) in zip(commands, done)} | {"scores": done[5][1]}


def test_its_method_preset_and_constants_stand_in_the_help(printed: dict[str, str]) -> None:
    text = printed["segment --help"]
    assert "halves, slowly" in " ".join(text.split())
    assert "halves       Cuts a recording once." in printed["presets"]
    assert "slowly       For slow exercises." in printed["presets"]
    line = "cut_share\t0.5\t\t0.1 to 0.9\t0.5\t\twhere the one cut is"
    assert line in printed["presets halves"]
    assert "PLAIN" in text
    assert ".words" in text
    assert "words" in printed["convert --help"]


def test_its_files_are_read_segmented_and_converted(printed, place: Path) -> None:
    for name in ("a.words", "b.words"):
        assert (place / name).read_text().splitlines() == ["0.0 10.0 0", "10.0 40.0 1"]
    made = json.loads((place / "a.json").read_text())
    assert made["provenance"]["parameters"]["min_action"] == 3.0
    sent, again = (
        [[float(each) for each in row.split()] for row in (place / name).read_text().splitlines()]
        for name in ("recordings/a.plain", "c.plain")
    )
    assert sent == again  # the frame rate, and all values


def test_its_tables_are_read(printed: dict[str, str]) -> None:
    assert "axis first" in printed["info axes.csv"]
    assert "40 frames" in printed["info axes.csv"]


def test_its_methods_are_scored_by_its_score_on_its_recordings(printed: dict[str, str]) -> None:
    scored = json.loads(printed["scores"])
    assert scored["methods"]["halves"]["scores"]["longest"] == 20.0
    assert scored["methods"]["halves"]["scores"]["mof"] == 1.0
    assert "longest" in scored["methods"]["slowly"]["scores"]


def test_the_studio_offers_all_of_it(python: Run) -> None:
    told = json.loads(python("-c", STUDIO, "recordings"))
    presets = {each["name"]: each for each in told["state"]["presets"]}
    (slider,) = presets["halves"]["parameters"]
    assert (slider["name"], slider["help"]) == ("cut_share", "where the one cut is")
    assert "min_action" in [each["name"] for each in presets["slowly"]["parameters"]]
    assert "words" in [each["name"] for each in told["state"]["export_formats"]]
    starts = [row["start_frame"] for row in told["done"]["segmentation"]["segments"]]
    assert starts == [0, 360]
    # Neither half is mostly the one cluster of before, so both have numbers of their own.
    assert told["words"].splitlines() == ["0.0 12.0 1", "12.0 40.0 2"]


def test_options_are_the_keywords_of_read_and_segment() -> None:
    of_read = {*inspect.signature(kineme.read).parameters} - {"path"}
    # Of rows of numbers fps and times say what a recording says itself.
    of_rows = {"recording", "fps", "times"}
    of_segment = {*inspect.signature(kineme.segment).parameters} - {*of_rows, "progress"}
    assert {*vars(ReadOptions())} == of_read == {*READING}
    assert {*vars(SegmentOptions())} == of_segment > {*SEGMENTING}


def test_every_option_is_kept_in_files_and_sent(tmp_path: Path) -> None:
    skeleton = str(tmp_path / "walk.asf")
    said = ReadOptions(skeleton, 30.0, 0.01, "-z", "Anna", 0.5, ["acc_*"], True, "run")
    method = SegmentOptions(
        preset="sensors",
        constants={"bands": (0.5, 2.0)},
        effectors=["a", "b"],
        detail=4.0,
        emg=True,
    )
    content = options_to_json(said)
    assert content.keys() == vars(said).keys()
    assert json.loads(json.dumps(content)) == content
    write_reading(tmp_path / "walk.amc", said, [])
    assert read_saved_options(tmp_path / "walk.amc") == said
    sent = from_json(to_json({"options": content}), ReadRequest)
    assert options_from_json(ReadOptions, sent.options) == said
    source = Source(str(tmp_path / "walk.amc"), "0" * 64, 60, said)
    write_graph(MotionGraph((source,), (), (), 30.0, 0.08, 0.3), tmp_path / "graph.json")
    assert read_graph(tmp_path / "graph.json").sources == (source,)
    head = {"read_options": content, "segment_options": options_to_json(method)}
    again, segmented = read_kept_options(tmp_path, head)
    assert again == said
    assert options_to_json(segmented) == options_to_json(method)
    assert segmented.constants == method.constants
