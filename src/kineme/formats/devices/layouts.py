"""Read tables of devices that patterns describe completely: each is a dialect with a `Layout`."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect
from kineme.formats.sniffing import MAX_HEADER_LINES

_AXIVITY_NUMBER = r" *-?\d+\.\d+"
_AXIVITY_ROW = rf"\d{{4}}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{{3}}(?:,{_AXIVITY_NUMBER}){{3}}\s*$"
_SENSORLOG_CLOCK = r"\w+Timestamp_since(?:Reboot|1970)\(s\)"
_has_xsens_comments = begins_with("//")
_has_xsens_counter = begins_with(r'"?(?:Packet)?Counter\b', within=MAX_HEADER_LINES)

DIALECTS = (
    # Acceleration in g exported by OmGui, with or without names, at dates.
    Dialect(
        "Axivity",
        begins_with(rf"Time, *Accel-X \(g\),|{_AXIVITY_ROW}"),
        layout=Layout(names=("time", "x", "y", "z"), clocks={"(?i)time": ""}),
    ),
    # MC10's patches: one file per sensor, times in milli- or microseconds since 1970.
    Dialect(
        "BioStamp",
        begins_with(r"Timestamp \((?:ms|microseconds)\),(?:Accel|Gyro|Sample)\b"),
        layout=Layout(clocks={r"Timestamp \(ms\)": "ms", r"Timestamp \(microseconds\)": "us"}),
    ),
    # MbientLab: one file per sensor, with the same time in three columns.
    Dialect(
        "MetaMotion",
        begins_with(r"epoch? \(ms\),time"),
        layout=Layout(clocks={r"epoch? \(ms\)": "ms"}, hidden=r"time.*|elapsed \(s\)"),
    ),
    # Quoted names with their unit, the time in seconds first.
    Dialect(
        "phyphox",
        begins_with(r'"Time \(s\)"[,;\t]"[^"]+ \([^"]+\)"'),
        layout=Layout(clocks={r"Time \(s\)": "s"}),
    ),
    # Android and iOS: one file per sensor, ``time`` in nanoseconds since 1970.
    Dialect(
        "Sensor Logger",
        begins_with(r"time,seconds_elapsed,"),
        layout=Layout(clocks={"time": "ns"}, hidden="seconds_elapsed"),
    ),
    # iOS: names such as ``accelerometerAccelerationX(G)``, a clock per sensor.
    Dialect(
        "SensorLog",
        begins_with(rf"(?:logging(?:Time|Sample)\(\w+\)|{_SENSORLOG_CLOCK})[,;\t]"),
        layout=Layout(
            clocks={r"loggingTime\(txt\)": "", r"\w+_sinceReboot\(s\)": "s", _SENSORLOG_CLOCK: "s"},
            hidden=rf"loggingSample\(N\)|\w+\(txt\)|{_SENSORLOG_CLOCK}",
        ),
    ),
    # Also Movella DOT: lines on the sensor with ``OutputRate:,60Hz``, then the table.
    Dialect(
        "Xsens DOT",
        begins_with(r"OutputRate:", within=10),
        layout=Layout(
            head="PacketCounter",
            rate=r"OutputRate:[,;\t ]*(\d+(?:\.\d+)?) *Hz",
            hidden=r"PacketCounter|SampleTimeFine|Status|(?:Clip|RSSI)\w*",
        ),
    ),
    # Also MTw Awinda: lines that start with ``//`` state the rate. Columns of counters and clocks
    # may be empty, and others hold parts of a date: none is a channel or a usable time.
    Dialect(
        "Xsens MT Manager",
        lambda names, lines: _has_xsens_comments(names, lines) and _has_xsens_counter(names, lines),
        layout=Layout(
            head=r"(?!//)",
            rate=r"(?:Update|Sample) [Rr]ate: *(\d+(?:\.\d+)?)",
            hidden=r"(?:Packet)?Counter|SampleTimeFine|Year|Month|Day|Hour|Minute|Second|UTC_\w+"
            r"|Status\w*|RSSI",
        ),
    ),
)
