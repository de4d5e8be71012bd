"""Run the code on the pages, and keep the pictures that it draws.

    python docs/run_pages.py [PAGE.md ...]

By default all pages that draw pictures are run. A page that shows ``images/made/NAME.png`` writes
``NAME.png`` into the folder in which it runs. Needs the packages of the ``test`` extra. The tests
run every page (``tests/test_docs.py``).
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from contextlib import chdir
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib import pyplot as plt
from PIL import Image
from sybil import Example, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser

import kineme

HERE = Path(__file__).resolve().parent
MADE = HERE / "images" / "made"
WIDEST = 1200  # pixels
SCRIPTS = Path(sys.executable).parent


def run_page(page: Path, folder: Path, programs: Path = SCRIPTS) -> None:
    """Run the blocks marked ``python`` and ``bash``, from top to bottom.

    Parameters
    ----------
    page : Path
        A page of Markdown.
    folder : Path
        Where it runs; the bundled recording is put there as ``take.bvh``.
    programs : Path
        A folder that comes first on the path: that of this interpreter, or one with another
        ``kineme``.
    """
    mpl.use("agg")
    shutil.copy(kineme.bundled_recording(), folder / "take.bvh")
    path = os.pathsep.join([str(programs), str(SCRIPTS), os.environ["PATH"]])
    in_shell = CodeBlockParser("bash", partial(_run_in_shell, path))
    with chdir(folder):
        for example in Sybil(parsers=[PythonCodeBlockParser(), in_shell]).parse(page).examples():
            example.evaluate()
    plt.close("all")


def pictures_of(page: Path) -> list[str]:
    """Names of the pictures that a page draws itself, in the order in which it shows them."""
    return re.findall(r"\]\((?:\.\./)?images/made/(\w+\.png)\)", page.read_text(encoding="utf-8"))


def main() -> None:
    MADE.mkdir(exist_ok=True)
    named = [Path(name).resolve() for name in sys.argv[1:]]
    for page in named or filter(pictures_of, sorted(HERE.rglob("*.md"))):
        with tempfile.TemporaryDirectory() as folder:
            run_page(page, Path(folder))
            for name in pictures_of(page):
                _save(Path(folder) / name)
        print(f"{page.name}: {', '.join(pictures_of(page))}")


def _run_in_shell(path: str, example: Example) -> None:
    done = subprocess.run(  # noqa: S603 (what our own pages say)
        ["bash", "-euo", "pipefail", "-c", str(example.parsed)],  # noqa: S607
        env={**os.environ, "PATH": path, "COLUMNS": "100"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(f"{example.parsed}\n{done.stdout}\n{done.stderr}")


def _save(path: Path) -> None:
    """The picture in few enough pixels and colours for a small file."""
    picture: Any = Image.open(path).convert("RGB")
    picture.thumbnail((WIDEST, WIDEST))
    picture.quantize(255).save(MADE / path.name, optimize=True)


if __name__ == "__main__":
    main()
