"""Storage of libraries in local folders and at URLs that fsspec supports.

`layout` names the files of a library, and `tables` defines their content. A URL such as
``s3://bucket/takes`` is a path object of universal_pathlib (`layout.make_path`). Remote files are
written atomically, and those that were read are cached. `kineme.library.planning` lists and reads
remote recordings.
"""
