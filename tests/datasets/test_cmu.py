"""Recordings come whole and checked from a server that does its worst, or not at all."""

from __future__ import annotations

import http.server
import threading
import time
from dataclasses import dataclass, field
from email.utils import formatdate
from pathlib import Path

import numpy as np
import pytest

from kineme.datasets.cmu import FRAMES, fetch_subject
from kineme.datasets.download import fetch
from kineme.errors import ParameterError, ReadError, WriteError

pytest.importorskip("pooch")

DATE = formatdate(1e9, usegmt=True)
ASF = """:version 1.10
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name spine
     direction 0 1 0
     length 5
     axis 0 0 0 XYZ
     dof rx
  end
:hierarchy
  begin
    root spine
  end
"""
MOCAP = "86_01\nwalk 500 510 520\njump 4579 4579 4579\n"


def format_amc(frames: int) -> str:
    rows = (f"{i}\nroot 0 10 {i / 1000} 0 0 0\nspine {i % 90}\n" for i in range(1, frames + 1))
    return ":FULLY-SPECIFIED\n:DEGREES\n" + "".join(rows)


@dataclass
class Site:
    """What the server holds and how it misbehaves; ``asked`` lists (path, Range header)."""

    files: dict[str, bytes]
    url: str = ""
    ranges: bool = True
    dated: bool = True
    break_after: int | None = None  # bytes of an answer after which the connection ends
    breaks: int = 1_000_000  # how many answers break off
    stall: bool = False
    status: list[int] = field(default_factory=list)  # answers to give before the real one
    asked: list[tuple[str, str | None]] = field(default_factory=list)


@pytest.fixture
def site():
    state = Site(
        {
            "/subjects/07/07.asf": ASF.encode(),
            "/subjects/07/07_01.amc": format_amc(2000).encode(),
            "/subjects/07/07_02.amc": format_amc(30).encode(),
            "/subjects/86/86.asf": ASF.encode(),
            "/subjects/86/86_01.amc": format_amc(4579).encode(),
            "/subjects/86/86_02.amc": format_amc(4579).encode(),
            "/mocap.txt": MOCAP.encode(),
        }
    )

    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self):
            wanted = self.headers.get("Range")
            state.asked.append((self.path, wanted))
            if state.stall:
                time.sleep(0.6)
                self.close_connection = True
                return None
            if state.status:
                return self.send_error(state.status.pop(0))
            if self.path not in state.files:
                return self.send_error(404)
            body = state.files[self.path]
            start = 0
            if wanted and state.ranges and self.headers.get("If-Range") in (None, DATE):
                start = int(wanted.removeprefix("bytes=").rstrip("-"))
                self.send_response(206)
                self.send_header("Content-Range", f"bytes {start}-{len(body) - 1}/{len(body)}")
            else:
                self.send_response(200)
            self.send_header("Content-Length", str(len(body) - start))
            if state.dated:
                self.send_header("Last-Modified", DATE)
            self.end_headers()
            rest = body[start:]
            if state.break_after is not None and len(rest) > state.break_after and state.breaks:
                state.breaks -= 1
                self.wfile.write(rest[: state.break_after])
                self.close_connection = True
                return None
            self.wfile.write(rest)
            return None

        def log_message(self, *args):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    state.url = f"http://127.0.0.1:{server.server_port}"
    yield state
    server.shutdown()
    server.server_close()
    thread.join()


def get(site: Site, folder: Path, subject: int = 7, trials=None, **options):
    options = {"timeout_s": 5.0, "annotations": f"{site.url}/mocap.txt", **options}
    return list(fetch_subject(subject, trials, folder=folder, site=site.url, **options))


def list_names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir() if path.is_file()}


def test_a_subject_comes_with_all_trials_and_says_what_it_took(site, tmp_path):
    seen = []
    found = get(site, tmp_path, progress=lambda *step: seen.append(step))
    assert [(f.path.name, f.frames, f.new) for f in found] == [
        ("07.asf", None, True),
        ("07_01.amc", 2000, True),
        ("07_02.amc", 30, True),
    ]
    for file in found:
        assert file.path.read_bytes() == site.files[f"/subjects/07/{file.path.name}"]
        assert seen[-1][0] == "07_02.amc"
        assert (file.path.name, file.size, file.size) in seen


def test_what_is_there_is_checked_and_not_fetched_again(site, tmp_path):
    get(site, tmp_path, trials=[2])
    asked = len(site.asked)
    assert [f.new for f in get(site, tmp_path, trials=[2])] == [False, False]
    assert len(site.asked) == asked
    (tmp_path / "07_02.amc").write_text("garbage")
    assert [f.new for f in get(site, tmp_path, trials=[2])] == [False, True]


def test_subject_86_comes_with_its_annotations_and_known_lengths(site, tmp_path):
    found = get(site, tmp_path, 86, [1])
    assert [f.path.name for f in found] == ["86.asf", "86_01.amc", "mocap.txt"]
    with pytest.raises(ReadError, match="4579 frames, while trial 86_02 has 10617"):
        get(site, tmp_path, 86, [2])
    assert "86_02.amc" not in list_names(tmp_path)


