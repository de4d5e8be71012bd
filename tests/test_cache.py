"""Where compiled functions are kept if numba finds no place for them."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from kineme._util import parallel as _compiled

NOBODY_WRITES = "import os; os.access = lambda *_, **__: False\n"
NO_HOME = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull}


def run(code: str, tmp_path: Path, **environment: str) -> str:
    kept = {name: value for name, value in os.environ.items() if name != _compiled.VARIABLE}
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
    folder = Path(run(NOBODY_WRITES + shown, tmp_path))
    assert folder.parent == tmp_path
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert Path(run(NOBODY_WRITES + "import numba\n" + shown, tmp_path)) == folder
    folder.chmod(0o777)  # somebody else could leave something there
    assert Path(run(NOBODY_WRITES + shown, tmp_path)) != folder


def test_a_place_that_is_there_or_named_is_left_as_it_is(tmp_path: Path) -> None:
    shown = "import os, kineme; print(os.environ.get('NUMBA_CACHE_DIR'))"
    assert run(shown, tmp_path) == "None"
    named = str(tmp_path / "own")
    assert run(NOBODY_WRITES + shown, tmp_path, NUMBA_CACHE_DIR=named) == named


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
    assert run(code, tmp_path, **kept) == _compiled.COMPILING
    assert run(code, tmp_path, **kept) == ""
