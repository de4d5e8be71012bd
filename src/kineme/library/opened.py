"""The tables of a library, edits applied: as pyarrow has them, and as arrays."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError, ReadError
from kineme.library.edits import Edits, edited, read_edits
from kineme.library.settings import Settings
from kineme.library.sources import read_at
from kineme.library.storage.layout import LOCK_EDITS, as_array, held, read_head
from kineme.library.storage.places import place
from kineme.library.storage.tables import DESCRIBED, read_table
from kineme.recordings import Motion, Signals

Columns = dict[str, NDArray[Any]]


class OpenTables:
    """The tables that were valid when a library was opened, and the edits so far.

    Parameters
    ----------
    folder : Path
        Of the library.

    Attributes
    ----------
    folder : Path
    head : dict
        What ``library.json`` says.
    edits : Edits
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self.head = read_head(folder)
        try:
            self._computed = self._read()
        except ReadError:  # a build may have ended between the head and the tables
            self.head = read_head(folder)
            self._computed = self._read()
        self._take(read_edits(folder))

    @property
    def settings(self) -> Settings:
        """How its recordings are read and segmented."""
        return Settings.from_json(self.head["settings"])

    @cached_property
    def recordings(self) -> dict[str, list[Any]]:
        """The table of recordings by column."""
        found: dict[str, list[Any]] = self.table("recordings").to_pydict()
        return found

    def path_of(self, recording: str) -> Path:
        """The file that a recording of the library was read from."""
        try:
            row = self.recordings["recording"].index(recording)
        except ValueError:
            raise ParameterError(f"no recording is called {recording!r:.60}") from None
        return place(self.recordings["path"][row])

    def read(self, recording: str) -> Motion | Signals:
        """A recording of the library, read as it was when the library was built."""
        return read_at(self.path_of(recording), self.settings.reading)

    def table(self, name: str) -> Any:
        """A table, one of `kineme.library.storage.tables.DESCRIBED`, as a pyarrow.Table."""
        if name not in self._computed:
            self._computed[name] = read_table(self.folder, self.head["tables"], name)
        kept = self._edited  # an edit, in another thread, begins a new one
        if name not in kept:
            kept[name] = edited(self._computed[name], self.edits)
        return kept[name]

    def columns(self, name: str) -> Columns:
        """The same as arrays."""
        kept = self._arrays
        if name not in kept:
            table = self.table(name)
            kept[name] = {column: as_array(table.column(column)) for column in table.column_names}
        return kept[name]

    @cached_property
    def rows(self) -> dict[str, tuple[int, int]]:
        """First row and end of the segments of each recording."""
        names = self.table("segments").column("recording").combine_chunks().dictionary_encode()
        codes = np.from_dlpack(names.indices)
        edges = [*np.flatnonzero(np.diff(codes, prepend=-1)).tolist(), len(codes)]
        called = names.dictionary.to_pylist()
        return {called[codes[a]]: (a, b) for a, b in pairwise(edges)}

    @contextmanager
    def editing(self) -> Iterator[None]:
        """A block in which `edits` are all that were made, and nobody else makes any."""
        with held(self.folder, "try again", LOCK_EDITS):
            self._take(read_edits(self.folder))
            yield

    def write(self, edits: Edits) -> None:
        """Keep edits, and go on with them."""
        edits.write(self.folder)
        self._take(edits)

    def _take(self, edits: Edits) -> None:
        self.edits = edits
        self._edited: dict[str, Any] = {}
        self._arrays: dict[str, Columns] = {}

    def _read(self) -> dict[str, Any]:
        """All tables but the embeddings, which few need."""
        names = [name for name in DESCRIBED if name != "embeddings"]
        tables = {name: read_table(self.folder, self.head["tables"], name) for name in names}
        known = {*tables["recordings"].column("recording").to_pylist()}
        for name in names:
            if not known.issuperset(tables[name].column("recording").unique().to_pylist()):
                raise ReadError(
                    self.folder, f"{name} and recordings do not fit: build the library again"
                )
        return tables
