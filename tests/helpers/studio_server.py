"""The studio's server as people start it: a process of its own, which can be killed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Self

import kineme
from kineme.studio.storage.listed import file_id

ADDRESS = re.compile(r"http://127\.0\.0\.1:(\d+)/\?token=\S+")


class StudioServer:
    """``kineme studio`` on a folder, from entering the block to leaving it."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.address = ""
        self._port = 0

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    def start(self) -> None:
        """A new server, on the port of the one before."""
        command = [sys.executable, "-m", "kineme", "studio", str(self.folder)]
        self._process = subprocess.Popen(
            [*command, "--no-browser", "--port", str(self._port)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        said = ""
        for line in self._process.stdout:
            said += line
            if found := ADDRESS.search(line):
                self.address, self._port = found[0], int(found[1])
                return
        raise RuntimeError(f"kineme studio did not start: {said}")

    def kill(self) -> None:
        """The end without warning, as of ``kill -9``."""
        self._process.kill()
        self._process.wait()
        self._process.stdout.close()

    def address_of(self, *recordings: Path) -> str:
        """The address that opens recordings of the folder."""
        return self.address + "".join(f"&open={file_id(path)}" for path in recordings)


def saved_table(recording: Path) -> kineme.Segmentation:
    """What the server has written beside a recording."""
    return kineme.read_segments(recording.with_suffix(".segments.json"))
