"""Declare how a command reads, segments and writes clips: what it gets of its options."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from typing import Any

import typer

from kineme.cli.options.clips import CLIPS, make_clip_options
from kineme.cli.options.method import SEGMENTING, make_segment_options
from kineme.cli.options.reading import make_read_options


def add_options(
    options: Mapping[str, Any], **groups: Mapping[str, Any]
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command options for reading, for segmenting, and for clips, if these are among them.

    They reach it as ``read_options``, a `ReadOptions`, ``segment_options``, a `SegmentOptions`,
    and ``clip_options``, keywords of `kineme.clips.split.split`. Each of ``groups`` reaches it as
    a dictionary of the options that were given.
    """
    added = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=option)
        for each in (options, *groups.values())
        for name, option in each.items()
    ]

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(command, eval_str=True)
        made = ("read_options", "segment_options", "clip_options", *groups)
        own = [each for name, each in signature.parameters.items() if name not in made]

        @wraps(command)
        def wrapped(**values: Any) -> None:
            for group, members in groups.items():
                found = {name: values.pop(name) for name in members}
                values[group] = {name: each for name, each in found.items() if each is not None}
            given = {name: values.pop(name) for name in options}
            method = {name: given.pop(name) for name in SEGMENTING if name in given}
            clips = {name: given.pop(name) for name in CLIPS if name in given}
            if given:
                values["read_options"] = make_read_options(**given)
            if method:
                emg = values["read_options"].emg
                values["segment_options"] = make_segment_options(**method, emg=emg)
            if clips:
                values["clip_options"] = make_clip_options(**clips)
            command(**values)

        # typer declares the options of a command by its signature.
        wrapped.__signature__ = signature.replace(parameters=[*own, *added])  # type: ignore[attr-defined]
        return wrapped

    return decorate


def are_given(context: typer.Context, options: Iterable[str]) -> bool:
    """Return whether a user gave any of these options."""
    sources = map(context.get_parameter_source, options)
    return any(source is not None and source.name == "COMMANDLINE" for source in sources)
