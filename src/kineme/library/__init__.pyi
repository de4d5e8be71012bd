"""The public names of the room and their homes; each is loaded when it is first used."""

from .building import (
    Built as Built,
)
from .building import (
    build as build,
)
from .finding import (
    Example as Example,
)
from .finding import (
    Hit as Hit,
)
from .library import (
    Library as Library,
)
