"""``kineme evaluate``: score methods on the benchmark or a folder, or a single result."""

from kineme.cli.evaluate.command import evaluate as evaluate
