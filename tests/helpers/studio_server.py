"""The studio's server as people start it: a process of its own, which can be killed."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Self

import kineme
from kineme.studio.storage.sidecars import make_file_id

ADDRESS = re.compile(r"(http://127\.0\.0\.1:(\d+)/)\?token=(\S+)")


class StudioServer:
    """``kineme studio`` on a folder, from entering the block to leaving it.

    Parameters
    ----------
    folder : Path
    *options : str
        What follows on the command line.
    """

    def __init__(self, folder: Path, *options: str):
        self.folder = folder
        self.options = options
        self.address = self.root = self.token = self.said = ""
        self.port = 0

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    def start(self) -> None:
        """A new server, on the port of the one before; RuntimeError says why there is none."""
        port = [] if "--port" in self.options else ["--port", str(self.port)]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "kineme", "studio", str(self.folder), "--no-browser"]
            + [*port, *self.options],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
            # What runs in a script's background is started deaf to Ctrl+C.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        self.said = self.process.stdout.readline()
        found = ADDRESS.search(self.said)
        if found is None:
            self.said, errors = self.process.communicate(timeout=300)
            raise RuntimeError(errors)
        self.address, self.root = found[0], found[1]
        self.port, self.token = int(found[2]), found[3]

    def kill(self) -> None:
        """The end without warning, as of ``kill -9``, if it has not ended yet."""
        if self.process.poll() is None:
            self.end(signal.SIGKILL)
        for pipe in (self.process.stdout, self.process.stderr):
            pipe.close()

    def end(self, how: int = signal.SIGINT) -> tuple[int, str, str]:
        """End it; exit code and what else it said."""
        self.process.send_signal(how)
        rest, errors = self.process.communicate(timeout=300)
        return self.process.returncode, rest, errors

    def address_of(self, *recordings: Path) -> str:
        """The address that opens recordings of the folder."""
        return self.address + "".join(f"&open={make_file_id(path)}" for path in recordings)


def saved_table(recording: Path) -> kineme.Segmentation:
    """What the server has written beside a recording."""
    return kineme.read_segments(recording.with_suffix(".segments.json"))
