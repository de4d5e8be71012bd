"""Read files as people say: their options, and which of several people a recording is of."""

from __future__ import annotations

from dataclasses import fields, replace

from kineme._util.checks import format_count
from kineme.errors import SeveralPeopleError
from kineme.formats import ReadOptions
from kineme.studio.folder import Folder
from kineme.studio.reading import RecordingCache
from kineme.studio.storage.listed import ListedRecording
from kineme.studio.storage.sidecars import (
    read_saved_options,
    read_saved_reading,
    resolve_read_options,
    write_reading,
)


class Reader:
    """How the recordings of a folder are read."""

    def __init__(self, folder: Folder, cache: RecordingCache):
        self._folder, self._cache = folder, cache

    def check_person(self, listed: ListedRecording) -> None:
        """Raise SeveralPeopleError if the file holds several people and none was selected.

        Markers are read without being told; but which are whose people should know. A library was
        made of one of them.
        """
        person = listed.person or resolve_read_options(listed, self._cache.read_options).person
        if person or self._folder.of_library:
            return
        people = self._cache.read(listed).provenance.people
        if len(people) > 1:
            reason = f"{format_count(len(people), 'person')} are in it: choose one of them, or all"
            raise SeveralPeopleError(listed.path, reason, people)

    def change_options(
        self, listed: ListedRecording, options: ReadOptions, *, everybody: bool
    ) -> tuple[set[str], str]:
        """Read a file with these options from now on; KinemeError where it cannot be read so.

        Return the options that differ from those before, and which of several people was read.
        """
        before, people = read_saved_reading(listed.path)
        after, people, person = self._read(listed, options, people, everybody)
        write_reading(listed.path, after, people)
        # Another person is another recording, with a table of its own.
        names = {each.name for each in fields(after)} - ({"person"} if people else set())
        return {name for name in names if getattr(after, name) != getattr(before, name)}, person

    def _read(
        self,
        listed: ListedRecording,
        choice: ReadOptions,
        known: tuple[str, ...],
        everybody: bool,
    ) -> tuple[ReadOptions, tuple[str, ...], str]:
        """Return how a file is read from now on, who is in it, and which of them was read.

        ``known`` are the people of before.
        """
        people = self._cache.people(listed.path, choice) if everybody else ()
        person = people[0] if people else choice.person or listed.person
        found = self._cache.read(ListedRecording(listed.path, person), choice).provenance
        people = people or found.people
        if self._folder.of_library:
            return choice, known, ""
        if len(people) < 2:
            return choice, (), ""
        first = read_saved_options(listed.path).person if listed.person else None
        kept = known if {*people} <= {*known} and not everybody else people
        return replace(choice, person=first), kept, found.person or ""
