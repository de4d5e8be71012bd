"""The HIERARCHY section of a BVH file, word by word.

Line breaks and braces may stand anywhere; a joint's name is everything up to
its opening brace, so it may hold blanks, dots and colons.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from kineme.formats.files import FileContent, numbers

_CHANNEL = re.compile(r"([xyz])(position|rotation)", re.IGNORECASE)


@dataclass
class Joint:
    """A joint as its file has it; ``channels`` are ("x", "rotation") and so on."""

    name: str
    parent: int
    line: int
    end: bool
    offset: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    channels: list[tuple[str, str]] = field(default_factory=list)


def read_joints(content: FileContent, stop: int) -> list[Joint]:
    """The joints, parents first, from the bytes before ``stop``."""
    return _Hierarchy(content, stop).joints


class _Hierarchy:
    """The joints of the HIERARCHY section, parents first."""

    def __init__(self, content: FileContent, stop: int):
        self.content = content
        text = content.data[:stop].decode("utf-8", "replace").removeprefix("\ufeff")
        lines = enumerate(text.replace("{", " { ").replace("}", " } ").splitlines(), 1)
        self.words = [(word, number) for number, line in lines for word in line.split()]
        self.at = 0
        self.joints: list[Joint] = []
        open_joints: list[int] = []
        if not self.words or self.words[0][0].upper() != "HIERARCHY":
            raise content.error("a BVH file begins with the word HIERARCHY", 1)
        self.at = 1
        while self.at < len(self.words):
            word, line = self._next()
            key = word.upper()
            if key in ("ROOT", "JOINT", "END"):
                parent = open_joints[-1] if open_joints else -1
                if (key == "ROOT") != (parent < 0):
                    raise content.error(
                        f"{word} {'outside' if parent < 0 else 'inside'} a joint", line
                    )
                open_joints.append(len(self.joints))
                self.joints.append(Joint(self._name(line), parent, line, key == "END"))
            elif not open_joints:
                raise content.error(f"ROOT expected, found {word[:40]!r}", line)
            elif key == "}":
                open_joints.pop()
            elif key == "OFFSET":
                self.joints[open_joints[-1]].offset = self._offset(line)
            elif key == "CHANNELS":
                self.joints[open_joints[-1]].channels = self._channels(line)
            else:
                raise content.error(
                    f"OFFSET, CHANNELS, JOINT or '}}' expected, found {word[:40]!r}", line
                )
        if not self.joints:
            raise content.error("the hierarchy has no ROOT")
        if open_joints:
            name = self.joints[open_joints[-1]].name
            raise content.error(
                f"the '}}' of joint {name!r} is missing before MOTION", self.words[-1][1]
            )
        self._name_end_sites()

    def _next(self) -> tuple[str, int]:
        if self.at >= len(self.words):
            raise self.content.error("the hierarchy breaks off", self.words[-1][1])
        self.at += 1
        return self.words[self.at - 1]

    def _name(self, line: int) -> str:
        """All words up to the brace, which has to come before the next line's end."""
        words = []
        while (word := self._next())[0] != "{":
            if word[1] > line and word[0].upper() in ("OFFSET", "CHANNELS", "JOINT", "END"):
                raise self.content.error("'{' expected after a joint's name", word[1])
            words.append(word[0])
        if not words:
            raise self.content.error("a joint without a name", line)
        return " ".join(words)

    def _offset(self, line: int) -> list[float]:
        words = [self._next()[0] for _ in range(3)]
        try:
            return numbers(words)
        except ValueError as error:
            raise self.content.error(f"OFFSET: {error}", line) from None

    def _channels(self, line: int) -> list[tuple[str, str]]:
        declared = self._next()[0]
        if not declared.isdecimal() or len(declared) > 18:
            raise self.content.error(f"CHANNELS needs a number, found {declared[:40]!r}", line)
        channels = []
        for _ in range(int(declared)):
            word = self._next()[0]
            match = _CHANNEL.fullmatch(word)
            if match is None:
                raise self.content.error(f"unknown channel {word[:40]!r} of {declared}", line)
            channels.append((match.group(1).lower(), match.group(2).lower()))
        places = [channel for channel in channels if channel[1] == "position"]
        if len(set(places)) != len(places):
            raise self.content.error("a position channel is named twice", line)
        return channels

    def _name_end_sites(self) -> None:
        """End sites are called after their parent; all names are unique."""
        taken: set[str] = set()
        for joint in self.joints:
            joint.end = joint.end and not joint.channels
            if not joint.end:
                if joint.name in taken:
                    raise self.content.error(f"a second joint is called {joint.name!r}", joint.line)
                taken.add(joint.name)
        tried: dict[str, int] = {}  # the last number behind each name
        for joint in self.joints:
            if joint.end:
                stem = joint.name = f"{self.joints[joint.parent].name}_end"
                while joint.name in taken:
                    tried[stem] = tried.get(stem, 1) + 1
                    joint.name = f"{stem}{tried[stem]}"
                taken.add(joint.name)
