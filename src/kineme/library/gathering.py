"""Collect the analyses of a build's recordings: reuse existing ones, make the others.

Analyses run on any executor; an error affects one recording only. Importing the analysis code takes
a second, so only the processes of the executor do it.

Recordings with equal content are analysed once. Files are compared by size, then by a sample, and
read as a whole only if both are equal.
"""

from __future__ import annotations

import warnings
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import NamedTuple

from threadpoolctl import threadpool_limits

from kineme._util.checks import is_text
from kineme._util.files import AnyPath, refuse_pipe
from kineme._util.parallel import map_threads
from kineme.errors import KinemeError, KinemeWarning, MissingDependencyError, ReadError, WriteError
from kineme.formats import ReadOptions, read_quietly
from kineme.library.executors import Executor, InProcess, Progress, track_progress
from kineme.library.planning import (
    Plan,
    compute_digest,
    fetch,
    make_analysis_key,
    measure_size,
    read_states,
)
from kineme.library.storage.analyses import has_analysis, write_analysis
from kineme.library.storage.layout import STATES, read_json, write_json
from kineme.library.storage.places import is_remote
from kineme.methods.segmenter import SegmentOptions

States = dict[str, tuple[str, str]]
UNNAMED = "its name is not UTF-8 and cannot be stored: rename it"
"""Error for a file whose name is not UTF-8."""
SAMPLE = 4096
"""Bytes in the sample from the middle of a file."""
PER_WORKER = 1 << 20
"""Bytes of recordings per process: starting one takes seconds."""
DIED = "the process that read it died: it may need more memory than is available"


@dataclass
class Gathered:
    """Analyses of the recordings of a build.

    ``digests`` holds the digest of each analysed recording's files, ``failed`` the errors of the
    others, ``new`` the number of new analyses.
    """

    digests: dict[Path, str] = field(default_factory=dict)
    failed: dict[Path, str] = field(default_factory=dict)
    new: int = 0


def gather(plan: Plan, found: Sequence[Path], executor: Executor, progress: Progress) -> Gathered:
    """Return the analyses of recordings; make those that are missing.

    Files with unchanged size and time are not read again.
    """
    former = _read_former_states(plan.folder / STATES, progress)
    readable = [path for path in found if is_text(str(path))]
    states = read_states(readable, plan.read_options.skeleton)
    unreadable = [path for path in found if path not in states]
    gathered = Gathered(
        _find_unchanged(plan, states, former), failed=dict.fromkeys(unreadable, UNNAMED)
    )
    waiting = [path for path in readable if path not in gathered.digests]
    if waiting:
        _make_analyses(plan, waiting, executor, progress, gathered)
    present = {str(path): (states[path], digest) for path, digest in gathered.digests.items()}
    if present != former:
        write_json(plan.folder / STATES, present)
    return gathered


def _read_former_states(path: Path, progress: Progress) -> States:
    """Return the last state and digest of each recording; empty if the file is damaged."""
    try:
        return read_json(path, tuple[str, str])
    except ReadError as error:
        progress(f"{path.name} was ignored and all recordings are read again: it {error.reason}")
        return {}


def _find_unchanged(plan: Plan, states: Mapping[Path, str], former: States) -> dict[Path, str]:
    """Return the digests of unchanged recordings that have an analysis."""
    digests = {}
    complete = {path.stem for path in plan.analyses.glob("*.parquet")}
    for path, state in states.items():
        former_state, digest = former.get(str(path), ("", ""))
        if former_state and former_state == state and plan.key(digest) in complete:
            digests[path] = digest
    return digests


def _make_analyses(
    plan: Plan, waiting: Sequence[Path], executor: Executor, progress: Progress, into: Gathered
) -> None:
    """Make the analyses of recordings and record the outcomes in ``into``."""
    tasks = make_tasks(waiting, plan)
    skeleton = plan.read_options.skeleton
    groups = {group.tasks[0]: group for group in group_by_content(tasks, skeleton)}
    if not isinstance(executor, InProcess):  # import the next step while other processes work
        Thread(target=import_module, args=("kineme.library.compiling",), daemon=True).start()
    done = track_progress(progress, len(tasks), sum(task.size for task in tasks))
    remaining: list[Task] = []
    for task, outcome in run_tasks(list(groups), executor):
        _record_outcome(plan, task, outcome, into)
        (_, *others), digest = groups[task]
        if outcome.digest == digest:
            into.digests.update((other.path, digest) for other in others)
        else:  # it failed, or the file has changed: analyse each one on its own
            remaining += others
            others = []
        done(1 + len(others), task.size * (1 + len(others)))
    for task, outcome in run_tasks(remaining, executor):
        _record_outcome(plan, task, outcome, into)
        done(1, task.size)


