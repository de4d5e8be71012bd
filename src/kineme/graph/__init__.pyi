"""The public names of the room and their homes; each is loaded when it is first used."""

from .neighbors import (
    NeighborGraph as NeighborGraph,
)
from .neighbors import (
    neighbor_graph as neighbor_graph,
)
from .warping import (
    BASIC_STEPS as BASIC_STEPS,
)
from .warping import (
    WarpingPaths as WarpingPaths,
)
from .warping import (
    component_labels as component_labels,
)
from .warping import (
    warping_paths as warping_paths,
)
