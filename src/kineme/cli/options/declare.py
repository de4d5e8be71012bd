"""Add groups of options to commands: reading, segmenting, clips."""

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
    """Add options for reading, segmenting and clips to a command.

    The command receives them as ``read_options`` (`ReadOptions`), ``segment_options``
    (`SegmentOptions`) and ``clip_options`` (keywords of `kineme.clips.split.split`). Each of
    ``groups`` is passed as a dictionary of the options that were set.
    """
    added = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=option)
        for group in (options, *groups.values())
        for name, option in group.items()
    ]

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(command, eval_str=True)
        injected = ("read_options", "segment_options", "clip_options", *groups)
        own = [
            parameter for name, parameter in signature.parameters.items() if name not in injected
        ]

        @wraps(command)
        def wrapped(**values: Any) -> None:
            for group, members in groups.items():
                group_values = {name: values.pop(name) for name in members}
                values[group] = {
                    name: value for name, value in group_values.items() if value is not None
                }
            read_values = {name: values.pop(name) for name in options}
            method = {name: read_values.pop(name) for name in SEGMENTING if name in read_values}
            clips = {name: read_values.pop(name) for name in CLIPS if name in read_values}
            if read_values:
                values["read_options"] = make_read_options(**read_values)
            if method:
                emg = values["read_options"].emg
                values["segment_options"] = make_segment_options(**method, emg=emg)
            if clips:
                values["clip_options"] = make_clip_options(**clips)
            command(**values)

        # typer reads the options of a command from its signature.
        wrapped.__signature__ = signature.replace(parameters=[*own, *added])  # type: ignore[attr-defined]
        return wrapped

    return decorate


def are_given(context: typer.Context, options: Iterable[str]) -> bool:
    """Return whether the user set any of these options."""
    sources = map(context.get_parameter_source, options)
    return any(source is not None and source.name == "COMMANDLINE" for source in sources)
