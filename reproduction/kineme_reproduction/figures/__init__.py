"""The paper's figures and tables, made anew by one call (``kineme evaluate cmu86 --figures``)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from kineme.evaluation.comparison import Comparison
from kineme.evaluation.score import format_score, make_score_rows
from kineme.evaluation.truth import Labelling
from kineme_reproduction.benchmark import (
    PublishedCuts,
    Result,
    mean,
    mean_scores,
    score_published_cuts,
)
from kineme_reproduction.figures.reoccurrence import Recording, share_of_poses
from kineme_reproduction.protocols import strict_and_tolerant
from kineme_reproduction.trials import FPS, Trial

UNIFORM_FRAMES = (36, 15, 5)


def make_figures(
    results: Sequence[Result],
    data: Path,
    folder: Path,
    *,
    progress: Callable[[str], None] | None = None,
) -> dict[str, str]:
    """Draw the figures into ``folder`` and return Markdown tables by name.

    Parameters
    ----------
    results : sequence of Result
        Of all methods and trials that the figures are to show.
    data : Path
        Folder of the benchmark; recordings beside it are surveyed, too.
    folder : Path
        Where to, made beforehand.
    progress : callable, optional
        Called with the name of each figure before it is made.

    Raises
    ------
    WriteError
        The folder cannot be written to.
    """
    from kineme_reproduction.figures import costs, matrix, reoccurrence, scores, segments

    say = progress or (lambda _: None)
    trials = list(dict.fromkeys(r.trial for r in results))
    say("segments")
    segments.plot_bars(results, folder / "segments.png")
    say("accuracies")
    scores.plot_accuracies(results, folder / "accuracies.png")
    published = _published(data)
    if published:
        scores.plot_published_cuts(published, folder / "published_cuts.png")
    say("variances")
    clusters = scores.measure([r for r in results if r.method in scores.METHODS])
    if clusters:
        scores.plot_by_class(clusters, folder / "variances.png")
        scores.plot_spread(clusters, folder / "distances.png")
    say("timings")
    costs.plot_timings(trials, folder / "timings.png")
    costs.plot_growth(trials, folder / "growth.png")
    say("sensitivity")
    costs.plot_sensitivity(trials, folder / "sensitivity.png")
    say("self-similarity")
    matrix.plot_regions(trials[0], folder / "regions.png")
    matrix.plot_paths(trials[0], folder / "paths.png")
    say("recordings whose poses reoccur")
    recordings = reoccurrence.survey(_recordings(data))
    reoccurrence.plot_reoccurrence(recordings, folder / "reoccurrence.png")
    return make_tables(results, published, recordings)


def make_tables(
    results: Sequence[Result],
    published: Sequence[PublishedCuts],
    recordings: Sequence[Recording],
) -> dict[str, str]:
    """Return all tables of the results as Markdown, by title."""
    trials = list(dict.fromkeys(r.trial for r in results))
    tables = {"means": markdown_scores(mean_scores(results))}
    for trial in trials:
        columns = {r.method: r.scores for r in results if r.trial is trial}
        tables[trial.name] = markdown_scores(columns)
    tables["uniform cuts"] = _uniform_table(trials)
    if published:
        tables["published cuts"] = _published_table(published)
    tables["reoccurrence"] = _reoccurrence_table(recordings)
    return tables


def markdown_scores(columns: Mapping[str, Mapping[str, float]]) -> str:
    """Return the table of `make_score_rows`, groups in bold."""
    rows: list[list[str]] = []
    for group, lines in make_score_rows(columns):
        rows.append([f"**{group}**", *[""] * len(columns)])
        rows += [[title, *cells] for title, cells in lines]
    return format_markdown(["", *columns], rows)


def format_markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Format a Markdown table whose first column is left-aligned, the others right."""
    lines = [header, ["---", *["---:"] * (len(header) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _uniform_table(trials: Sequence[Trial]) -> str:
    rows = []
    for step in UNIFORM_FRAMES:
        scores = []
        for trial in trials:
            cuts = np.arange(step, trial.truth.frames, step)
            found = Labelling.from_cuts(cuts, frames=trial.truth.frames, fps=trial.truth.fps)
            scores.append(strict_and_tolerant(Comparison.of(trial.truth, found)))
        strict, tolerant = np.mean(scores, axis=0)
        rows.append([f"{step / FPS:.2f} s", format_score(strict), format_score(tolerant)])
    return format_markdown(["a cut every", "strict", "tolerant"], rows)


def _published_table(found: Sequence[PublishedCuts]) -> str:
    names, fair = ("strict", "tolerant"), ("one_to_one", "one_to_one_agreed")
    rows = []
    for method in ("aca", "haca"):
        own = [cuts for cuts in found if cuts.method == method]
        lines = [(cuts.trial, cuts.scores, cuts.printed) for cuts in own]
        means = mean([cuts.scores for cuts in own]), mean([cuts.printed for cuts in own])
        for trial, scores, printed in [*lines, ("**mean**", *means)]:
            cells = [format_score(each[name]) for each in (scores, printed) for name in names]
            cells += [f"{printed[name] - scores[name]:+.3f}" for name in names]
            cells += [format_score(scores.get(name, np.nan)) or "–" for name in fair]
            rows.append([f"{method.upper()} {trial}", *cells])
    header = [
        "", "strict", "tolerant", "printed strict", "printed tolerant", "gap strict",
        "gap tolerant", "one to one", "one to one, agreed",
    ]  # fmt: skip
    return format_markdown(header, rows)


def _reoccurrence_table(recordings: Sequence[Recording]) -> str:
    if not recordings:
        return "No recording is longer than 8 s.\n"
    mostly = float(np.mean([r.share >= 0.5 for r in recordings]))
    rows = [
        ["recordings longer than 8 s", str(len(recordings))],
        ["poses that reoccur, of all poses", f"{share_of_poses(recordings):.1%}"],
        ["poses that reoccur, mean over recordings",
         f"{float(np.mean([r.share for r in recordings])):.1%}"],
        ["recordings in which at least half of the poses reoccur", f"{mostly:.1%}"],
    ]  # fmt: skip
    return format_markdown(["", "share"], rows)


def _published(data: Path) -> list[PublishedCuts]:
    return score_published_cuts(data) if (data / "published.json").is_file() else []


def _recordings(data: Path) -> Iterable[Path]:
    """Return the recordings of the benchmark, and those beside its folder if there are others.

    Of a take that is there in two formats, the AMC.
    """
    root = data.parent if (data.name == "cmu86" and data.parent.name != "") else data
    found = sorted([*root.rglob("*.bvh"), *root.rglob("*.amc")], key=lambda path: path.suffix)
    return sorted({path.stem: path for path in reversed(found)}.values())
