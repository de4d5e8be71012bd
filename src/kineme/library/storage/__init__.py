"""What lies where: libraries and recordings in folders, and wherever else fsspec reaches.

`layout` names the files of a library, `pieces` and `tables` are what they hold.

A URL such as ``s3://bucket/takes`` becomes what behaves like a path (`places.make_path`), by
universal_pathlib. `places` writes to it whole and keeps what was read from it near;
`kineme.library.planning` lists and reads recordings there. Paths of this machine are paths, and
need none of it.
"""
