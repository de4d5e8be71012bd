"""Work laid out over cores, and where compiled functions are kept."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme._util import parallel
from kineme._util.parallel import cancellable, make_even_slices, map_threads


@given(st.integers(0, 5000))
def test_slices_are_all_of_a_range_once(n: int) -> None:
    parts = make_even_slices(n)
    assert [i for part in parts for i in range(n)[part]] == list(range(n))
    assert all(part.start < part.stop for part in parts)


def test_work_that_maps_in_its_turn_ends() -> None:
    def all_below(n: int) -> int:
        return sum(map_threads(abs, range(n)))

    assert map_threads(all_below, range(100)) == [n * (n - 1) // 2 for n in range(100)]


def test_work_asks_whether_to_go_on_in_whichever_thread() -> None:
    asked: list[int] = []

    def ask() -> None:
        asked.append(1)
        if len(asked) > 150:
            raise TimeoutError

    def all_below(n: int) -> int:
        return sum(map_threads(abs, range(n)))

    with cancellable(ask), pytest.raises(TimeoutError):
        map_threads(all_below, range(100))
    assert len(asked) < 300  # of thousands: what had not begun asks once
    map_threads(all_below, range(100))  # nobody asks any more
    assert len(asked) < 300


INTERRUPTED = """
import threading
from kineme._util.parallel import map_threads

started = threading.Thread.start

def start(thread):
    started(thread)
    raise KeyboardInterrupt

threading.Thread.start = start
map_threads(abs, range(100))
"""


def test_control_c_while_threads_start_ends_the_program() -> None:
    env = {**os.environ, "KINEME_THREADS": "2"}
    ended = subprocess.run([sys.executable, "-c", INTERRUPTED], env=env, timeout=60, check=False,
                           capture_output=True)  # fmt: skip
    assert ended.returncode not in (0, None)


TWO_IMPORTS = """
import sys, threading, time, faulthandler

faulthandler.dump_traceback_later(100, exit=True)
from kineme._util.parallel import announce_compilation

begun = threading.Event()


class Pause:
    '''Let the other thread come in while numba is imported.'''

    def find_spec(self, name, path=None, target=None):
        if name == "numba.core.typing":
            begun.set()
            time.sleep(0.5)


def announce():
    begun.wait()
    with announce_compilation(print):
        import kineme.transfer._kernels


def compute():
    import kineme.methods.region_growing._kernels


sys.meta_path.insert(0, Pause())
failed = []
threading.excepthook = failed.append
threads = [threading.Thread(target=each, daemon=True) for each in (announce, compute)]
for each in threads:
    each.start()
for each in threads:
    each.join()
sys.exit(bool(failed))
"""


def test_numba_is_imported_by_one_thread_and_awaited_by_others() -> None:
    """A part of numba that is imported beside it leaves a lock that nobody opens."""
    subprocess.run([sys.executable, "-c", TWO_IMPORTS], check=True, timeout=300)


NOBODY_WRITES = "import os; os.access = lambda *_, **__: False\n"
NO_HOME = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull}


def run_alone(code: str, tmp_path: Path, **environment: str) -> str:
    kept = {name: value for name, value in os.environ.items() if name != parallel.VARIABLE}
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**kept, **NO_HOME, "TMPDIR": str(tmp_path), **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


@pytest.mark.skipif(sys.platform == "win32", reason="temporary folders are named otherwise")
def test_without_a_home_compiled_functions_are_kept_among_temporary_files(tmp_path: Path) -> None:
    shown = "import kineme, numba; print(numba.config.CACHE_DIR)"
    folder = Path(run_alone(NOBODY_WRITES + shown, tmp_path))
    assert folder.parent == tmp_path
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert Path(run_alone(NOBODY_WRITES + "import numba\n" + shown, tmp_path)) == folder
    folder.chmod(0o777)  # somebody else could leave something there
    assert Path(run_alone(NOBODY_WRITES + shown, tmp_path)) != folder


def test_a_place_that_is_there_or_named_is_left_as_it_is(tmp_path: Path) -> None:
    shown = "import os, kineme; print(os.environ.get('NUMBA_CACHE_DIR'))"
    assert run_alone(shown, tmp_path) == "None"
    named = str(tmp_path / "own")
    assert run_alone(NOBODY_WRITES + shown, tmp_path, NUMBA_CACHE_DIR=named) == named


def test_it_is_said_once_that_code_is_compiled_and_not_when_it_is_loaded(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(
        "from numba import njit\nimport kineme._util.parallel as c\n"
        "one, other = (njit('i8(i8)', **c.OPTIONS)(f) for f in (lambda n: n, lambda n: n + 1))"
    )
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import kineme._util.parallel as c\n"
        "with c.announce_compilation(print): import kernels"
    )
    kept = {"NUMBA_CACHE_DIR": str(tmp_path / "kept")}
    assert run_alone(code, tmp_path, **kept) == parallel.COMPILING
    assert run_alone(code, tmp_path, **kept) == ""
