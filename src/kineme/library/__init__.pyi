"""The public names of the room and their homes; each is loaded when it is first used."""

from .building import (
    Built as Built,
)
from .building import (
    build as build,
)
from .library import (
    Library as Library,
)
from .searching import (
    Example as Example,
)
from .searching import (
    Hit as Hit,
)
