"""Download public files into a folder, complete and checked.

Interrupted downloads continue where they stopped, in the same call or a later one. Incomplete files
are in the folder ``.partial``, with the server's modification date. The rest is requested if this
date is still valid (RFC 9110, ``Range`` and ``If-Range``). Servers without ranges or dates send the
whole file again. Files get their final names only if they are complete and pass the check.
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
CHUNK = 1 << 13  # bytes that are lost if a connection breaks
TRY_AGAIN = (408, 429, 500, 502, 503, 504)


def fetch(
    url: str,
    folder: Path,
    *,
    check: Check,
    progress: Progress | None = None,
    timeout_s: float = TIMEOUT_S,
) -> Path | None:
    """Download a file to ``folder`` and return its path; None if the server does not have it.

    ``check`` is called with the complete file and raises FileError if it is invalid. ``progress``
    is called with name, bytes so far, and total bytes or None. A connection without data for
    ``timeout_s`` is retried.
    """
    with require_extra("pooch", "data"):  # it brings requests
        import requests  # noqa: F401
    path = folder / url.rsplit("/", 1)[-1]
    part = folder / ".partial" / path.name
    try:
        part.parent.mkdir(parents=True, exist_ok=True)
        _Download(url, part, progress, timeout_s).complete()
        _check_complete(url, part, check)
        part.replace(path)
    except _MissingError:
        return None
    except OSError as error:
        raise WriteError(path, f"cannot be written: {error.strerror or error}") from error
    return path


def _check_complete(url: str, part: Path, check: Check) -> None:
    """Check a complete file; delete it if it is invalid."""
    try:
        check(part)
    except FileError as error:
        part.unlink()
        reason = f"the server sent another file: {error.reason}"
        raise ReadError(url, reason, line=error.line) from error


class _MissingError(Exception):
    """Raised if the server responds 404."""


class _BrokenOffError(Exception):
    """Raised if the connection broke, but another attempt may succeed."""


@dataclass
class _Download:
    """Download of a file that may have been interrupted before."""

    url: str
    part: Path
    progress: Progress | None
    timeout_s: float

    def complete(self) -> None:
        """Retry until the file is complete, or `ATTEMPTS` fail in a row."""
        furthest, failures = self._measure_part(), 0
        while True:
            try:
                return self._request_rest()
            except _BrokenOffError as error:
                # An attempt that received new data resets the count.
                failures = 0 if self._measure_part() > furthest else failures + 1
                furthest = max(furthest, self._measure_part())
                if failures == ATTEMPTS:
                    reason = f"gave up after {ATTEMPTS} failed attempts: {error}"
                    raise ReadError(self.url, reason) from error
                time.sleep(min(self.timeout_s, 2.0**failures) / 4)

    def _request_rest(self) -> None:
        """Request the missing part, and append it."""
        import requests

        size = self._measure_part()
        headers = {"Accept-Encoding": "identity"}
        if size:
            date = formatdate(self.part.stat().st_mtime, usegmt=True)
            # The server sends the whole file if it has changed since this date.
            headers |= {"Range": f"bytes={size}-", "If-Range": date}
        try:
            with requests.get(
                self.url, headers=headers, stream=True, timeout=self.timeout_s
            ) as response:
                self._append(response, self._check_response(response, size))
        except requests.RequestException as error:
            raise _BrokenOffError(_explain_error(error, self.timeout_s)) from error

    def _check_response(self, response: Response, size: int) -> int:
        """Check the response, and return the byte at which it begins."""
        answer = f"the server answers {response.status_code} {response.reason}"
        if response.status_code == 404:
            raise _MissingError
        if response.status_code in TRY_AGAIN:
            raise _BrokenOffError(answer)
        if response.status_code == 206:
            if response.headers.get("Content-Range", "").startswith(f"bytes {size}-"):
                return size
            self.part.unlink()
            raise _BrokenOffError("the server sent another part than requested")
        if response.status_code == 416:  # the file on the server became shorter
            self.part.unlink()
            raise _BrokenOffError("the server refused to send the rest")
        if response.status_code != 200:
            raise ReadError(self.url, answer)
        return 0

    def _append(self, response: Response, start: int) -> None:
        """Write the rest of the file from byte ``start`` on; raise an error if it is incomplete."""
        length = response.headers.get("Content-Length", "")
        total = start + int(length) if length.isdecimal() else None
        size, complete = start, False
        try:
            with self.part.open("ab" if start else "wb") as file:
                for chunk in response.iter_content(CHUNK):
                    size += file.write(chunk)
                    if self.progress is not None:
                        self.progress(self.part.name, size, total)
            complete = total is None or size == total
        finally:
            if not complete:
                self._set_date(response)
        if not complete:
            raise _BrokenOffError(f"only {size} of {total} bytes arrived")

    def _set_date(self, response: Response) -> None:
        """Set the file's date to the server's, which a later request needs to continue it.

        Delete the file if the server tells none.
        """
        try:
            date = parsedate_to_datetime(response.headers["Last-Modified"]).timestamp()
        except (KeyError, ValueError):
            self.part.unlink(missing_ok=True)
        else:
            os.utime(self.part, (date, date))

    def _measure_part(self) -> int:
        return self.part.stat().st_size if self.part.is_file() else 0


def _explain_error(error: Any, timeout_s: float) -> str:
    import requests

    if isinstance(error, requests.ConnectTimeout | requests.ReadTimeout):
        return f"the server sent nothing for {timeout_s:g} s"
    if isinstance(error, requests.exceptions.ChunkedEncodingError):
        return "the connection was lost"
    if isinstance(error, requests.ConnectionError):
        silent = "timed out" in str(error)
        return f"the server sent nothing for {timeout_s:g} s" if silent else "no connection"
    return str(error)