def test_the_known_lengths_are_those_of_the_annotations(data_dir):
    from kineme.evaluation.inputs import read_trials

    truths = read_trials(data_dir / "cmu86" / "annotations.json", fps=120.0)
    assert {name: truth.frames for name, truth in truths.items()} == FRAMES


def test_a_broken_download_goes_on_where_it_stopped(site, tmp_path):
    site.break_after, site.breaks = 20_000, 3
    (found,) = get(site, tmp_path, trials=[1])[1:]
    assert found.path.read_bytes() == site.files["/subjects/07/07_01.amc"]
    ranges = [wanted for path, wanted in site.asked if path.endswith(".amc")]
    starts = [int(wanted[6:-1]) for wanted in ranges[1:]]
    assert ranges[0] is None
    assert len(starts) == 3
    assert all(12_000 < start <= 20_000 for start in np.diff([0, *starts]))


def test_a_later_call_goes_on_where_the_last_one_stopped(site, tmp_path):
    def stop(name, size, total):
        if name.endswith(".amc"):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        get(site, tmp_path, trials=[1], progress=stop)
    assert list_names(tmp_path) == {"07.asf"}
    (found,) = get(site, tmp_path, trials=[1])[1:]
    assert found.path.read_bytes() == site.files["/subjects/07/07_01.amc"]
    assert site.asked[-1][1] is not None


def test_a_file_that_changed_on_the_server_is_fetched_from_the_start(site, tmp_path):
    part = tmp_path / ".partial" / "07_01.amc"
    part.parent.mkdir()
    part.write_text("an older version of the file, half of it")
    (found,) = get(site, tmp_path, trials=[1])[1:]
    assert found.path.read_bytes() == site.files["/subjects/07/07_01.amc"]


@pytest.mark.parametrize("lack", ["ranges", "dated"])
def test_a_server_without_ranges_or_dates_sends_the_whole_again(site, tmp_path, lack):
    setattr(site, lack, False)
    site.break_after, site.breaks = 20_000, 2
    (found,) = get(site, tmp_path, trials=[1], timeout_s=2.0)[1:]
    assert found.path.read_bytes() == site.files["/subjects/07/07_01.amc"]


def test_a_part_longer_than_the_file_is_dropped(site, tmp_path):
    part = tmp_path / ".partial" / "07_02.amc"
    part.parent.mkdir()
    part.write_bytes(b"x" * 100_000)
    site.status = [416]

    def check(path: Path) -> None:
        assert path.stat().st_size < 100_000

    url = f"{site.url}/subjects/07/07_02.amc"
    assert fetch(url, tmp_path, check=check, timeout_s=2.0) == tmp_path / "07_02.amc"


def test_a_server_that_recovers_is_asked_again(site, tmp_path):
    site.status = [503, 500]
    assert len(get(site, tmp_path, trials=[2], timeout_s=0.5)) == 2


def test_a_server_that_always_breaks_off_leaves_no_file(site, tmp_path):
    site.ranges, site.break_after = False, 20_000
    with pytest.raises(ReadError, match=r"07_01\.amc: gave up after 5 failed attempts"):
        get(site, tmp_path, trials=[1], timeout_s=0.3)
    assert list_names(tmp_path) == {"07.asf"}


def test_a_server_that_stalls_is_given_up_in_time(site, tmp_path):
    site.stall = True
    with pytest.raises(ReadError, match=r"sent nothing for 0\.1 s"):
        get(site, tmp_path, timeout_s=0.1)
    assert list_names(tmp_path) == set()


def test_no_server_at_all_is_one_sentence(tmp_path):
    with pytest.raises(ReadError, match=r"07\.asf: gave up .* no connection"):
        list(fetch_subject(7, folder=tmp_path, site="http://127.0.0.1:9", timeout_s=0.1))


@pytest.mark.parametrize(
    "rubbish",
    [b"<html>Not found, but politely</html>", b"", b"\x00\xff" * 500, format_amc(20).encode()[:-9]],
)
def test_rubbish_is_refused_and_not_kept(site, tmp_path, rubbish):
    site.files["/subjects/07/07_01.amc"] = rubbish
    with pytest.raises(ReadError, match=r"http.*07_01\.amc.*the server sent another file"):
        get(site, tmp_path, trials=[1])
    assert list_names(tmp_path) == {"07.asf"}
    assert not any((tmp_path / ".partial").iterdir())


def test_what_the_database_does_not_have_is_named(site, tmp_path):
    with pytest.raises(ReadError, match="no subject 9"):
        get(site, tmp_path, 9)
    with pytest.raises(ReadError, match="subject 7 has no trial 5"):
        get(site, tmp_path, trials=[5])
    with pytest.raises(ParameterError, match="numbered from 1, not 0"):
        get(site, tmp_path, trials=[0])


def test_a_folder_that_cannot_be_written_to_is_an_error_of_its_own(site, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(WriteError):
        get(site, tmp_path / "file")
