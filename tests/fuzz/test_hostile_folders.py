"""Commands and the studio in folders with links, pipes, foreign files, odd names and full disks.

Each case puts a few hazards at random places where kineme reads or writes, then runs commands.
A command may fail, but in one sentence and exit code 1. It never hangs, never changes a file
that kineme did not make, and leaves no unfinished file behind.
"""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing import forkserver
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient
from typer.testing import CliRunner

from kineme._util.files import is_draft
from kineme.cli.app import app
from kineme.library import build
from kineme.studio.folder import Folder
from kineme.studio.http.events import Hub
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.routes import create_app
from kineme.studio.storage.sidecars import make_file_id

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="needs links, pipes and names of any bytes"),
]

CASES = 40
HANGS_AFTER_S = 120
ODD_NAMES = [
    "a b",
    "w\xe9",
    os.fsdecode(b"w\xe9"),
    "-o",
    "x" * 200,
    "new\nline",
    "{stem}",
    "%s",
    "*",
]
SECRET = b"years of work"


def make_home(home: Path) -> None:
    """Write two recordings, their library, and an empty output folder."""
    (home / "takes" / ".kineme").mkdir(parents=True)
    (home / "out").mkdir()
    times = np.arange(400) / 20
    for name, rate in (("a", 0.7), ("b", 1.1)):
        wave = np.sin(2 * np.pi * rate * times)
        rows = [f"{t:.3f},{x:.4f},{1 - x:.4f}" for t, x in zip(times, wave, strict=True)]
        text = "\n".join(["time_s,gyro_x,gyro_y", *rows])
        (home / "takes" / f"{name}.csv").write_text(text)
    build(home / "takes", home / "lib")


def put_hazard(place: Path, kind: str, foreign: Path) -> None:
    """Replace what is at `place` by a link, a pipe, a folder or a file of somebody else."""
    if place.is_dir() and not place.is_symlink():
        shutil.rmtree(place)
    place.unlink(missing_ok=True)
    place.parent.mkdir(parents=True, exist_ok=True)
    if kind == "pipe":
        os.mkfifo(place)
    elif kind == "folder":
        place.mkdir()
        (place / "thesis.txt").write_bytes(SECRET)
    elif kind == "file":
        place.write_bytes(SECRET)
    else:
        targets = {"link to a file": "thesis.txt", "link to a folder": ".", "dead link": "none"}
        place.symlink_to(foreign / targets[kind])


KINDS = ("pipe", "folder", "file", "link to a file", "link to a folder", "dead link")


def list_places(home: Path, rng: random.Random) -> list[Path]:
    """Return paths that kineme reads or writes, and odd names beside them."""
    beside = [
        *("takes/.kineme", "takes/.kineme/labels.json", "takes/.kineme/a.csv.reading.json"),
        *("takes/a.segments.json", "takes/a.mp4", "takes/.kineme/a.segments.json"),
        *("out/a.csv", "out/clips", "out/a.npz", "out/picture.png"),
    ]
    inside = [path for path in (home / "lib").rglob("*") if not path.is_symlink()]
    folder = rng.choice(["takes", "lib", "lib/tables", "lib/pieces", "out"])
    odd = [
        home / folder / rng.choice(ODD_NAMES),
        home / "takes" / f"{rng.choice(ODD_NAMES)}.csv",
    ]
    return [*(home / name for name in beside), *rng.sample(inside, 3), *odd]


def read_foreign(home: Path, made: list[Path]) -> dict[str, bytes]:
    """Return the bytes of the files that are not kineme's, by path."""
    foreign = [*(home / "foreign").rglob("*"), *(path for each in made for path in walk(each))]
    return {os.fspath(path): path.read_bytes() for path in foreign if path.is_file()}


def walk(path: Path) -> list[Path]:
    return [] if path.is_symlink() else [path, *path.rglob("*")] if path.is_dir() else [path]


@contextmanager
def alarm(seconds: int) -> Iterator[None]:
    """Raise TimeoutError if the block hangs."""

    def stop(*_: object) -> None:
        raise TimeoutError("hangs")

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@contextmanager
def full_disk(largest: int) -> Iterator[None]:
    """Let no file of this process grow above `largest` bytes."""
    forkserver.ensure_running()  # else it would inherit the limit, and its children for ever
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def run_command(*arguments: object) -> None:
    """Run kineme in this process; fail unless it ends well or in short sentences."""
    done = CliRunner(env={"COLUMNS": "400", "NO_COLOR": "1"}).invoke(app, [*map(str, arguments)])
    said = f"{arguments}: exit {done.exit_code}\n{done.output}"
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise AssertionError(said) from done.exception
    assert done.exit_code in (0, 1), said
    assert "Traceback" not in done.output, said
    if done.exit_code:
        assert done.stderr.strip(), said


