"""Apply the user's reading options and choice of person to the recordings of a folder."""

from __future__ import annotations

from dataclasses import fields, replace

from kineme._util.checks import format_count
from kineme.errors import SeveralPeopleError
from kineme.formats import ReadOptions
from kineme.studio.folder import Folder
from kineme.studio.recording_cache import RecordingCache
from kineme.studio.storage.sidecars import (
    ListedRecording,
    read_saved_options,
    read_saved_reading,
    resolve_read_options,
    write_reading,
)


class Reader:
    """Reading options of the recordings of a folder."""

    def __init__(self, folder: Folder, cache: RecordingCache):
        self._folder, self._cache = folder, cache

    def check_person(self, listed: ListedRecording) -> None:
        """Raise SeveralPeopleError if the file holds several people and none was selected.

        Marker files can be read without a selection, but their user should know whose markers these
        are. A library always has one person of a file.
        """
        person = listed.person or resolve_read_options(listed, self._cache.read_options).person
        if person or self._folder.is_library:
            return
        people = self._cache.read(listed).provenance.people
        if len(people) > 1:
            reason = f"{format_count(len(people), 'person')} found: choose one or all"
            raise SeveralPeopleError(listed.path, reason, people)

    def change_options(
        self, listed: ListedRecording, options: ReadOptions, *, everybody: bool
    ) -> tuple[set[str], str]:
        """Read a file with new options from now on; KinemeError if it cannot be read so.

        Return the names of the options that changed, and the person that was read.
        """
        old, people = read_saved_reading(listed.path)
        new, people, person = self._read(listed, options, people, everybody)
        write_reading(listed.path, new, people)
        # Another person is a separate recording, so it is not a change of this one.
        names = {each.name for each in fields(new)} - ({"person"} if people else set())
        return {name for name in names if getattr(new, name) != getattr(old, name)}, person

    def _read(
        self,
        listed: ListedRecording,
        choice: ReadOptions,
        known: tuple[str, ...],
        everybody: bool,
    ) -> tuple[ReadOptions, tuple[str, ...], str]:
        """Read a file and return its new options, its people, and the person that was read.

        ``known`` are the people that were known before.
        """
        people = self._cache.people(listed.path, choice) if everybody else ()
        person = people[0] if people else choice.person or listed.person
        source = self._cache.read(ListedRecording(listed.path, person), choice).provenance
        people = people or source.people
        if self._folder.is_library:
            return choice, known, ""
        if len(people) < 2:
            return choice, (), ""
        first = read_saved_options(listed.path).person if listed.person else None
        # A take may lack some of the known people; keep all of them listed.
        kept = known if {*people} <= {*known} and not everybody else people
        return replace(choice, person=first), kept, source.person or ""
