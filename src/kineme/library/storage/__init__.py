"""Storage of libraries in local folders and at URLs that fsspec supports.

`layout` names the files of a library, `analyses` and `tables` define their content.

`places.make_path` turns a URL such as ``s3://bucket/takes`` into a path object of
universal_pathlib. `places` also writes remote files atomically and caches those that were read;
`kineme.library.planning` lists and reads remote recordings.
"""
