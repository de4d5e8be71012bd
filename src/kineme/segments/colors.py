"""Choose one colour per cluster, the same in every picture, report and page.

The nine colours of the first clusters can be distinguished with all common forms of
colour blindness. Further clusters repeat them in lighter, then in darker shades.

Source: Paul Tol, Colour Schemes, SRON/EPS/TN/09-002, 2021: the "muted" scheme.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Protocol

PALETTE = (
    "#332288",
    "#DDCC77",
    "#117733",
    "#CC6677",
    "#88CCEE",
    "#882255",
    "#999933",
    "#44AA99",
    "#AA4499",
)
NO_CLUSTER = "#DDDDDD"


class Row(Protocol):
    """Properties of a segment that determine its colour."""

    @property
    def label(self) -> str: ...
    @property
    def cluster(self) -> int: ...
    @property
    def start_s(self) -> float: ...
    @property
    def stop_s(self) -> float: ...


_MIXES = ((0.0, 0), (0.5, 255), (0.4, 0))
"""Share and value of the grey that is mixed in, for each round through the palette."""


def choose_label_colors(rows: Iterable[Row]) -> dict[str, str]:
    """Return the colour ``#RRGGBB`` of each label, the same as in the pages.

    A label has the colour of the cluster in which it lasts longest, or else one derived from its
    text.
    """
    most: dict[str, Counter[int]] = {}
    used = set()
    for row in rows:
        used.add(get_cluster_color(row.cluster))
        if row.label:
            seconds = most.setdefault(row.label, Counter())
            if row.cluster >= 0:
                seconds[row.cluster] += row.stop_s - row.start_s  # type: ignore[assignment]
    colors: dict[str, str] = {}
    for label in sorted(most, key=lambda text: text.encode("utf-16-be", "surrogatepass")):
        clusters = most[label].most_common(1)
        colors[label] = (
            get_cluster_color(clusters[0][0]) if clusters else _choose_free_color(label, used)
        )
        used.add(colors[label])
    return colors


def _choose_free_color(text: str, used: set[str]) -> str:
    """Return a colour derived from a text, or the next unused one."""
    hashed = 2166136261  # FNV-1a hash over UTF-16 code units, as in JavaScript
    units = text.encode("utf-16-le", "surrogatepass")
    for low, high in zip(units[::2], units[1::2], strict=True):
        hashed = ((hashed ^ (low | high << 8)) * 16777619) % 2**32
    number = len(PALETTE) * len(_MIXES)
    choices = [get_cluster_color((hashed + i) % number) for i in range(number)]
    return next((color for color in choices if color not in used), choices[0])


def get_cluster_color(cluster: int) -> str:
    """Return the colour ``#RRGGBB`` of a cluster; grey for -1 (no cluster)."""
    if cluster < 0:
        return NO_CLUSTER
    color = PALETTE[cluster % len(PALETTE)]
    share, grey = _MIXES[cluster // len(PALETTE) % len(_MIXES)]
    channels = (int(color[i : i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{round((1 - share) * c + share * grey):02X}" for c in channels)
