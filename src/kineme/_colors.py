"""One colour per cluster, the same in every picture, report and page.

The nine colours of the first clusters stay apart for people with any of the
common forms of colour blindness; further clusters repeat them lighter, then
darker.

Source: Paul Tol, Colour Schemes, SRON/EPS/TN/09-002, 2021: the "muted" scheme.
"""

from __future__ import annotations

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

_MIXES = ((0.0, 0), (0.5, 255), (0.4, 0))  # share and grey value mixed in, round by round


def cluster_color(cluster: int) -> str:
    """``#RRGGBB`` of a cluster; grey for -1, which is none."""
    if cluster < 0:
        return NO_CLUSTER
    color = PALETTE[cluster % len(PALETTE)]
    share, grey = _MIXES[cluster // len(PALETTE) % len(_MIXES)]
    channels = (int(color[i : i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{round((1 - share) * c + share * grey):02X}" for c in channels)
