"""Borders to the frame, and the transitions between two activities.

Statistics are averaged over a second, so borders of the tree lie where half of that second has
strong movement: late at its start, early at its end. Single frames are more precise. On either
side each channel is a normal distribution, with the mean and variance of frames whose averages
hold nothing of the other side. The channels of the whole recording are a third distribution.

A *transition* is a span about the border, shorter than the averaged time, under which the
whole recording is likelier than either side. Where there is none, the border lies where the
likelihood of both sides together is largest. That is on the quiet side: a movement that a quiet
segment never has ends it at once. People set borders a little farther, and so does `border_shift`.

Only frames within the averaged time of a border are considered. No segment is added or removed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants


Frames = NDArray[np.int64]
Spans = tuple[Frames, Frames]

LEARNT = 4.0
"""Seconds of a side at most from which its distribution is estimated."""
QUIETEST = 0.05
"""Least deviation of a channel, as a share of that in the whole recording."""
SHARE = 3
"""A border moves by one part of so many of a segment at most."""


def refine_borders(channels: Floats, borders: Frames, preset: KinemeConstants) -> Spans:
    """Where each segment begins, and where it ends; what lies between two is a transition.

    Parameters
    ----------
    channels : (frames, channels) array
        At the working rate.
    borders : (segments + 1,) array
        Frames, from 0 to the end.
    preset : KinemeConstants

    Returns
    -------
    starts, stops : (segments,) array
    """
    averaged = max(1, preset.frames(preset.averaging))
    learnt = max(1, preset.frames(LEARNT))
    centred = channels - channels.mean(axis=0)
    deviations = np.sqrt((centred**2).mean(axis=0))
    scaled = centred / np.where(deviations > 0, deviations, 1.0)
    starts, stops = borders[:-1].copy(), borders[1:].copy()
    for i in range(1, len(borders) - 1):
        start, at, stop = borders[i - 1 : i + 2].tolist()
        # Half of the averaged time is mixed with the other side of the border.
        left_side = slice(max(start + averaged // 2 * (i > 1), at - learnt), at - averaged // 2)
        last = stop - averaged // 2 * (i < len(borders) - 2)
        right_side = slice(at + averaged // 2, min(last, at + learnt))
        if min(left_side.stop - left_side.start, right_side.stop - right_side.start) < averaged:
            continue
        # A border moves by the averaged time at most, and never far into a short segment.
        first = at - min(averaged, (at - start) // SHARE)
        near = scaled[first : at + min(averaged, (stop - at) // SHARE)]
        # Log-likelihoods of both sides, less that of the whole recording: up to each frame by the
        # left side, from it on by the right side.
        anything = -0.5 * (near**2).mean(axis=1)
        before = np.append(0.0, np.cumsum(_compute_likelihoods(near, scaled[left_side]) - anything))
        gains = _compute_likelihoods(near, scaled[right_side]) - anything
        behind = np.append(np.cumsum(gains[::-1])[::-1], 0.0)
        likeliest = int(np.argmax(before + behind))
        left, right = _place_ends(before, behind, averaged - 1)
        # What lies between is described by neither side: by "anything", at no gain and no loss.
        gained = before[left] + behind[right] - before[likeliest] - behind[likeliest]
        if gained > preset.transition_cost * preset.working_fps:
            stops[i - 1], starts[i] = first + left, first + right
        else:
            moved = at + round(preset.border_shift * (first + likeliest - at))
            stops[i - 1] = starts[i] = moved
    return starts, stops


def _place_ends(before: Floats, behind: Floats, longest: int) -> tuple[int, int]:
    """Where to end the first side and begin the second, at most so far apart: the likeliest."""
    # For each end of the gap, the best start within `longest` before it.
    rights = np.arange(len(before))
    firsts = np.maximum(rights - longest, 0)
    spans = zip(firsts.tolist(), rights.tolist(), strict=True)
    lefts = np.array([first + int(np.argmax(before[first : right + 1])) for first, right in spans])
    right = int(np.argmax(before[lefts] + behind))
    return int(lefts[right]), right


def _compute_likelihoods(rows: Floats, side: Floats) -> Floats:
    """Log-likelihood of each row by the means and variances of a side, the mean of its channels."""
    variances = np.maximum(side.var(axis=0), QUIETEST**2)
    squares = (rows - side.mean(axis=0)) ** 2 / variances
    likelihoods: Floats = -0.5 * (np.log(variances) + squares).mean(axis=1)
    return likelihoods


def convert_to_samples(frames: Frames, preset: KinemeConstants, n: int) -> Frames:
    """Return the samples nearest to borders in frames, from 0 to n.

    Each segment has one at least.
    """
    nearest = np.rint(frames / (preset.working_fps / preset.rate)).astype(np.int64)
    order = np.arange(len(frames))
    # Less its own index, a strictly ascending sequence only has to ascend: a running maximum.
    after = np.maximum.accumulate(nearest - order)
    borders: Frames = np.minimum(after, n - order[-1]) + order
    borders[-1] = n
    return borders


def move_fine_borders(fine: Frames, before: Frames, after: Frames) -> Frames:
    """Finest borders with those of a level where they have been moved to.

    Parameters
    ----------
    fine : (segments + 1,) array
        Samples, `before` among them.
    before, after : (segments + 1,) array
        Borders of the level, and where each is now.

    Examples
    --------
    >>> fine, level = np.array([0, 2, 5, 6, 9]), np.array([0, 5, 9])
    >>> move_fine_borders(fine, level, np.array([0, 7, 9])).tolist()
    [0, 2, 7, 9]
    """
    # Fine borders between the old and the new place of a border are passed over: they go.
    low, high = np.minimum(before, after), np.maximum(before, after)
    at = np.searchsorted(low, fine, side="right") - 1
    passed = fine <= high[at]
    return np.unique(np.concatenate([fine[~passed], after]))
