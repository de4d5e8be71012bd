"""Segmenter: segmentation as a scikit-learn estimator, for arrays, data frames and grid searches.

Rows are samples in time order, columns are channels. Unlike the clusterers of
scikit-learn, this one depends on the order of the rows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, ClusterMixin
from sklearn.utils.validation import check_is_fitted, validate_data

from kineme._util.arrays import Ints
from kineme._util.checks import format_count, is_whole_number, warn
from kineme.errors import ParameterError
from kineme.methods.base import Preset
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.methods.segmenter import SegmentOptions, segment_with_options
from kineme.recordings import Motion, Signals
from kineme.recordings.column_names import name_column
from kineme.recordings.samples import ASSUMED_FPS, read_samples
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level

EVERY_DETAIL = (*(k / 64 for k in range(1, 64)), *(2 ** (k / 8) for k in range(1, 49)))
"""Details that are searched for the wanted number of segments or states."""


class Segmenter(ClusterMixin, BaseEstimator):  # type: ignore[misc]
    """Estimator that segments a time series; ``fit_predict`` returns a state for each row.

    Parameters
    ----------
    preset : str or Preset
        ``kineme``, or another of `kineme.PRESETS`.
    fps : float, optional
        Rows per second. By default it follows from the times of a data frame, see
        `kineme.as_signals`; without times it is 30, or the working rate of the preset if that
        is lower, with a warning.
    level : {"activity", "primitive"}
        Level whose segments become states and change points.
    n_segments, n_states : int, optional
        Wanted number of segments or of different states. The level of detail with this number
        is chosen, or else the nearest, with a warning. By default the method decides.
    detail : float
        Level of detail without `n_segments` or `n_states`, as in `kineme.segment`.
    standardize : bool
        Divide each column by its standard deviation; not for an embedding.
    unit : float, optional
        Length in the columns that counts as one unit of the preset's lengths; by default
        one standard deviation, or 1 if columns are not standardized.
    emg : bool
        Compute the envelopes of muscle signals first.
    **constants
        Constants of the preset to change, as in `kineme.segment`. They are parameters like the
        others for ``get_params``, ``set_params`` and grid searches.

    Attributes
    ----------
    labels_ : (rows,) array of int
        State of each row: the cluster of its segment. All transitions form one additional
        state. Rows in a gap take the state before it.
    change_points_ : (changes,) array of int
        Rows at which a segment begins, in order of time, without the first.
    n_states_ : int
    segmentation_ : Segmentation
        Activities and repetitions in frames and seconds; frames equal rows if these are evenly
        spaced in time.
    n_features_in_ : int
    feature_names_in_ : (columns,) array
        Only if X had names.

    Raises
    ------
    ParameterError
        In ``fit``: the preset has no such constant, or its value is not allowed.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(1200) / 30
    >>> x = np.where(t < 20, np.sin(9 * t), 3 + np.sin(4 * t))
    >>> segmenter = Segmenter(fps=30).fit(x)
    >>> segmenter.n_states_, segmenter.predict(3 + np.sin(4 * t[:300]))[:3]
    (2, array([1, 1, 1]))
    """

    labels_: np.ndarray[tuple[int], np.dtype[np.int64]]

    def __init__(
        self,
        preset: str | Preset = DEFAULT,
        *,
        fps: float | None = None,
        level: Level = "activity",
        n_segments: int | None = None,
        n_states: int | None = None,
        detail: float = DEFAULT_DETAIL,
        standardize: bool = True,
        unit: float | None = None,
        emg: bool = False,
        **constants: Any,
    ):
        self.preset = preset
        self.fps = fps
        self.level = level
        self.n_segments = n_segments
        self.n_states = n_states
        self.detail = detail
        self.standardize = standardize
        self.unit = unit
        self.emg = emg
        self._constants = constants

    def fit(self, X: Any, y: Any = None) -> Self:  # noqa: ARG002, N803 (scikit-learn's names)
        """Segment the rows of X, (rows,) or (rows, channels); y is ignored."""
        for name in ("n_segments", "n_states"):
            wanted = getattr(self, name)
            if wanted is not None and not is_whole_number(wanted, 1):
                raise ParameterError(f"{name} is {wanted!r:.60}: give a whole number above 0")
        if self.n_segments and self.n_states:
            raise ParameterError("give n_segments or n_states, not both")
        signals, frames = self._read(X, reset=True)
        result = self._choose(self._segment(signals))
        states = result.per_frame("cluster", level=self.level).astype(np.int64)
        # All transitions (-1) form one additional state.
        states[states < 0] = states.max() + 1
        states = _fill_gaps(states, signals)
        # Rows of X may differ from frames if times are uneven.
        starts = result.rows().get("start_row", result.table.start_frame)
        starts = np.unique(starts[result.table.level == self.level])
        self.segmentation_ = result
        self.labels_ = states[frames]
        self.change_points_ = starts[(starts > 0) & (starts < len(frames))]
        self.n_states_ = len(np.unique(states))
        self._signals, self._states = signals, states
        return self

    def predict(self, X: Any) -> Ints:  # noqa: N803
        """Segment another recording and assign its segments to the fitted states.

        Each segment takes the state whose rows are nearest on average, see `kineme.transfer`.
        Rows in a gap take the state before it.

        Parameters
        ----------
        X : (rows,) or (rows, channels) array_like
            Rows of the same channels; in the same order if only one recording has their names.

        Returns
        -------
        (rows,) array of int
        """
        from kineme.transfer.sharing import assign_to_labels

        check_is_fitted(self)
        signals, frames = self._read(X, reset=False)
        known, names = self._signals.names, signals.names
        is_nameless = any(all(map(str.isdigit, each)) for each in (known, names))
        # As in scikit-learn, which warns. Numbers do not count if a channel was left out.
        if is_nameless and len(known) == len(names) == self.n_features_in_:
            signals = replace(signals, names=known)
        segments = self._segment(signals).level(self.level)
        borders = zip(segments.start_frame.tolist(), segments.stop_frame.tolist(), strict=True)
        states = assign_to_labels(self._signals, self._states, signals, [*borders])
        states = np.repeat(states, segments.stop_frame - segments.start_frame)
        return _fill_gaps(states, signals)[frames]

    def _read(self, X: Any, *, reset: bool) -> tuple[Signals, Ints]:  # noqa: N803
        """Return the rows as signals, and the frame of each row."""
        if isinstance(X, Motion | Signals):
            raise ParameterError(
                "a Segmenter takes rows of numbers: use kineme.segment for recordings"
            )
        preset = resolve_preset(self.preset, signals=True, **self._constants)
        assumed = min(preset.working_fps, ASSUMED_FPS)
        options = {"reset": reset, "dtype": np.float64, "ensure_all_finite": "allow-nan"}
        if hasattr(X, "dims") or hasattr(X, "columns") or hasattr(X, "to_frame"):
            signals, timing = read_samples(X, fps=self.fps, assumed_fps=assumed)
            labels = getattr(X, "columns", ())
            channels = [each for each in labels if name_column(each) in signals.names]
            # Columns that are no channels, such as times, are no features for scikit-learn.
            named = X[channels] if channels else signals.values
            validate_data(self, named, **options)
            return signals, timing.frames_of_rows(len(X))
        # A single channel may be a vector of numbers.
        rows = np.asarray(X) if isinstance(X, list | tuple) else X
        one_channel = reset or self.n_features_in_ == 1
        if getattr(rows, "ndim", 2) == 1 and rows.dtype.kind in "iufb" and one_channel:
            rows = rows.reshape(-1, 1)
        values = validate_data(self, rows, **options)
        signals, timing = read_samples(values, fps=self.fps, assumed_fps=assumed)
        return signals, timing.frames_of_rows(len(values))

    def _segment(self, signals: Signals) -> Segmentation:
        options = SegmentOptions(
            preset=self.preset,
            constants=self._constants,
            detail=self.detail,
            emg=self.emg,
            standardize=self.standardize,
            unit=self.unit,
        )
        details = EVERY_DETAIL if self.n_segments or self.n_states else None
        return segment_with_options(signals, options, details=details)[0]

    def _choose(self, result: Segmentation) -> Segmentation:
        """Return the level of detail with the wanted number of segments or states, or nearest."""
        wanted = self.n_segments or self.n_states
        if wanted is None:
            return result
        if result.hierarchy is None:
            name = result.provenance["preset"]
            raise ParameterError(f"{name} has one level: leave out n_segments and n_states")
        tables = [table.select(table.level == self.level) for table in result.hierarchy.tables]
        counts = [len(t) if self.n_segments else len(np.unique(t.cluster)) for t in tables]
        # `argmin` takes the first of equal ones, which is the coarsest.
        nearest = int(np.abs(np.array(counts) - wanted).argmin())
        if counts[nearest] != wanted:
            unit = format_count(int(wanted), "segment" if self.n_segments else "state")
            warn(f"no level has {unit}: the nearest has {counts[nearest]}")
        return result.at_detail(result.hierarchy.details[nearest])

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.input_tags.allow_nan = True
        return tags

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """Return the parameters and the changed constants."""
        return {**super().get_params(deep=deep), **self._constants}

    def set_params(self, **params: Any) -> Self:
        """Change parameters or constants of the preset; ``fit`` checks their values.

        Raises
        ------
        ParameterError
            The preset has no constant of this name.
        """
        options = set(self._get_param_names())
        constants = {name: value for name, value in params.items() if name not in options}
        allowed = _get_constants(params.get("preset", self.preset)) if constants else {}
        for name in constants:
            if allowed and name not in allowed and name not in self._constants:
                raise ParameterError(
                    f"there is no parameter or constant {name!r:.60}; there are "
                    f"{', '.join((*sorted(options), *allowed))}"
                )
        self._constants = {**self._constants, **constants}
        super().set_params(**{name: value for name, value in params.items() if name in options})
        return self


def _get_constants(preset: str | Preset) -> Mapping[str, Any]:
    """Return the constants of a preset by name; empty if invalid, which ``fit`` reports."""
    try:
        return resolve_preset(preset, signals=True).parameters()
    except ParameterError:
        return {}


def _fill_gaps(states: Ints, signals: Signals) -> Ints:
    """Give frames in a gap the state before it, or after it at the start."""
    for start, stop in signals.gaps:
        states[start:stop] = states[start - 1] if start else states[min(stop, len(states) - 1)]
    return states
