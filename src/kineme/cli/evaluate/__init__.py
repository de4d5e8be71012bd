"""``kineme evaluate``: methods on the benchmark or any folder, or one result against its truth."""

from kineme.cli.evaluate.command import evaluate as evaluate
