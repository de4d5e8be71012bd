"""``kineme-cmu``: download recordings of the CMU Graphics Lab Motion Capture Database.

Files are stored as published: the subject's skeleton (ASF) and one AMC per trial, 120 Hz. For
subject 86 also the annotations, from their authors' repository.

Source: mocap.cs.cmu.edu, "free for all uses", funded by NSF EIA-0196217;
annotations by Zhou, De la Torre and Hodgins, github.com/zhfe99/aca.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import count
from os import PathLike
from pathlib import Path
from typing import Annotated

import pooch
import requests
import typer

from kineme._util.checks import format_count
from kineme.cli.help import INPUT, option, output_option
from kineme.cli.options import Quiet
from kineme.cli.terminal import exit_on_error
from kineme.errors import ReadError, WriteError

SITE = "http://mocap.cs.cmu.edu/subjects"
ANNOTATIONS = "https://raw.githubusercontent.com/zhfe99/aca/master/data/moc/mocap.txt"
ATTEMPTS = 5

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


def find_cache_folder() -> Path:
    """Return the folder for recordings: ``KINEME_CACHE``, else the system's cache folder."""
    return Path(os.environ.get("KINEME_CACHE") or pooch.os_cache("kineme"))


@app.command()
def download(
    subject: Annotated[int, typer.Argument(min=1, help="Number of the subject, such as 86.")],
    trials: Annotated[
        str | None,
        option(
            INPUT,
            "Recordings to download, such as 1,2,9-11; by default from 1 up to the first "
            "that does not exist.",
            metavar="NUMBER,NUMBER,…",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        output_option("Folder; by default cmuNN in the cache of kineme.", metavar="FOLDER"),
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Download recordings of a subject; existing files are kept.

    For example: kineme-cmu 86 --trials 1,2
    """
    numbers = None if trials is None else _parse_numbers(trials)
    pooch.get_logger().setLevel("WARNING" if quiet else "INFO")
    with exit_on_error(f"subject {subject}"):
        files = fetch_subject(subject, numbers, folder=output)
    if not quiet:
        typer.echo(f"{format_count(len(files), 'file')} in {files[0].parent}")


def _parse_numbers(text: str) -> list[int]:
    """Parse numbers and ranges such as ``1,2,9-11``."""
    numbers: list[int] = []
    for part in text.split(","):
        first, dash, last = part.partition("-")
        try:
            span = range(int(first), int(last if dash else first) + 1)
        except ValueError:
            span = range(0)
        if not span or span[0] < 1:
            reason = f"{part!r} is neither a trial, such as 2, nor a range, such as 9-11"
            raise typer.BadParameter(reason, param_hint="--trials")
        numbers += span
    return numbers


def fetch_subject(
    subject: int,
    trials: Sequence[int] | None = None,
    *,
    folder: str | PathLike[str] | None = None,
) -> list[Path]:
    """Download the skeleton, trials and, for subject 86, annotations; keep existing files.

    Parameters
    ----------
    subject : int
        Number of the subject.
    trials : sequence of int, optional
        By default those from 1 up to the first that does not exist.
    folder : path-like, optional
        By default ``cmuNN`` in `find_cache_folder`.

    Returns
    -------
    list of Path
        The files, downloaded or existing.

    Raises
    ------
    ReadError
        The subject or a trial does not exist, or cannot be downloaded completely.
    WriteError
        The folder cannot be written to.
    """
    name = f"{subject:02d}"
    files = pooch.create(
        find_cache_folder() / f"cmu{name}" if folder is None else folder,
        f"{SITE}/{name}/",
        urls={"mocap.txt": ANNOTATIONS},
        retry_if_failed=ATTEMPTS - 1,
    )
    skeleton = _fetch_file(files, f"{name}.asf")
    if skeleton is None:
        raise ReadError(f"{SITE}/{name}", f"the database has no subject {subject}")
    found = [skeleton]
    for trial in count(1) if trials is None else trials:
        path = _fetch_file(files, f"{name}_{trial:02d}.amc")
        if path is not None:
            found.append(path)
        elif trials is not None:
            raise ReadError(f"{SITE}/{name}", f"subject {subject} has no trial {trial}")
        else:
            break
    annotations = _fetch_file(files, "mocap.txt") if subject == 86 else None
    return found if annotations is None else [*found, annotations]


def _fetch_file(files: pooch.Pooch, name: str) -> Path | None:
    """Return a file, downloaded if necessary; None if the server does not have it."""
    files.registry[name] = None  # the site publishes no checksums
    try:
        return Path(files.fetch(name, downloader=_download))
    except FileNotFoundError:
        return None
    except requests.RequestException as error:
        response = error.response
        reason = (
            "no connection, or it broke off"
            if response is None
            else f"the server answers {response.status_code} {response.reason}"
        )
        raise ReadError(
            files.get_url(name), f"gave up after {ATTEMPTS} failed attempts: {reason}"
        ) from error
    except OSError as error:
        raise WriteError(
            files.abspath / name, f"cannot be written: {error.strerror or error}"
        ) from error


def _download(url: str, path: str, files: pooch.Pooch) -> None:
    """Download a file; raise FileNotFoundError, with which pooch does not try again, for 404.

    Raise ReadError if it is another document, such as a login page, with status 200.
    """
    try:
        pooch.HTTPDownloader()(url, path, files)
    except requests.HTTPError as error:
        if error.response is not None:
            error.response.close()  # pooch leaves it open
            if error.response.status_code == 404:
                raise FileNotFoundError(url) from error
        raise
    with Path(path).open("rb") as file:
        # ASF and AMC files start with a comment or a keyword.
        if url.endswith((".asf", ".amc")) and file.read(1) not in (b"#", b":"):
            raise ReadError(url, "is no ASF or AMC file: see what a browser shows there")
