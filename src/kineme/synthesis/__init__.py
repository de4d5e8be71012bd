"""Synthesise motion from primitives: motion graphs, routes through them, and blending."""

from kineme.synthesis.blending import Placement, find_foot_contacts, plant_feet, synthesize
from kineme.synthesis.building import check_source, motion_graph
from kineme.synthesis.graph import (
    Edge,
    MotionGraph,
    Node,
    Source,
    load_sources,
    read_graph,
    write_graph,
)
from kineme.synthesis.line_routes import line_route, parse_line
from kineme.synthesis.routes import action_route, find_following, parse_actions, random_route

__all__ = [
    "Edge",
    "MotionGraph",
    "Node",
    "Placement",
    "Source",
    "action_route",
    "check_source",
    "find_following",
    "find_foot_contacts",
    "line_route",
    "load_sources",
    "motion_graph",
    "parse_actions",
    "parse_line",
    "plant_feet",
    "random_route",
    "read_graph",
    "synthesize",
    "write_graph",
]
