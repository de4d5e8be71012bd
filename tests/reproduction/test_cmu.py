"""``kineme-cmu``: recordings come whole from a server that breaks off, or not at all."""

from __future__ import annotations

import http.server
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import pooch
import pytest
from typer.testing import CliRunner, Result

from kineme_reproduction import cmu

BODY = b"# AST/ASF\n" + b"1\nroot 0 10 0.5 0 0 0\n" * 5000


@dataclass
class Site:
    """What the server holds, what it does before it answers properly, and what was requested."""

    files: dict[str, bytes]
    faults: list[int] = field(default_factory=list)  # 0: break off; else a status
    requested: list[str] = field(default_factory=list)


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch) -> Iterator[Site]:
    names = ("07/07.asf", "07/07_01.amc", "07/07_02.amc", "86/86.asf", "86/86_01.amc", "mocap.txt")
    state = Site({f"/{name}": BODY for name in names})

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            state.requested.append(self.path)
            fault = state.faults.pop(0) if state.faults else None
            if fault or self.path not in state.files:
                return self.send_error(fault or 404)
            body = state.files[self.path]
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body if fault is None else body[:20_000])
            return None

        def log_message(self, *_: object) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    monkeypatch.setattr(cmu, "SITE", f"http://127.0.0.1:{server.server_port}")
    monkeypatch.setattr(cmu, "ANNOTATIONS", f"{cmu.SITE}/mocap.txt")
    monkeypatch.setattr(pooch.core.time, "sleep", lambda _: None)  # between two attempts
    yield state
    server.shutdown()
    server.server_close()
    thread.join()


@pytest.fixture
def kineme_cmu(tmp_path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    monkeypatch.setenv("KINEME_CACHE", str(tmp_path))

    def run(*arguments: object) -> Result:
        return CliRunner().invoke(cmu.app, [*map(str, arguments)])

    return run


def list_names(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_subject_comes_with_all_trials_and_what_is_there_is_kept(site, kineme_cmu, tmp_path):
    ran = kineme_cmu(7, "--trials", "2")
    assert ran.stdout == f"2 files in {tmp_path / 'cmu07'}\n"
    assert (tmp_path / "cmu07" / "07_02.amc").read_bytes() == BODY
    site.requested.clear()
    assert kineme_cmu(7, "-q").output == ""
    assert list_names(tmp_path / "cmu07") == ["07.asf", "07_01.amc", "07_02.amc"]
    assert site.requested == ["/07/07_01.amc", "/07/07_03.amc"]


def test_subject_86_comes_with_its_annotations(site, kineme_cmu, tmp_path):
    assert kineme_cmu(86, "--output", tmp_path / "here").exit_code == 0
    assert list_names(tmp_path / "here") == ["86.asf", "86_01.amc", "mocap.txt"]


def test_a_server_that_recovers_is_asked_again(site, kineme_cmu, tmp_path):
    site.faults = [503, 0, 500, 0]
    assert kineme_cmu(7, "--trials", "1").exit_code == 0
    assert (tmp_path / "cmu07" / "07.asf").read_bytes() == BODY


@pytest.mark.parametrize(
    ("faults", "arguments", "message"),
    [
        ([0] * 9, (7,), "07.asf: gave up after 5 failed attempts: no connection, or it broke off"),
        ([503] * 9, (7,), "07.asf: gave up after 5 failed attempts: the server answers 503"),
        ([], (7,), "07_02.amc: is no ASF or AMC file"),
        ([], (9,), "the database has no subject 9"),
        ([], (7, "--trials", "1,5"), "subject 7 has no trial 5"),
        ([], (7, "-o", "/dev/null/x"), "/dev/null/x"),
    ],
)
def test_what_cannot_be_had_is_one_sentence_and_leaves_no_half_file(
    site, kineme_cmu, tmp_path, faults, arguments, message
):
    site.files["/07/07_02.amc"] = b"<html>log in</html>"
    site.faults = faults
    ran = kineme_cmu(*arguments, "-q")
    assert ran.exit_code == 1
    assert ran.stderr.count("\n") == 1
    assert message in ran.stderr
    assert all(path.read_bytes() == BODY for path in tmp_path.rglob("*.*"))


@pytest.mark.parametrize("trials", ["one", "0", "", "3-1", "1,3-1", "3-"])
def test_trials_that_are_no_numbers_are_refused(kineme_cmu, trials):
    ran = kineme_cmu(86, "--trials", trials)
    assert ran.exit_code == 2
    assert "--trials" in ran.stderr
