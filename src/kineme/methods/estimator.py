"""Segmenter: segmentation by scikit-learn's rules, for arrays, data frames and grid searches.

Rows are samples in time order, columns channels. Unlike the clusterers of
scikit-learn, this one depends on that order: rows that are shuffled are another
recording.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, ClusterMixin
from sklearn.utils.validation import validate_data

from kineme.errors import ParameterError
from kineme.methods.base import Preset
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.methods.segmenter import segment
from kineme.recordings import Motion, Signals

ASSUMED_FPS = 30.0
"""Rows per second, where nobody says and the preset is not slower."""


class Segmenter(ClusterMixin, BaseEstimator):  # type: ignore[misc]
    """Segments of a multivariate time series; ``fit_predict`` gives a cluster for each row.

    Parameters
    ----------
    preset : str or Preset
        ``kineme``, or another of `kineme.PRESETS`.
    fps : float, optional
        Rows per second; by default what the index of a data frame says if it holds times, else
        30, or the working rate of the preset if that is lower.
    standardize : bool
        Divide each column by its standard deviation; not for an embedding.
    unit : float, optional
        The length in the columns that counts as one unit of the preset's lengths; by default
        the preset finds it in the rows.
    emg : bool
        Take the envelopes of muscle signals first.
    **constants
        Of the preset, to change, as in `kineme.segment`; they are parameters like the others
        for ``get_params``, ``set_params`` and grid searches.

    Attributes
    ----------
    labels_ : (rows,) array of int
        Cluster of the repetition that each row is in, -1 in transitions.
    segmentation_ : Segmentation
        Activities and repetitions in rows and seconds.
    n_features_in_ : int
    feature_names_in_ : (columns,) array
        Where X had names.

    Raises
    ------
    ParameterError
        In ``fit``: a constant that the preset does not have, or a value it cannot take.

    Examples
    --------
    >>> import numpy as np
    >>> angle = np.linspace(0, 16 * np.pi, 480)
    >>> Segmenter().fit_predict(np.column_stack([np.sin(angle), np.cos(angle)]))[:5]
    array([0, 0, 0, 0, 0])
    """

    labels_: np.ndarray[tuple[int], np.dtype[np.int64]]

    def __init__(
        self,
        preset: str | Preset = DEFAULT,
        *,
        fps: float | None = None,
        standardize: bool = True,
        unit: float | None = None,
        emg: bool = False,
        **constants: Any,
    ):
        self.preset = preset
        self.fps = fps
        self.standardize = standardize
        self.unit = unit
        self.emg = emg
        self._constants = constants

    def fit(self, X: Any, y: Any = None) -> Self:  # noqa: ARG002, N803 (scikit-learn's names)
        """Segment the rows of X, (frames, channels); y is there for scikit-learn alone."""
        if isinstance(X, Motion | Signals):
            raise ParameterError(
                "a Segmenter takes rows of numbers: kineme.segment takes recordings"
            )
        values = validate_data(self, X, dtype=np.float64)
        preset = resolve_preset(self.preset, signals=True, **self._constants)
        names = getattr(self, "feature_names_in_", ())
        fps, note = self.fps, ""
        if fps is None and (fps := _rate_of(X)):
            note = f"frame rate {fps:g} Hz, as the times in the index of the data frame say"
        elif fps is None:
            fps = min(preset.working_fps, ASSUMED_FPS)
            note = f"frame rate {fps:g} Hz assumed: no fps was given"
        signals = Signals(values, fps, tuple(map(str, names)))
        signals = signals.noted(note) if note else signals
        result = segment(
            signals, preset=preset, emg=self.emg, standardize=self.standardize, unit=self.unit
        )
        self.segmentation_ = result
        self.labels_ = result.per_frame("cluster")
        return self

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """Return the parameters and the constants that were changed."""
        return {**super().get_params(deep=deep), **self._constants}

    def set_params(self, **params: Any) -> Self:
        """Change parameters or constants of the preset; ``fit`` says which values it cannot take.

        Raises
        ------
        ParameterError
            The preset has no constant of a name.
        """
        options = set(self._get_param_names())
        constants = {name: value for name, value in params.items() if name not in options}
        allowed = _constants_of(params.get("preset", self.preset)) if constants else {}
        for name in constants:
            if allowed and name not in allowed and name not in self._constants:
                raise ParameterError(
                    f"there is no parameter or constant {name!r:.60}; there are "
                    f"{', '.join((*sorted(options), *allowed))}"
                )
        self._constants = {**self._constants, **constants}
        super().set_params(**{name: value for name, value in params.items() if name in options})
        return self


def _constants_of(preset: str | Preset) -> Mapping[str, Any]:
    """Return the constants of a preset by name; none of what is no preset, which ``fit`` says."""
    try:
        return resolve_preset(preset, signals=True).parameters()
    except ParameterError:
        return {}


def _rate_of(rows: Any) -> float | None:
    """Rows per second of a data frame whose index holds times; None where nothing tells it."""
    index = getattr(rows, "index", None)
    kind = getattr(getattr(index, "dtype", None), "kind", None)
    if index is None or kind not in ("m", "M") or len(index) < 2:
        return None
    times = np.asarray(index, f"{kind}8[ns]")
    step = float(np.median(np.diff(times) / np.timedelta64(1, "s")))
    return 1 / step if step > 0 else None
