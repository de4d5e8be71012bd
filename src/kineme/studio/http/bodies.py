"""Request and response bodies: JSON messages, files, and uploads into the folder.

Requests are limited in size, and time out if no data arrives.
"""

from __future__ import annotations

import asyncio
import os
import re
import shutil
import unicodedata
from collections.abc import AsyncIterator, Callable
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from kineme._util.files import lock_shared, make_draft_name
from kineme.errors import ParameterError, WriteError
from kineme.formats import supported_formats
from kineme.labels import label_formats
from kineme.web.encoding import from_json, to_json

CHUNK_TIMEOUT_S = 60.0
"""Largest time between two chunks of a request."""
MAX_JSON = 1_000_000
"""Bytes of a request other than an upload."""
MAX_UPLOAD = 10**9
"""Bytes; an hour of motion takes a quarter of that as text."""
MAX_NAME = 180
"""Bytes; file systems allow 255, and names of saved tables get longer suffixes."""
RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)", re.IGNORECASE)
"""Names that Windows does not allow."""


class MessageResponse(JSONResponse):
    """Response with a message as JSON."""

    def render(self, content: object) -> bytes:
        return to_json(content)


def make_file_response(name: str, content: bytes) -> Response:
    """Return a response that downloads a file; invalid Unicode in its name becomes "?"."""
    quoted = quote(name.encode(errors="replace"), safe="")
    headers = {"content-disposition": f"attachment; filename*=UTF-8''{quoted}"}
    return Response(content, headers=headers, media_type="application/octet-stream")


def parse_number(text: str) -> int:
    """Return the number in a URL; -1, which is no valid index, for anything else."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 9 else -1


def make_route(path: str, work: Callable[..., object], sent: Any = None) -> Route:
    """Return a route that runs ``work`` in a thread; with ``sent`` it takes POST requests.

    ``work`` gets the request and, with ``sent``, the decoded message of that type. It returns a
    message or a response.
    """

    async def answer(request: Request) -> Response:
        arguments = () if sent is None else (from_json(await read_body(request), sent),)
        result = await run_in_threadpool(work, request, *arguments)
        return result if isinstance(result, Response) else MessageResponse(result)

    return Route(path, answer, methods=["GET" if sent is None else "POST"])


class TooSlowError(Exception):
    """Raised if a request stops sending."""


class TooLargeError(Exception):
    """Raised for an upload over the limit, or larger than the free disk space."""


async def read_chunks(request: Request) -> AsyncIterator[bytes]:
    """Yield the body chunk by chunk; TooSlowError if the next one does not arrive in time."""
    stream = request.stream()
    while True:
        try:
            async with asyncio.timeout(CHUNK_TIMEOUT_S):
                chunk = await anext(stream)
        except StopAsyncIteration:
            return
        except TimeoutError:
            raise TooSlowError(
                f"no data arrived for {CHUNK_TIMEOUT_S:g} s: send it again"
            ) from None
        yield chunk


async def read_body(request: Request) -> bytes:
    """Return the body; TooLargeError above `MAX_JSON`."""
    content = bytearray()
    async for chunk in read_chunks(request):
        content += chunk
        if len(content) > MAX_JSON:
            raise TooLargeError(f"the request is too large: it can have at most {MAX_JSON} bytes")
    return bytes(content)


class Upload:
    """A file that is being uploaded; leaving the block deletes it unless it was finished.

    ``length`` is the announced size. Raises ParameterError for a suffix that the studio cannot
    open, TooLargeError above the limit or the free disk space, and WriteError if the file cannot be
    written.
    """

    def __init__(
        self, root: Path, name: str, *, length: int | None = None, limit: int = MAX_UPLOAD
    ):
        self.name = make_safe_name(name)
        if Path(self.name).suffix.lower() not in _list_upload_suffixes():
            allowed = ", ".join(sorted(_list_upload_suffixes()))
            raise ParameterError(
                f"{self.name!r} does not have a suffix of recordings or labels: {allowed}"
            )
        if length is not None and length > limit:
            raise TooLargeError(
                f"{self.name} has {length} bytes, but at most {limit} can be uploaded"
            )
        if length is not None and length > shutil.disk_usage(root).free:
            raise TooLargeError(f"not enough free space for {length} bytes in {root}")
        self._root, self._limit, self._size, self._digest = root, limit, 0, sha256()
        self._draft = root / make_draft_name(".part")
        try:
            self._file = self._draft.open("xb")
        except OSError as error:
            raise WriteError(root, f"cannot be written to: {error.strerror}") from error
        # Lock the draft, so that other servers do not delete it as abandoned.
        lock_shared(self._file.fileno())

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self._file.close()
        self._draft.unlink(missing_ok=True)

    def write(self, chunk: bytes) -> None:
        """Append bytes; TooLargeError above the limit, whatever size was announced."""
        self._size += len(chunk)
        if self._size > self._limit:
            raise TooLargeError(f"{self.name} is larger than {self._limit} bytes")
        self._digest.update(chunk)
        try:
            self._file.write(chunk)
        except OSError as error:
            raise TooLargeError(f"{self.name} cannot be written: {error.strerror}") from error

    def finish(self) -> Path:
        """Give the file its name and return the path; an equal file that exists is kept instead."""
        self._file.close()
        for path in _list_candidate_paths(self._root / self.name):
            if path.is_file() and self._matches(path):
                return path
            if _move_if_free(self._draft, path):
                return path
        raise WriteError(self._root / self.name, "cannot be stored: all similar names are in use")

    def _matches(self, path: Path) -> bool:
        same_size = path.stat().st_size == self._size
        return same_size and sha256(path.read_bytes()).digest() == self._digest.digest()


def make_safe_name(name: str) -> str:
    """Return a file name without folders, and without characters that some system forbids."""
    # NFC, so that one name has one spelling; both kinds of slashes separate folders.
    last = re.split(r"[/\\]", unicodedata.normalize("NFC", name))[-1]
    plain = "".join(c if c.isprintable() and c not in '<>:"|?*' else "_" for c in last).strip(" .")
    stem, suffix = Path(plain).stem, Path(plain).suffix
    # Cut whole characters, since cutting bytes could split one.
    while len((stem + suffix).encode(errors="replace")) > MAX_NAME and stem:
        stem = stem[:-1]
    return ("_" if RESERVED.fullmatch(stem) else "") + stem + suffix


def list_recording_suffixes() -> list[str]:
    """Return the suffixes of files that can be recordings, sorted."""
    return sorted({suffix for each in supported_formats() if each.read for suffix in each.suffixes})


def _list_upload_suffixes() -> set[str]:
    """Return the suffixes of recordings, skeletons, labels and knowledge bases."""
    labels = {suffix for each in label_formats().values() for suffix in each.suffixes}
    return {*list_recording_suffixes(), ".asf", ".npz", *labels}


def _list_candidate_paths(path: Path) -> list[Path]:
    """Return the path, then numbered ones."""
    return [path, *(path.with_stem(f"{path.stem}_{number}") for number in range(2, 1000))]


def _move_if_free(draft: Path, path: Path) -> bool:
    """Move the draft to this path unless it exists; return whether it was moved."""
    try:
        # Linking fails if the path exists, so two uploads cannot get the same name.
        os.link(draft, path)
    except FileExistsError:
        return False
    except OSError:  # a file system without links
        try:
            with path.open("xb") as target, draft.open("rb") as source:
                shutil.copyfileobj(source, target)
        except FileExistsError:
            return False
        except OSError:
            # Delete a partial copy.
            path.unlink(missing_ok=True)
            raise
    return True
