"""What a label format is: one object, at the end of the module that reads and writes it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from kineme._util.checks import check_one_of, check_suffixes
from kineme.labels.spans import Labels
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

Read = Callable[[Path], Segmentation | Labels]
Holds = Literal["all", "levels", "level"]
Write = Callable[[Sequence[Segment], Segmentation, Path], None]


@dataclass(frozen=True)
class LabelFormat:
    """One way of keeping segments in a file.

    Parameters
    ----------
    name : str
        What ``format=`` and the command line call it.
    help : str
        What it is for, in a few words; shown wherever formats are offered.
    suffixes : tuple of str
        Suffixes of such files, in lower case and with the dot, the usual one first. Several
        formats may share one: what a file holds then decides, see ``recognises``.
    holds : {"all", "levels", "level"}
        The whole segmentation; the labels of both levels; or those of one level at a time.
    read : callable
        From a path to a `Segmentation`, or to `Labels` where frame rate, length or gaps
        remain to be filled in. Raises `ReadError`; an `OSError` or `UnicodeDecodeError`
        becomes one.
    write : callable, optional
        ``write(segments, segmentation, path)`` leaves the given segments of a segmentation at
        a path. None: the format is only read.
    recognises : callable, optional
        Whether a file (a path with one of the suffixes) holds labels in this format and is
        no recording. None: the suffix is enough.
    written_suffix : str, optional
        The suffix as it is written, where that is not the first of ``suffixes``.
    several : bool
        Whether it is several files that belong together; to download, they are packed.
    folder : str, optional
        Name of the folder that the file must lie in.

    Examples
    --------
    >>> from kineme.labels import label_formats
    >>> textgrid = label_formats()["textgrid"]
    >>> textgrid.suffixes, textgrid.written_suffix, textgrid.download_suffix
    (('.textgrid',), '.TextGrid', '.TextGrid')
    """

    name: str
    help: str
    suffixes: tuple[str, ...]
    holds: Holds
    read: Read
    write: Write | None = None
    recognises: Callable[[Path], bool] | None = None
    written_suffix: str = ""
    several: bool = False
    folder: str = ""

    def __post_init__(self) -> None:
        check_suffixes(self.suffixes, self.name)
        check_one_of(self.holds, get_args(Holds), f"holds of {self.name!r:.60}")
        object.__setattr__(self, "written_suffix", self.written_suffix or self.suffixes[0])

    @property
    def download_suffix(self) -> str:
        """Suffix of what is taken away: of the file, or of several packed into one."""
        return ".zip" if self.several else self.written_suffix
