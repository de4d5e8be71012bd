"""Fetching public files into a folder, each whole and checked, or not at all.

What breaks off or stalls is taken up where it stopped, in the same call and in a later one. Until a
file is complete it lies in the folder ``.partial``, dated as the server dates it. The rest is asked
for if this date still holds (RFC 9110, ``Range`` and ``If-Range``). A server that offers no ranges,
or no date, sends the whole file again. Only a file that is complete and passes its check gets its
name, by way of ``pooch``.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from email.utils import formatdate, parsedate_to_datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kineme._util.checks import require_extra
from kineme.errors import FileError, ReadError, WriteError

if TYPE_CHECKING:
    from requests import Response

Check = Callable[[Path], None]
Progress = Callable[[str, int, int | None], None]  # file name, bytes so far, bytes in all

ATTEMPTS = 5
TIMEOUT_S = 30.0
CHUNK = 1 << 13  # bytes that a broken connection may lose
TRY_AGAIN = (408, 429, 500, 502, 503, 504)


def fetch(
    url: str,
    folder: Path,
    *,
    check: Check,
    progress: Progress | None = None,
    timeout_s: float = TIMEOUT_S,
) -> Path | None:
    """Return the file of this address in ``folder``; None if the server has no such file.

    ``check`` is called with the complete file and raises FileError for one that is not what it
    should be, ``progress`` with name, bytes so far, and bytes in all or None. A connection that is
    silent for ``timeout_s`` is tried again.
    """
    with require_extra("pooch", "data"):
        import pooch
    pooch.get_logger().setLevel("WARNING")
    name = url.rsplit("/", 1)[-1]
    part = folder / ".partial" / name
    try:
        part.parent.mkdir(parents=True, exist_ok=True)
        download = _Download(part, check, progress, timeout_s)
        return Path(pooch.retrieve(url, None, fname=name, path=folder, downloader=download))
    except _MissingError:
        return None
    except OSError as error:
        raise WriteError(folder / name, f"cannot be written: {error.strerror or error}") from error


class _MissingError(Exception):
    """Raised where the server answers 404."""


class _BrokenOffError(Exception):
    """Raised where the connection ended early, but another attempt may get the rest."""


@dataclass
class _Download:
    """What pooch calls to get one file."""

    part: Path
    check: Check
    progress: Progress | None
    timeout_s: float

    def __call__(self, url: str, output_file: str, pooch: object) -> None:  # noqa: ARG002 (pooch's form)
        self._complete(url)
        try:
            self.check(self.part)
        except FileError as error:
            self.part.unlink()
            reason = f"the server sent something else: {error.reason}"
            raise ReadError(url, reason, line=error.line) from error
        self.part.replace(output_file)

    def _complete(self, url: str) -> None:
        """Attempt after attempt, as long as they bring something new."""
        furthest, failures = self._size(), 0
        while True:
            try:
                return self._rest(url)
            except _BrokenOffError as error:
                # An attempt that brought something new starts the count again.
                failures = 0 if self._size() > furthest else failures + 1
                furthest = max(furthest, self._size())
                if failures == ATTEMPTS:
                    raise ReadError(
                        url, f"gave up after {ATTEMPTS} attempts in vain: {error}"
                    ) from error
                time.sleep(min(self.timeout_s, 2.0**failures) / 4)

    def _rest(self, url: str) -> None:
        """Ask for what is missing, and append it."""
        import requests

        size = self._size()
        headers = {"Accept-Encoding": "identity"}
        if size:
            date = formatdate(self.part.stat().st_mtime, usegmt=True)
            # The server sends the whole file if its date is not this one any more.
            headers |= {"Range": f"bytes={size}-", "If-Range": date}
        try:
            with requests.get(url, headers=headers, stream=True, timeout=self.timeout_s) as answer:
                start = self._accepted(url, answer, size)
                self._append(answer, start)
        except requests.RequestException as error:
            raise _BrokenOffError(_explain_error(error, self.timeout_s)) from error

    def _accepted(self, url: str, answer: Response, size: int) -> int:
        """Return the byte that the answer begins with."""
        if answer.status_code == 404:
            raise _MissingError
        if answer.status_code in TRY_AGAIN:
            raise _BrokenOffError(f"the server answers {answer.status_code} {answer.reason}")
        if answer.status_code == 206:
            if answer.headers.get("Content-Range", "").startswith(f"bytes {size}-"):
                return size
            self.part.unlink()
            raise _BrokenOffError("the server sends another part than it was asked for")
        if answer.status_code == 416:  # nothing left of a file that has become shorter
            self.part.unlink()
            raise _BrokenOffError("the server refuses to send the rest")
        if answer.status_code != 200:
            raise ReadError(url, f"the server answers {answer.status_code} {answer.reason}")
        return 0

    def _append(self, answer: Response, start: int) -> None:
        length = answer.headers.get("Content-Length", "")
        total = start + int(length) if length.isdecimal() else None
        size, complete = start, False
        try:
            with self.part.open("ab" if start else "wb") as file:
                for chunk in answer.iter_content(CHUNK):
                    size += file.write(chunk)
                    if self.progress is not None:
                        self.progress(self.part.name, size, total)
            complete = total is None or size == total
        finally:
            if not complete:
                self._date(answer)
        if not complete:
            raise _BrokenOffError(f"only {size} of {total} bytes came")

    def _date(self, answer: Response) -> None:
        """Give the part the server's date; without one it cannot be continued."""
        try:
            date = parsedate_to_datetime(answer.headers["Last-Modified"]).timestamp()
        except (KeyError, ValueError):
            self.part.unlink(missing_ok=True)
        else:
            os.utime(self.part, (date, date))

    def _size(self) -> int:
        return self.part.stat().st_size if self.part.is_file() else 0


def _explain_error(error: Any, timeout_s: float) -> str:
    import requests

    if isinstance(error, requests.ConnectTimeout | requests.ReadTimeout):
        return f"the server was silent for {timeout_s:g} s"
    if isinstance(error, requests.exceptions.ChunkedEncodingError):
        return "the connection broke off"
    if isinstance(error, requests.ConnectionError):
        silent = "timed out" in str(error)
        return f"the server was silent for {timeout_s:g} s" if silent else "no connection"
    return str(error)
