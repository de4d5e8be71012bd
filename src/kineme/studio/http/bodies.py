"""What requests send and answers hold: messages as JSON, files, uploads into the folder.

Requests are read no farther than they may be long, and no longer than something comes.
"""

from __future__ import annotations

import asyncio
import os
import re
import secrets
import shutil
import time
import unicodedata
from collections.abc import AsyncIterator, Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from kineme._util.files import is_locked, lock_shared
from kineme.errors import ParameterError, WriteError
from kineme.formats import supported_formats
from kineme.labels import label_formats
from kineme.web.encoding import from_json, to_json

SLOWEST = 60.0
"""Seconds between two pieces of a request."""
MOST_JSON = 1_000_000
"""Bytes of a request that is no upload."""
LIMIT = 10**9
"""Bytes; an hour of motion takes a quarter of that as text."""
DRAFT = re.compile(r"\.upload-[0-9a-f]{16}\.part")
FORGOTTEN = 3600.0
"""Seconds after which a draft belongs to a server that was killed."""
LONGEST = 180  # bytes of a name; file systems take 255, and ours grow by a suffix
RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)", re.IGNORECASE)


class MessageResponse(JSONResponse):
    """A message as JSON."""

    def render(self, content: object) -> bytes:
        return to_json(content)


def make_file_response(name: str, content: bytes) -> Response:
    """Return a file to keep; what is not Unicode in its name becomes "?"."""
    quoted = quote(name.encode(errors="replace"), safe="")
    headers = {"content-disposition": f"attachment; filename*=UTF-8''{quoted}"}
    return Response(content, headers=headers, media_type="application/octet-stream")


def parse_number(text: str) -> int:
    """Return the number in an address; -1, which nothing has, for anything else."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 9 else -1


def make_route(path: str, work: Callable[..., object], sent: Any = None) -> Route:
    """An address that is answered from a thread of its own; with ``sent``, by what is sent there.

    ``work`` takes the request and the message of that type, and gives a message or a response.
    """

    async def answer(request: Request) -> Response:
        given = () if sent is None else (from_json(await read_body(request), sent),)
        found = await run_in_threadpool(work, request, *given)
        return found if isinstance(found, Response) else MessageResponse(found)

    return Route(path, answer, methods=["GET" if sent is None else "POST"])


class TooSlowError(Exception):
    """A request of which nothing more came."""


class TooLargeError(Exception):
    """More bytes than an upload may have, or than there is room for."""


async def read_chunks(request: Request) -> AsyncIterator[bytes]:
    """Yield what is sent, piece by piece; TooSlowError where the next one does not come."""
    sent = request.stream()
    while True:
        try:
            async with asyncio.timeout(SLOWEST):
                chunk = await anext(sent)
        except StopAsyncIteration:
            return
        except TimeoutError:
            raise TooSlowError(f"nothing came for {SLOWEST:g} s: send it again") from None
        yield chunk


async def read_body(request: Request) -> bytes:
    """Return what was sent, which is read no farther than a request may be long."""
    sent = bytearray()
    async for chunk in read_chunks(request):
        sent += chunk
        if len(sent) > MOST_JSON:
            raise TooLargeError(f"a request has at most {MOST_JSON} bytes")
    return bytes(sent)


class Upload:
    """A file on its way in; leaving the block removes what was not given its name.

    ``length`` is what the page announces. Refused are names that no file the studio opens has
    (ParameterError), what is too long or has no room (TooLargeError), and what cannot be written
    (WriteError).
    """

    def __init__(self, root: Path, name: str, *, length: int | None = None, limit: int = LIMIT):
        self.name = make_safe_name(name)
        if Path(self.name).suffix.lower() not in _list_upload_suffixes():
            allowed = ", ".join(sorted(_list_upload_suffixes()))
            raise ParameterError(
                f"{self.name!r} has no suffix of a recording or its labels: {allowed}"
            )
        if length is not None and length > limit:
            raise TooLargeError(f"{self.name} has {length} bytes; at most {limit} can be uploaded")
        if length is not None and length > shutil.disk_usage(root).free:
            raise TooLargeError(f"there is no room for {length} bytes in {root}")
        self._root, self._limit, self._size, self._digest = root, limit, 0, sha256()
        self._draft = root / f".upload-{secrets.token_hex(8)}.part"
        try:
            self._file = self._draft.open("xb")
        except OSError as error:
            raise WriteError(root, f"cannot be written to: {error.strerror}") from error
        # Held, so that other servers do not take it for abandoned.
        lock_shared(self._file.fileno())

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self._file.close()
        self._draft.unlink(missing_ok=True)

    def write(self, chunk: bytes) -> None:
        """Add bytes; TooLargeError once they are more than the limit, whatever was announced."""
        self._size += len(chunk)
        if self._size > self._limit:
            raise TooLargeError(f"{self.name} is larger than {self._limit} bytes")
        self._digest.update(chunk)
        try:
            self._file.write(chunk)
        except OSError as error:
            raise TooLargeError(f"{self.name} cannot be written: {error.strerror}") from error

    def finish(self) -> Path:
        """Return the path under which the file is there now, or was before."""
        self._file.close()
        for path in _list_candidate_paths(self._root / self.name):
            # The same content is there already.
            if path.is_file() and self._is_in(path):
                return path
            if _move_if_free(self._draft, path):
                return path
        raise WriteError(self._root / self.name, "every name like it is taken")

    def _is_in(self, path: Path) -> bool:
        same_size = path.stat().st_size == self._size
        return same_size and sha256(path.read_bytes()).digest() == self._digest.digest()


def make_safe_name(name: str) -> str:
    """Return a file's name without folders, and without what some system does not allow in it."""
    # Composed letters, so that one name is not two; a path of any system loses its folders.
    last = re.split(r"[/\\]", unicodedata.normalize("NFC", name))[-1]
    plain = "".join(c if c.isprintable() and c not in '<>:"|?*' else "_" for c in last).strip(" .")
    stem, suffix = Path(plain).stem, Path(plain).suffix
    # Cut by letters, since a limit in bytes could part one.
    while len((stem + suffix).encode(errors="replace")) > LONGEST and stem:
        stem = stem[:-1]
    return ("_" if RESERVED.fullmatch(stem) else "") + stem + suffix


def remove_abandoned_drafts(root: Path) -> None:
    """Remove what a killed server left of uploads; not what another one still writes."""
    for path in root.glob(".upload-*.part"):
        if not DRAFT.fullmatch(path.name):
            continue
        with suppress(OSError):  # another server may have been quicker
            if time.time() - path.stat().st_mtime > FORGOTTEN and not is_locked(path):
                path.unlink()


def list_recording_suffixes() -> list[str]:
    """Return the suffixes of files that can be recordings, in alphabetical order."""
    return sorted({suffix for each in supported_formats() if each.read for suffix in each.suffixes})


def _list_upload_suffixes() -> set[str]:
    """Of all that may be sent: recordings and their skeletons, labels, knowledge bases."""
    labels = {suffix for each in label_formats().values() for suffix in each.suffixes}
    return {*list_recording_suffixes(), ".asf", ".npz", *labels}


def _list_candidate_paths(path: Path) -> list[Path]:
    return [path, *(path.with_stem(f"{path.stem}_{number}") for number in range(2, 1000))]


def _move_if_free(draft: Path, path: Path) -> bool:
    """Return whether the draft now has this name; not if another file has."""
    try:
        # A link fails if the name exists, so two uploads cannot take one name.
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
            # A copy that broke off must not keep the name.
            path.unlink(missing_ok=True)
            raise
    return True
