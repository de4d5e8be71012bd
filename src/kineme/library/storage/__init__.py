"""Where recordings are read from and libraries are kept: folders, and whatever fsspec reaches.

A URL such as ``s3://bucket/takes`` becomes what behaves like a path (`places.place`), by
universal_pathlib. `places` writes to it whole and keeps what was read from it near; `recordings`
lists and reads recordings there. Paths of this machine are paths, and need none of it.
"""