def _record_outcome(plan: Plan, task: Task, outcome: Outcome, into: Gathered) -> None:
    """Record the outcome of a task; raise WriteError if all others will fail, too."""
    if outcome.fatal:
        raise WriteError(plan.folder, outcome.error)
    if outcome.error:
        into.failed[task.path] = outcome.error
    else:
        into.digests[task.path] = outcome.digest
    into.new += outcome.new


class Group(NamedTuple):
    """Tasks with equal content, and the digest; empty for a single task."""

    tasks: Sequence[Task]
    digest: str


def group_by_content(tasks: Iterable[Task], skeleton: AnyPath | None) -> list[Group]:
    """Group tasks by content, the largest first; remote and unreadable files are alone."""
    criteria: tuple[Callable[[Task], str], ...] = (
        lambda task: "" if is_remote(task.path) else f"{task.size}",
        _digest_sample,
        lambda task: _digest_files(task, skeleton),
    )
    groups = [Group(list(tasks), "")]
    for criterion in criteria:
        groups = [part for group in groups for part in _split_group(group, criterion)]
    return sorted(groups, key=lambda group: (-group.tasks[0].size, group.tasks[0].path))


def _split_group(group: Group, criterion: Callable[[Task], str]) -> list[Group]:
    """Split a group by the value of a criterion; tasks with an empty value are alone."""
    if len(group.tasks) < 2:
        return [group]
    parts: defaultdict[str | Task, list[Task]] = defaultdict(list)
    for task, value in zip(group.tasks, map_threads(criterion, group.tasks), strict=True):
        parts[value or task].append(task)
    return [Group(part, key if isinstance(key, str) else "") for key, part in parts.items()]


def _digest_sample(task: Task) -> str:
    """Return a digest of the middle of a file; empty if it cannot be read."""
    if task.path.is_dir():
        return "folder"
    try:
        refuse_pipe(task.path)
        with task.path.open("rb") as file:
            file.seek(max(task.size - SAMPLE, 0) // 2)
            return sha256(file.read(SAMPLE)).hexdigest()
    except (OSError, ReadError):  # the analysis will report it
        return ""


def _digest_files(task: Task, skeleton: AnyPath | None) -> str:
    try:
        return compute_digest(task.path, skeleton)
    except ReadError:  # the analysis will report it
        return ""


@dataclass(frozen=True)
class Task:
    """A recording of ``size`` bytes to analyse; ``analyses`` is the folder for the result."""

    path: Path
    analyses: Path
    read_options: ReadOptions
    segment_options: SegmentOptions
    options_digest: str
    size: int

    def __hash__(self) -> int:
        return hash(self.path)


@dataclass(frozen=True)
class Outcome:
    """Outcome of a task: the digest of its analysed files, or an error."""

    digest: str = ""
    new: bool = False
    """Whether the analysis was made now."""
    error: str = ""
    fatal: bool = False
    """Whether all other tasks will fail, too, as on a full disk."""


def make_tasks(paths: Iterable[Path], plan: Plan) -> list[Task]:
    """Return tasks for recordings, the largest first, so that processes finish together."""
    common = plan.analyses, plan.read_options, plan.segment_options, plan.options_digest
    tasks = [Task(path, *common, measure_size(path)) for path in paths]
    return sorted(tasks, key=lambda task: (-task.size, task.path))


def run_tasks(tasks: Sequence[Task], executor: Executor) -> Iterator[tuple[Task, Outcome]]:
    """Yield each task with its outcome as they complete."""
    for task, outcome in executor.completed(
        analyze_recording, tasks, workers=choose_workers(tasks)
    ):
        yield task, outcome or Outcome(error=DIED)


def choose_workers(tasks: Iterable[Task]) -> int:
    """Return the number of processes worth starting for these recordings."""
    return 1 + sum(task.size for task in tasks) // PER_WORKER


def analyze_recording(task: Task) -> Outcome:
    """Read, segment and describe a recording, unless its analysis exists."""
    try:
        from kineme.library.descriptions import make_analysis

        with warnings.catch_warnings(), threadpool_limits(1):  # rounding depends on BLAS threads
            warnings.simplefilter("ignore", KinemeWarning)
            options = task.read_options
            with fetch(task.path, options.skeleton) as path:
                digest = compute_digest(path, options.skeleton)
                key = make_analysis_key(task.options_digest, digest)
                if has_analysis(task.analyses, key):
                    return Outcome(digest)
                recording = read_quietly(path, options)
            write_analysis(task.analyses, key, *make_analysis(recording, task.segment_options))
    except (WriteError, MissingDependencyError) as error:
        return Outcome(error=_shorten_reason(error), fatal=isinstance(error, WriteError))
    except Exception as error:  # noqa: BLE001 (one recording must not end a build)
        return Outcome(error=_shorten_reason(error))
    return Outcome(digest, new=True)


def _shorten_reason(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return text if isinstance(error, KinemeError) else f"{type(error).__name__}: {text}"