def use_commands(home: Path, rng: random.Random) -> None:
    """Run three commands on what is in the folders."""
    takes = sorted(path for path in (home / "takes").iterdir() if path.suffix == ".csv")
    take, out, lib = rng.choice(takes), home / "out", home / "lib"
    commands: list[tuple[object, ...]] = [
        ("library", "build", home / "takes", "--into", lib, "-q"),
        ("library", "build", "--into", lib, "-q"),
        ("library", "show", lib),
        ("segment", take, "-q", "-o", out / "a.csv"),
        ("segment", take, "-q", "--plot", out / "picture.png"),
        ("segment", *takes, "-q", "-o", out / "{name}.csv"),
        ("convert", take, out / "a.npz"),
        ("convert", *takes, out / "{name}.npz", "-q"),
        ("info", take),
    ]
    for command in rng.sample(commands, 3):
        run_command(*command)


def use_studio(home: Path, rng: random.Random) -> None:
    """Edit, undo, set options and download in a studio of the folder."""
    hub = Hub()
    server = create_app(
        OpenRecordings(Folder(home / "takes"), hub.tell), token="t", port=8750, hub=hub
    )
    headers = {"x-kineme-token": "t"}
    base = "http://127.0.0.1:8750"
    with TestClient(server, base, headers=headers, raise_server_exceptions=False) as client:
        one = f"/api/recordings/{make_file_id(home / 'takes' / 'a.csv')}"
        asked: list[Callable[[], Any]] = [
            lambda: client.get("/api/state"),
            lambda: client.get(one),
            lambda: client.post(f"{one}/reading", json={"options": {"fps": 20}}),
            lambda: client.post(f"{one}/video", json={"offset_s": 1.5}),
            lambda: client.post("/api/labels", json={"labels": ["walk"]}),
            lambda: client.post(f"{one}/edits", json=edit),
            lambda: client.get(f"{one}/export/json"),
            lambda: client.get(f"{one}/versions"),
        ]
        edit = {"revision": 0, "edit": {"kind": "split", "level": "activity", "frame": 77}}
        rng.shuffle(asked)
        for ask in asked:
            answer = ask()
            if answer.status_code >= 400:
                assert "error" in answer.json(), answer.text
                assert "Internal" not in answer.text, answer.text


@pytest.fixture(scope="module")
def template(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings and a library, to be copied for each case."""
    home = tmp_path_factory.mktemp("template") / "home"
    make_home(home)
    return home


@pytest.mark.parametrize("seed", range(CASES))
@pytest.mark.filterwarnings("ignore")
def test_surroundings(tmp_path: Path, template: Path, seed: int) -> None:
    rng = random.Random(seed)
    home = Path(shutil.copytree(template, tmp_path / "home"))
    (home / "foreign").mkdir()
    (home / "foreign" / "thesis.txt").write_bytes(SECRET)
    ours = {path for path in (home / "lib").rglob("*") if path.is_file()}
    made = rng.sample(list_places(home, rng), rng.choice([1, 2, 3]))
    for place in made:
        with suppress(FileExistsError, NotADirectoryError):  # below another hazard
            put_hazard(place, rng.choice(KINDS), home / "foreign")
    # Plain files may be replaced that a person names as an output or that have names of kineme.
    folders = (home / "out", home / "takes" / ".kineme")
    is_ours = {place: place in ours or place.parent in folders for place in made}
    kept = [place for place in made if not (is_ours[place] and place.is_file())]
    before = read_foreign(home, kept)
    with alarm(HANGS_AFTER_S):
        if rng.random() < 0.3:
            with full_disk(rng.choice([512, 4096])):
                rng.choice([use_commands, use_studio])(home, rng)
        else:
            rng.choice([use_commands, use_studio])(home, rng)
    after = read_foreign(home, kept)
    assert {path: after.get(path) for path in before} == before
    assert not [path for path in home.rglob("*") if is_draft(path.name)]
