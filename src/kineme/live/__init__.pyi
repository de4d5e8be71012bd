from .events import ActivityEnded as ActivityEnded
from .events import ActivityStarted as ActivityStarted
from .events import Event as Event
from .events import Gap as Gap
from .events import Notice as Notice
from .events import Repetition as Repetition
from .stream import Stream as Stream
