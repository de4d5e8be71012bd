"""Studio: a local web server and a page for viewing recordings and correcting their segments.

    server   the socket, Ctrl+C, opening the browser
      routes   handlers of all routes, behind http.security: host, origin, token, headers
        http              request and response bodies, uploads, events
        open_recordings   recordings by id; each is opened once, with the user's reading options
          open_recording      table, revision, undo and saving; segments found in a thread
          loading             the recording and everything computed from it; previews
          jobs                running segmentations, and the estimation of poses
          edits               what each edit does to a table
          storage.tables      the table file beside the recording, and its undo history
          storage.sidecars    user settings of a recording, in small files beside it
        folder            files that can be opened, their ids, and summaries of their tables
        annotators        labels of several people, compared
        choices           presets, constants and formats that the page offers
        downloads         segments, clips and reports as files; loops as they would be written
        library           the same for a library: clusters, searches, and their routes
          library_tables      saved tables, updated from the library

Everything that a page sends is checked as it is decoded into the types of `kineme.web.requests`. No
path is ever built from a request: files are found by id, and the name of an upload is sanitised.
"""
