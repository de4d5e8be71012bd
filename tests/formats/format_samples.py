"""Random skeletons and motions, and a small valid file of each format."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from kineme.recordings import Motion, Skeleton

ASF = """\
# a comment
:version 1.10
:name figure
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
  anything
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name hip
    direction 0.6 -0.8 0
    length 2
    axis 0 0 0 XYZ
  end
  begin
    id 2
    name leg
    direction 0 -1 0
    length 8
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 3
    name foot
    direction 0 0 1
    length 3
    axis -90 0 20 XYZ
    dof rz rx
  end
  begin
    id 4
    name back
    direction 0 1 0
    length 9
    axis 0 0 0 XYZ
    dof rx ry rz
  end
:hierarchy
  begin
    root hip back
    hip leg
    leg foot
  end
"""

AMC = """\
# a comment
:FULLY-SPECIFIED
:DEGREES
1
root 1 17 2 10 20 30
back 5 6 7
leg 10 11 12
foot 3 4
2
root 1.5 17 2.5 11 21 31
back 5.5 6 7
leg 10 11.5 12
foot 3 4.5
3
root 2 17 3 12 22 32
back 6 6 7
leg 10 12 1.2e1
foot 3 5
"""

BVH = """\
HIERARCHY
ROOT Hips
{
\tOFFSET 0 90 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT mixamorig:Left Up.Leg
\t{
\t\tOFFSET 10 -5 0
\t\tCHANNELS 3 Yrotation Xrotation Zrotation
\t\tJOINT Foot
\t\t{
\t\t\tOFFSET 0 -80 0
\t\t\tCHANNELS 6 Xposition Yposition Zposition Xrotation Yrotation Zrotation
\t\t\tEnd Site
\t\t\t{
\t\t\t\tOFFSET 0 0 15
\t\t\t}
\t\t}
\t}
\tJOINT Head
\t{
\t\tOFFSET 0 60 0
\t\tCHANNELS 3 Zrotation Yrotation Xrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 20 0
\t\t}
\t}
}
MOTION
Frames: 3
Frame Time: 0.0083333
0 90 0 10 20 30 1 2 3 0 -80 0 4 5 6 7 8 9
1 91 1 11 21 31 1 2 3 0 -80 1 4 5 6 7 8 9
2 92 2 12 22 32 1 2 3 0 -80 2 4 5 6 7 8 9.0e0
"""


PLAIN = ("root", "b", "c_2", "d-4", "e.5", "f", "g", "h")
DIALECT = ("Hips", "Left Arm", "mixamorig:Spine.1", "é", "0", "Site", "x-1", "JOINT")


@st.composite
def motions(draw: st.DrawFn, names: tuple[str, ...] = DIALECT) -> Motion:
    """A motion of a random tree whose bones may slide and whose leaves may be end sites."""
    n = draw(st.integers(1, len(names)))
    parents = [-1, *(draw(st.integers(0, j - 1)) for j in range(1, n))]
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    leaves = sorted(set(range(1, n)) - set(parents))
    ends = [j for j in leaves if draw(st.booleans())]
    offsets = rng.normal(size=(n, 3)) * draw(st.sampled_from([0.0, 0.3, 10.0]))
    offsets[draw(st.integers(0, n - 1))] = 0.0
    frames = draw(st.integers(1, 4))
    rotations = rng.normal(size=(frames, n, 4))
    if draw(st.booleans()):  # a quarter turn about y: Euler angles lose a degree of freedom
        rotations[:, rng.integers(n)] = [1.0, 0.0, 1.0, 0.0]
    rotations[:, ends] = [1.0, 0.0, 0.0, 0.0]
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    translations = np.repeat(offsets[None], frames, axis=0)
    translations[:, 0] = rng.normal(size=(frames, 3))
    for j in range(1, n):
        if j not in ends and draw(st.integers(0, 3)) == 0:
            translations[:, j] += rng.normal(size=(frames, 3))
    full = [f"{names[parents[j]]}_end{j}" if j in ends else names[j] for j in range(n)]
    skeleton = Skeleton(tuple(full), tuple(parents), offsets, frozenset(ends))
    fps = draw(st.sampled_from([30.0, 120.0, 29.97, 59.94, 29.476]))
    return Motion.from_rotations(skeleton, rotations, fps, translations=translations)
