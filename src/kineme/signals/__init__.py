"""Recordings without a skeleton: accelerometers, gyroscopes, muscles, forces, features of a video.

The way is that of motions: channels are brought to the working rate, made
comparable, stacked with neighbouring frames, and from there on segmented by the
same methods. `read_signals` reads them from files, `segment_signals` gives
their segments, `Segmenter` does so by scikit-learn's rules.
"""

from kineme.signals.channels import signal_preset
from kineme.signals.emg import emg_envelope
from kineme.signals.reading import is_signal_file, read_signals
from kineme.signals.recording import Signals
from kineme.signals.segmenting import segment_signals, segment_signals_and_analysis
from kineme.signals.writing import write_signals

__all__ = [
    "Signals",
    "emg_envelope",
    "is_signal_file",
    "read_signals",
    "segment_signals",
    "segment_signals_and_analysis",
    "signal_preset",
    "write_signals",
]
